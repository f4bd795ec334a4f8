// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_semi_implicit_integrator_h
#define limber_time_semi_implicit_integrator_h

#include <limber/time/explicit_integrator.h>
#include <limber/time/implicit_pressure.h>

namespace limber
{
  /**
   * Steps as long as the motion of the material allows: the pressure of
   * liquids is found together with the velocity at the end of the step
   * (ImplicitPressure), all other forces are those of its beginning. Points
   * follow the new velocity along its curved field.
   */
  template <int dim>
  class SemiImplicitIntegrator final : public ExplicitIntegrator<dim>
  {
  public:
    explicit SemiImplicitIntegrator(const RunParts<dim> &parts);

    /**
     * The shortest of: the time in which points move by the Courant number in
     * cells; a part of the time in which a surface wave as short as a cell
     * swings, as the surface moves explicitly; a part of the time in which what
     * drives the scene changes; and what waves in other bodies and viscosity
     * allow.
     */
    double
    longest_step() const override;
    void
    reinit() override;
    std::string
    effort() const override;
    std::string
    reason_for_shorter_step() const override;

  private:
    using Base   = ExplicitIntegrator<dim>;
    using Layout = NodeLayout<dim>;

    void
    do_scheme() override;
    void
    find_velocity();
    bool
    is_too_long();
    bool
    is_viscous() const;
    double
    step_of_motion() const;
    void
    resist_hourglass();
    void
    update_liquids();
    void
    update_all();
    double
    correct_density();
    void
    strain_by_heavy_nodes();
    double
    impulse_of_stress(std::uint32_t node, int d) const;
    void
    solve_pressure();
    void
    account(unsigned int velocity_after);
    double
    energy_to_points() const;
    double
    energy_of_points() const;

    ImplicitPressure<dim> pressure;
    LazyArray<double>     hourglass; // forces by node and component, N
    // Way of the fastest node in a step that was too long, cells
    double too_far = 0;
    // The largest by gravity and body force, m/s^2, see largest_acceleration()
    const double acceleration;
    const double time_of_change; // see time_scale_of_formulas(), s
    const bool   viscosity_acts;
    const bool   remaps;         // for solids and viscous liquids
    const double lightest_solid; // its density, kg/m^3; 0: there is none
  };
} // namespace limber

#endif
