// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_trial_stress_h
#define limber_stress_trial_stress_h

#include <limber/materials/frame.h>
#include <limber/materials/kernel.h>
#include <limber/materials/treatment.h>
#include <limber/points/point_view.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace limber
{
  /**
   * Force and stiffness of the points of a body in a cell for displacements of
   * its nodes. Degrees of freedom node by node, in the order of the basis:
   * component d of node i is i * dim + d. With averaged volumes the tangent is
   * that at constant mean growth, and the derivative of the force has the rank
   * one term besides
   *
   *   volume_stiffness * volume_row volume_row^T,
   *
   * which grows without bound towards incompressibility.
   */
  struct CellResponse
  {
    explicit CellResponse(const unsigned int n)
      : n(n)
      , force(n)
      , tangent(std::size_t(n) * n)
      , volume_row(n)
    {}

    void
    clear()
    {
      energy = volume_stiffness = 0;
      for (auto *const values : {&force, &tangent, &volume_row})
        std::fill(values->begin(), values->end(), 0.);
    }

    /** Add that much of the rank one volume stiffness to the tangent. */
    void
    add_volume_stiffness(const double stiffness)
    {
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          tangent[k * n + l] += stiffness * volume_row[k] * volume_row[l];
    }

    const unsigned int  n;                    // degrees of freedom
    double              energy = 0;           // strain energy, J
    std::vector<double> force;                // derivative of the energy, N
    std::vector<double> tangent;              // of the force, row by row, N/m
    std::vector<double> volume_row;           // of the mean growth, 1/m
    double              volume_stiffness = 0; // J
  };



  /** Results of an accepted displacement. */
  struct AcceptedMotion
  {
    double longest_way  = 0; // displacement over cell edge
    double plastic_work = 0; // J
  };



  /**
   * The stress at the end of a step as a function of the nodal displacements in
   * it, for implicit and quasi-static steps of solids; in the initial frame
   * with linear functions or quadratic splines, in the current one with linear
   * functions. Trials do not change the points; one of them is then accepted.
   * Plastic laws do the return mapping in each trial, from the state at the
   * start of the step, and count plastic work as energy.
   *
   * In the initial frame shape functions are those of the reference positions
   * and F grows by the displacement gradient; in the current one they are those
   * of the positions at the start of the step, and the deformation of the step
   * is f = 1 + grad u. With Treatment::cell the volume of all points of a cell
   * grows by the mean of det f (current frame) or as the mean of det F does
   * (initial frame), weighted by initial volume, in energy, force and tangent
   * alike, so that the tangent is symmetric (doc/theory/implicit_steps.md).
   * With Treatment::assumed_strain f or F is the assumed one of
   * assumed_deformation.h.
   */
  template <int dim>
  class TrialStress
  {
  public:
    virtual ~TrialStress() = default;

    using Work = std::function<void(std::uint32_t cell, CellResponse &)>;

    /**
     * Call @p work for each occupied cell, with the tangent if requested. All
     * points of a cell must be consecutive in @p points. @p displacement is by
     * node number and component, m. Returns false if a point is inverted; then
     * not all cells have been called.
     *
     * With @p former displacements, those of the previous iterate, the stress
     * in the tangent is that of their linearisation, instead of that at @p
     * displacement: where slender bodies rotate the two differ much, and
     * Newton's method takes fewer iterations (mixed integration points:
     * Magisano, Leonetti and Garcea, Int. J. Numer. Methods Eng. 2017).
     */
    virtual bool
    respond(const PointView<dim> &points,
            const GridView<dim>  &grid,
            const double         *displacement,
            const double         *former,
            bool                  with_tangent,
            const Work           &work) const = 0;

    /**
     * Accept a displacement for which respond() succeeded: update states and
     * positions of the points.
     */
    virtual AcceptedMotion
    accept(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const double         *displacement) const = 0;

    virtual const StrainTreatment &
    treatment() const = 0;

    /** Whether strain and rotation may be large: stress is convected. */
    virtual bool
    has_finite_strain() const = 0;

    /** At rest, kg/m^3. */
    virtual double
    density() const = 0;

    /** At rest, Pa. */
    virtual double
    young_modulus() const = 0;

    /** K / G at rest if the mean volume of the cell acts. */
    virtual double
    bulk_over_shear() const = 0;

    virtual bool
    has_symmetric_tangent() const = 0;
  };



  /**
   * For the law of that name, a solid's; @p values in the order of its entries,
   * the treatment 'none', 'cell' or, for linear functions only,
   * 'assumed_strain', to which @p response applies. The grid must have the
   * functions of @p kernel, 'linear' or 'quadratic'.
   */
  template <int dim>
  std::unique_ptr<const TrialStress<dim>>
  make_trial_stress(const std::string         &law,
                    const std::vector<double> &values,
                    Treatment                  kind,
                    HourglassResponse          response,
                    Frame                      frame,
                    KernelKind                 kernel);
} // namespace limber

#endif
