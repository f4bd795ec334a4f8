// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_field_source_h
#define limber_study_field_source_h

#include <limber/output/point_arrays.h>
#include <limber/problem/problem.h>

#include <memory>
#include <string>
#include <vector>

namespace limber
{
  /** Fields of a body that can be evaluated at initial places. */
  template <int dim>
  class FieldSource
  {
  public:
    virtual ~FieldSource() = default;

    /** What it is, for the table. */
    virtual std::string
    description() const = 0;

    /** Times at which there are fields, s, ascending; empty: any time. Asking
     * for another one is an error of the program. */
    virtual std::vector<double>
    times() const = 0;

    /** The fields at @p places, in their order; NaN at places that the source
     * does not reach and for quantities that it does not know. */
    virtual PointArrays<dim>
    evaluate(const double                           time,
             const std::vector<dealii::Point<dim>> &places) = 0;

    /** The fields at places of the source with the masses that they stand for:
     * its material points, or the quadrature points of its elements. Of
     * formulas there are none. */
    virtual PointArrays<dim>
    at_own_places(const double time) = 0;
  };



  /**
   * The finite elements of a reference folder, evaluated within each element.
   * Throws InputError or FileError where it is none.
   */
  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_reference_source(const std::string &folder);

  /**
   * The material points of a run folder, interpolated by moving least squares:
   * a plane is fitted to the points nearest to a place, exact for linear
   * fields.
   */
  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_run_source(const std::string &folder);

  /** Formulas of a scene. Throws InputError where it has none. */
  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_exact_source(const Problem<dim> &problem);
} // namespace limber

#endif
