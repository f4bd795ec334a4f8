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
   * How the points of a body in a cell resist a displacement of its nodes.
   * Degrees of freedom node by node, in the order of the basis: component d of
   * node i is i * dim + d. Where volumes are averaged, the tangent is that at a
   * given mean growth, and the derivative of the force has the term of rank one
   * besides
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

    /** Put that much of the volume stiffness into the tangent. */
    void
    add_volume_stiffness(const double stiffness)
    {
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          tangent[k * n + l] += stiffness * volume_row[k] * volume_row[l];
    }

    const unsigned int  n;                    // degrees of freedom
    double              energy = 0;           // of strain, J
    std::vector<double> force;                // derivative of the energy, N
    std::vector<double> tangent;              // of the force, row by row, N/m
    std::vector<double> volume_row;           // of the mean growth, 1/m
    double              volume_stiffness = 0; // J
  };



  /** What points tell of a displacement that they have taken. */
  struct AcceptedMotion
  {
    double longest_way  = 0; // over the edge of its cell
    double plastic_work = 0; // J
  };



  /**
   * The stress at the end of a step as a function of the displacements of the
   * nodes in it, for solids; in the frame of the initial configuration with
   * linear functions or quadratic splines, in the current one with linear
   * functions. Trials leave the points as they are; one of them is then
   * accepted. Laws that flow return to their yield surface in each trial, from
   * the state at the start of the step, and count plastic work as energy.
   *
   * In the frame of the initial configuration the functions are those of the
   * initial places and F grows by the gradient of the displacement; in the
   * current one they are those of the places at the beginning of the step, and
   * what follows is deformed further by f = 1 + grad u. With
   * Treatment::cell the volume of all points in a cell grows by the mean of
   * det f (current frame) or as the mean of det F does (initial frame),
   * weighted by initial volume, in energy, force and tangent alike, so that the
   * tangent is symmetric (doc/theory/implicit_steps.md). With
   * Treatment::assumed_strain f or F is the assumed one of
   * assumed_deformation.h.
   */
  template <int dim>
  class TrialStress
  {
  public:
    virtual ~TrialStress() = default;

    using Work = std::function<void(std::uint32_t cell, CellResponse &)>;

    /**
     * Call @p work for each occupied cell, with the tangent on request. All
     * points of a cell must follow each other in @p points. @p displacement: by
     * number of a node and component, m. False where a point is turned inside
     * out; not all cells have been called for then.
     *
     * With @p former displacements, those of the iterate before, the stress in
     * the tangent is the one that they and their linearisation lead to, instead
     * of the one at @p displacement: where thin bodies turn the two differ by
     * much, and Newton's method takes fewer iterations (mixed integration
     * points: Magisano, Leonetti and Garcea, Int. J. Numer. Methods Eng. 2017).
     */
    virtual bool
    respond(const PointView<dim> &points,
            const GridView<dim>  &grid,
            const double         *displacement,
            const double         *former,
            bool                  with_tangent,
            const Work           &work) const = 0;

    /**
     * Strain the points by a displacement at which they have responded, and
     * move them.
     */
    virtual AcceptedMotion
    accept(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const double         *displacement) const = 0;

    /** At rest, Pa. */
    virtual double
    young_modulus() const = 0;

    /** Where the mean volume of the points in a cell acts: K / G at rest. */
    virtual double
    bulk_over_shear() const = 0;

    virtual bool
    has_symmetric_tangent() const = 0;
  };



  /**
   * For the law of that name, of a solid; @p values in the order of its
   * entries, the treatment 'none', 'cell' or 'assumed_strain'; @p response
   * counts with the last, which is for linear functions alone. The grid has to
   * have the functions of @p kernel, 'linear' or 'quadratic'.
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
