// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_file_placement_h
#define limber_problem_file_placement_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace limber
{
  class Parameters;
  class Section;



  /**
   * Transformation from the coordinates of a file to those of the scene:
   * scaled, rotated about the origin of the file, and shifted, in this order.
   */
  template <int dim>
  struct FilePlacement
  {
    double                 scale    = 1;
    dealii::Tensor<2, dim> rotation = dealii::unit_symmetric_tensor<dim>();
    dealii::Tensor<1, dim> shift; // m

    dealii::Point<dim>
    operator()(const dealii::Point<dim> &place) const
    {
      return dealii::Point<dim>(scale * (rotation * place) + shift);
    }
  };



  /** 'Scale', 'Rotation' and 'Translation' of a section. */
  template <int dim>
  void
  declare_file_placement(Parameters &parameters);

  template <int dim>
  FilePlacement<dim>
  read_file_placement(const Section &section);
} // namespace limber

#endif
