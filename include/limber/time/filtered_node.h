// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_filtered_node_h
#define limber_time_filtered_node_h

#include <deal.II/base/tensor.h>

#include <cstdint>

namespace limber
{
  /** A node whose filtered velocity (FMPM, XPIC) has strained points in the
   * last step, for checkpoints. */
  template <int dim>
  struct FilteredNode
  {
    std::uint64_t          place = 0; // see places_of_nodes()
    unsigned int           field = 0; // nodal field
    double                 mass  = 0; // kg
    dealii::Tensor<1, dim> velocity;  // m/s

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &place &field &mass &velocity;
    }
  };
} // namespace limber

#endif
