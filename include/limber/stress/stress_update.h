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
   * Results of the implicit pressure in the cells of a body that is averaged
   * over them. Points of liquids get the pressure; their J follows the mean
   * divergence, without terms of second order in the step, plus this dilation.
   * Points of solids get the pressure from their own J, which follows the
   * dilation alone. With tension cutoff, points in cells whose pressure is
   * exactly zero get J = 1.
   */
  struct CellPressures
  {
    const double *pressure     = nullptr; // J p, Pa; null: that of the law
    const double *dilation     = nullptr; // over the step, without dimension
    bool          is_whole     = false;   // dilation includes the divergence
    bool          cuts_tension = false;
  };



  /** Pressure and its stiffness at some J. */
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
    // Increment f = 1 + a + c a^2 of the deformation gradient, a = step grad v,
    // with this c, consistent with the motion of points (except with USAVG,
    // which conserves the energy of rotating bodies instead of their size).
    // Otherwise a rotating body would grow by w^2 dt/2 of its radius per
    // second. Not used in the initial frame, where F gets step grad_X v.
    double square = 0;
    // Step over which they then move with the new velocity, s; 0: not at all.
    double move = 0;
    // Whether points follow the present velocity field along their path: by
    // step (1 + a/2) v, second order, so that rotating bodies do not grow.
    bool curved = false;
    // With Treatment::cell and linear functions: whether the velocity that
    // moves points has the mean divergence everywhere in a cell, i.e. is
    // without beyond_uniform_divergence().
    bool uniform_divergence = false;
    // G2P in the same sweep with this FLIP share, if takes_velocity(); empty:
    // no G2P.
    std::optional<double> flip_share;
    // P2G of the forces of the new stress, if gives_force(); the stress is then
    // not stored.
    bool give_force = false;
    // Share by which the volumetric variable is relaxed to the mean of the cell
    // in this step: 0 keeps the history, 1 replaces it.
    double relaxation = 0;
    // Per cell, change of that variable by checkerboard and density control;
    // null: none
    const double *shift       = nullptr;
    double        shift_share = 1; // of it
    // By cell, with Treatment::cell: dilation of a liquid over the mean
    // divergence of the cell (LiquidMeans); null: one
    const double *volume_shares = nullptr;
    // Of an implicit pressure, with Treatment::cell; null: there is none
    const CellPressures *implicit = nullptr;
    // Divergence projected on nodes, as P2GOptions::projected_pressure
    const double *projected_divergence = nullptr;
  };



  /** Results of a sweep that strains points. */
  struct StressSummary
  {
    double wave_speed_squared = 0; // the largest, m^2/s^2
    double viscous            = 0; // dissipated by viscosity, J
    double history            = 0; // removed with history or tension, J
    double plastic            = 0; // work on plastic strain, J
    double displacement       = 0; // the largest over the edge of its cell
    // if the sweep does G2P:
    double speed_squared = 0; // the largest, m^2/s^2
    double removed       = 0; // kinetic energy that FLIP would have kept, J
  };



  /** Extremes and sums of a body for statistics. */
  struct StateSummary
  {
    double strain_energy   = 0; // J
    double smallest_volume = 1; // of all J
    double largest_volume  = 1;
  };



  /**
   * The sweep over the points of a body that computes strain increments from
   * the grid velocity, averages them as the treatment says, and calls the law.
   * Type erasure of the law: one virtual call per body and step.
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
     * Add mass and mass times deviatoric strain of the points to the next
     * records of the cells (DeviatorSums). Only for laws that keep such a
     * strain.
     */
    virtual void
    sum_deviators(const PointView<dim> &points,
                  const CellSums<dim>  &sums) const = 0;

    /**
     * Relax the components that the treatment averages by @p share to the mean
     * of the cell; returns the energy that this removes, J.
     */
    virtual double
    relax_deviators(const PointView<dim> &points,
                    const double         *sums,
                    double                share) const = 0;

    /** The averages of strain and stress over cells. */
    virtual const StrainTreatment &
    treatment() const = 0;

    /**
     * Whether G2P can be done in the same sweep, which saves one for kernels
     * whose points look their nodes up one by one.
     */
    virtual bool
    takes_velocity() const
    {
      return false;
    }

    /** Whether it does P2G of the internal forces as well (initial frame). */
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
     * Pressure and stiffness of the volumetric part of the law at a value of
     * its volumetric variable (J or, if that is the history, the pressure); for
     * liquids and elastic solids.
     */
    virtual VolumetricResponse
    volumetric_response(double variable) const = 0;

    /**
     * Volume of a point in this initial state over its stress-free volume, from
     * which its mass follows: one at small strain.
     */
    virtual double
    volume_ratio_at(const PointStart<dim> &start) const = 0;

    /** Set the initial state of point p; false if the law does not admit it. */
    virtual bool
    initialise(const PointView<dim>  &points,
               std::size_t            p,
               const PointStart<dim> &start) const = 0;

    /** Write J of all points to an array. */
    virtual void
    volume_ratio(const PointView<dim> &points, double *volume_ratio) const = 0;

    /**
     * The stretch of the material at point p along a unit vector, relative to
     * the stress-free state: the distance of material surfaces normal to it.
     * Only the elastic part if it has yielded.
     */
    virtual double
    stretch_along(const PointView<dim>          &points,
                  std::size_t                    p,
                  const std::array<double, dim> &direction) const = 0;

    virtual unsigned int
    n_history() const = 0;
    /** Index of the first named variable in the history. */
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
   * The StressUpdate for the law of that name; @p values in the order of its
   * entries. In the initial frame the law is a solid's, and the treatment
   * 'none', 'cell' or, for linear kernels only, 'assumed_strain'.
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
