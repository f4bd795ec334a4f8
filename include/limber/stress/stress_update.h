// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_stress_update_h
#define limber_stress_stress_update_h

#include <limber/materials/frame.h>
#include <limber/materials/kernel.h>
#include <limber/materials/point_start.h>
#include <limber/materials/treatment.h>
#include <limber/points/point_view.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /**
   * What an implicit pressure has found for the cells of a body that is
   * averaged over them. Points of liquids take the pressure; their J takes the
   * mean divergence, with nothing of second order in the step, and this
   * dilation. Those of solids have the pressure of their own volume, and the
   * dilation is all that they take. Where tension is cut off, points of cells
   * whose pressure is exactly zero have J = 1 afterwards.
   */
  struct CellPressures
  {
    const double *pressure     = nullptr; // J p, Pa; null: that of the law
    const double *dilation     = nullptr; // over the step, without dimension
    bool          is_whole     = false;   // with the divergence
    bool          cuts_tension = false;
  };



  /** How a change of volume is resisted at some J. */
  struct VolumetricResponse
  {
    double pressure;  // J p, Pa
    double stiffness; // -J d(J p)/dJ, Pa
  };



  /** How a sweep over a body updates its strain and stress. */
  struct StressSweep
  {
    double step     = 0;     // over which they are strained, s
    bool   remapped = false; // grad v of the re-mapped velocity, not the new
    // Points are strained by the f by which they move: f = 1 + a + c a^2 with
    // a = step grad v and this c (but with USAVG, which keeps the energy of
    // bodies that turn instead of their size). A body that turns would grow by
    // w^2 dt/2 of its radius per second otherwise. No matter in the initial
    // frame, where F gets step grad_X v.
    double square = 0;
    // Over which they then move with the new velocity, s; 0: they stay.
    double move = 0;
    // Whether they follow the velocity field as it is now on their way: by
    // step (1 + a/2) v, of second order, so that what turns does not grow.
    bool curved = false;
    // With Treatment::cell and functions of the corners: whether all places of
    // a cell move apart as its mean divergence says, by the velocity without
    // beyond_uniform_divergence().
    bool uniform_divergence = false;
    // With this share of FLIP points take their velocities in the same sweep,
    // where takes_velocity(); empty: they keep them.
    std::optional<double> flip_share;
    // Give the nodes the forces of the new stress, where gives_force(); the
    // stress is then not stored.
    bool give_force = false;
    // Share of the way that the volumetric variable goes to the mean of the
    // cell in this step: 0 keeps the history, 1 replaces it.
    double relaxation = 0;
    // Per cell, what that variable gets besides; null: nothing.
    const double *shift       = nullptr;
    double        shift_share = 1; // of it
    // By cell, with Treatment::cell: the dilation of a liquid over the mean
    // divergence of the cell (LiquidMeans); null: one
    const double *volume_shares = nullptr;
    // Of an implicit pressure, with Treatment::cell; null: there is none
    const CellPressures *implicit = nullptr;
    // The divergence, likewise projected (GiveToGrid::projected_pressure)
    const double *projected_divergence = nullptr;
  };



  struct StressSummary
  {
    double wave_speed_squared = 0; // the largest, m^2/s^2
    double viscous            = 0; // dissipated by viscosity, J
    double history            = 0; // removed with history or tension, J
    double plastic            = 0; // work on plastic strain, J
    double displacement       = 0; // the largest over the edge of its cell
    // where points take their velocities
    double speed_squared = 0; // the largest, m^2/s^2
    double removed       = 0; // kinetic energy that FLIP would have kept, J
  };



  /** Extremes and sums of a body that statistics ask for now and then. */
  struct StateSummary
  {
    double strain_energy   = 0; // J
    double smallest_volume = 1; // of all J
    double largest_volume  = 1;
  };



  /**
   * The sweep over the points of a body that turns the motion of the grid
   * into strain, averages it where the body is projected, and calls the law.
   * The type of the law is erased here, once per body and step.
   */
  template <int dim>
  class StressUpdate
  {
  public:
    virtual ~StressUpdate() = default;

    virtual StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim>  *sums,
           const StressSweep    &what) const = 0;

    /**
     * Add to the next records of the cells (DeviatorSums) the mass of the
     * points and their deviatoric strain times mass. For laws that keep one.
     */
    virtual void
    sum_deviators(const PointView<dim> &points,
                  const CellSums<dim>  &sums) const = 0;

    /**
     * Let the components that the treatment averages go @p share of the way
     * to the mean of the cell; returns the energy that this removes, J.
     */
    virtual double
    relax_deviators(const PointView<dim> &points,
                    const double         *sums,
                    double                share) const = 0;

    /** How the strain, and with it the stress, is averaged over cells. */
    virtual const StrainTreatment &
    treatment() const = 0;

    /**
     * Whether points can take their velocities in the same sweep, which spares
     * one where each looks its nodes up.
     */
    virtual bool
    takes_velocity() const
    {
      return false;
    }

    /** Whether it gives the nodes the internal forces (initial frame). */
    virtual bool
    gives_force() const
    {
      return false;
    }

    /** Energies and volume ratios of the present state. */
    virtual StateSummary
    summarize(const PointView<dim> &points) const = 0;

    /** The largest wave speed squared of the present state, m^2/s^2. */
    virtual double
    wave_speed_squared(const PointView<dim> &points) const = 0;

    /**
     * Of the volumetric part of the law, at a value of its volumetric variable
     * (J or, where that is the history, the pressure itself); for liquids and
     * elastic solids.
     */
    virtual VolumetricResponse
    volumetric_response(double variable) const = 0;

    /**
     * Volume of a point that starts so over its volume without stress, as its
     * mass counts it: one where strain is small.
     */
    virtual double
    volume_ratio_at(const PointStart<dim> &start) const = 0;

    /** Let point p start so; false where the law does not admit it. */
    virtual bool
    initialise(const PointView<dim>  &points,
               std::size_t            p,
               const PointStart<dim> &start) const = 0;

    /** J at all points, written to an array of their number. */
    virtual void
    volume_ratio(const PointView<dim> &points, double *volume_ratio) const = 0;

    /**
     * How much wider the material at point p is along a unit vector, between
     * surfaces across it, than without stress. What has flowed plastically
     * tells its elastic part.
     */
    virtual double
    stretch_along(const PointView<dim>          &points,
                  std::size_t                    p,
                  const std::array<double, dim> &direction) const = 0;

    virtual unsigned int
    n_history() const = 0;
    /** Where the variables that have names begin in the history. */
    virtual unsigned int
    first_variable() const = 0;
    virtual bool
    has_deviator() const = 0;
    /** Index of the volumetric history variable; -1: the pressure. */
    virtual int
    volumetric() const = 0;
    virtual double
    density() const = 0; // kg/m^3
    virtual double
    viscosity() const = 0; // Pa s, 0 for solids

    /** The largest wave speed squared without volumetric stiffness, m^2/s^2;
     * 0 for liquids. */
    virtual double
    deviatoric_wave_speed_squared(const PointView<dim> &points) const = 0;
  };



  /**
   * The sweep for the law of that name; @p values in the order of its
   * entries. In the initial frame the law is elastic, the kernel linear and
   * the treatment 'none', 'cell' or 'assumed_strain'; the last is for linear
   * kernels alone.
   */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_stress_update(const std::string         &law,
                     const std::vector<double> &values,
                     Treatment                  kind,
                     HourglassResponse          response,
                     Frame                      frame  = Frame::current,
                     KernelKind                 kernel = KernelKind::linear);
} // namespace limber

#endif
