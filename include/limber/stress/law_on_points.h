// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_law_on_points_h
#define limber_stress_law_on_points_h

#include <limber/materials/further_deformation.h>
#include <limber/stress/pack_strain.h>

#include <algorithm>
#include <stdexcept>

namespace limber
{
  /**
   * The part of a StressUpdate that depends on the law and the points alone,
   * not on the grid.
   */
  template <int dim, class Law>
  class LawOnPoints : public StressUpdate<dim>
  {
  public:
    explicit LawOnPoints(const Law &law)
      : law(law)
    {}

    StateSummary
    summarize(const PointView<dim> &points) const override
    {
      using Number = PointPack<dim>;
      StateSummary result;
      Number       smallest = broadcast<Number>(result.smallest_volume),
             largest        = broadcast<Number>(result.largest_volume);
      for_each_block(points.size, [&](const CellBatch &block) {
        Number energy{};
        for_each_pack<dim>(block, [&](const auto &lanes) {
          const auto state = load_state<Number>(points, [&](const double *a) {
            return lanes.load(a);
          });
          energy += lanes.only_active(lanes.load(points.mass)) *
                    law.template strain_energy<dim>(state);
          const Number J = law.template volume_ratio<dim>(state);
          smallest       = smaller(J, smallest);
          largest        = larger(J, largest);
        });
        result.strain_energy += sum(energy) * inverse_density;
      });
      result.smallest_volume = minimum(smallest);
      result.largest_volume  = maximum(largest);
      return result;
    }

    double
    wave_speed_squared(const PointView<dim> &points) const override
    {
      double result = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        result =
          std::max(result,
                   law.template wave_speed_squared<dim>(state_of(points, p)));
      return result;
    }

    double
    deviatoric_wave_speed_squared(const PointView<dim> &points) const override
    {
      double result = 0;
      if constexpr (Law::is_elastic)
        for (std::size_t p = 0; p < points.size; ++p)
          result = std::max(result,
                            law.template deviatoric_wave_speed_squared<dim>(
                              state_of(points, p)));
      return result;
    }

    VolumetricResponse
    volumetric_response(const double variable) const override
    {
      if constexpr (Law::takes_pressure || Law::is_elastic)
        return {law.kirchhoff_pressure(variable),
                law.kirchhoff_stiffness(variable)};
      else
        throw std::logic_error("no implicit pressure");
    }

    double
    volume_ratio_at(const PointStart<dim> &start) const override
    {
      if constexpr (Law::is_elastic)
        if constexpr (!Law::finite_strain)
          return 1;
      return law.template volume_ratio<dim>(state_at(start));
    }

    bool
    initialise(const PointView<dim>  &points,
               const std::size_t      p,
               const PointStart<dim> &start) const override
    {
      const auto state = state_at(start);
      store_state(points, state, [&](const double value, double *const a) {
        a[p] = value;
      });
      if constexpr (Law::takes_pressure)
        return true;
      else
        return law.template admits<dim>(state);
    }

    void
    volume_ratio(const PointView<dim> &points,
                 double *const         volume_ratio) const override
    {
      for (std::size_t p = 0; p < points.size; ++p)
        volume_ratio[p] = law.template volume_ratio<dim>(state_of(points, p));
    }

    double
    stretch_along(const PointView<dim>          &points,
                  const std::size_t              p,
                  const std::array<double, dim> &direction) const override
    {
      return law.template stretch_along<dim>(state_of(points, p), direction);
    }

    unsigned int
    n_history() const override
    {
      return Law::template n_history<dim>;
    }

    unsigned int
    first_variable() const override
    {
      return index_of_variable<dim, Law>(0);
    }

    bool
    has_deviator() const override
    {
      return Law::has_deviator;
    }

    int
    volumetric() const override
    {
      return Law::volumetric;
    }

    double
    density() const override
    {
      return law.density;
    }

    double
    viscosity() const override
    {
      return law.dynamic_viscosity();
    }

  protected:
    template <class Number>
    using State = PointState<dim, Number, Law::template n_history<dim>>;

    template <class Number, class Load>
    static State<Number>
    load_state(const PointView<dim> &points, const Load &load)
    {
      State<Number> state;
      state.pressure = load(points.pressure);
      if constexpr (Law::has_deviator)
        for (unsigned int k = 0; k < state.deviator.size(); ++k)
          state.deviator[k] = load(points.deviator[k]);
      for (unsigned int k = 0; k < state.history.size(); ++k)
        state.history[k] = load(points.history[k]);
      return state;
    }

    State<double>
    state_at(const PointStart<dim> &start) const
    {
      if constexpr (Law::takes_pressure)
        return law.template initialise<dim>(start.pressure);
      else
        {
          State<double> state = law.template initialise<dim>(0);
          for (unsigned int k = 0; k < Law::variables.size(); ++k)
            if (start.variables[k])
              state.history[first_variable() + k] = *start.variables[k];
          if (!start.is_under_stress())
            return state;
          // Kirchhoff stress includes the inelastic volume ratio of the
          // variables
          double volume = 1;
          if constexpr (Law::volumetric >= 0)
            volume = law.template volume_ratio<dim>(state) /
                     state.history[Law::volumetric];
          auto deviator = start.deviator;
          for (double &component : deviator)
            component *= volume;
          law.template start_under<dim>(state,
                                        volume * start.pressure,
                                        deviator);
          return state;
        }
    }

    static State<double>
    state_of(const PointView<dim> &points, const std::size_t p)
    {
      return load_state<double>(points, [&](const double *a) { return a[p]; });
    }

    using Findings = PackFindings<dim>;

    template <class Number>
    static Number &
    volumetric_variable(State<Number> &state)
    {
      if constexpr (Law::volumetric < 0)
        return state.pressure;
      else
        return state.history[Law::volumetric];
    }

    /**
     * Apply the law to a pack of points, after the change of their volumetric
     * history; returns their volumetric variable.
     */
    template <class Lanes>
    __attribute__((always_inline)) PointPack<dim>
    strain(const PointView<dim>                       &points,
           const Lanes                                &lanes,
           const MotionIncrement<dim, PointPack<dim>> &motion,
           const HistoryChange                        &change,
           const bool                                  measure_waves,
           Findings                                   &found) const
    {
      using Number = PointPack<dim>;
      auto state   = stored_state(points, lanes);
      // zero in lanes beyond the batch
      [[maybe_unused]] const Number mass =
        lanes.only_active(lanes.load(points.mass));
      if (change.any)
        {
          Number      &variable = volumetric_variable(state);
          const Number before   = variable;
          variable += change.share * (change.mean - variable) + change.shift;
          found.removed -= mass * inverse_density *
                           law.volumetric_energy_gain(before, variable);
        }

      const auto dissipation = law.template update<dim>(motion, state);
      if constexpr (Law::is_plastic)
        found.plastic += mass * inverse_density * dissipation.plastic;
      else if constexpr (Law::dissipates)
        {
          found.viscous += mass * inverse_density * dissipation.viscous;
          found.removed += mass * inverse_density * dissipation.cutoff;
        }
      store_state(points, state, [&](const Number &value, double *a) {
        lanes.store(value, a);
      });
      if (measure_waves)
        found.waves = larger(found.waves,
                             lanes.only_active(
                               law.template wave_speed_squared<dim>(state)));
      return volumetric_variable(state);
    }

    template <class Lanes>
    static State<PointPack<dim>>
    stored_state(const PointView<dim> &points, const Lanes &lanes)
    {
      return load_state<PointPack<dim>>(points, [&](const double *a) {
        return lanes.load(a);
      });
    }

    /**
     * The states of a pack after a step of a plastic law in which they were
     * deformed by @p f and their volume ratio grew by the factor @p growth. Not
     * inlined, shared by all bases, as it takes long to compile.
     */
    template <class Lanes>
    __attribute__((noinline)) State<PointPack<dim>>
    flow(const PointView<dim>                   &points,
         const Lanes                            &lanes,
         const SmallMatrix<dim, PointPack<dim>> &f,
         const PointPack<dim>                   &growth,
         const double                            step,
         Findings                               &found) const
    {
      auto       state = stored_state(points, lanes);
      const auto work  = return_map<dim>(law, f, growth, step, state);
      found.plastic +=
        lanes.only_active(lanes.load(points.mass)) * inverse_density * work;
      return state;
    }

    /** The part of the summary that follows from the findings. */
    StressSummary
    summary(const Findings &found, const bool measure_waves) const
    {
      StressSummary result;
      result.wave_speed_squared =
        measure_waves ? maximum(found.waves) :
                        law.template wave_speed_squared<dim>(State<double>{});
      result.viscous = sum(found.viscous);
      result.history = sum(found.removed);
      result.plastic = sum(found.plastic);
      return result;
    }

    template <class Number, class Store>
    static void
    store_state(const PointView<dim> &points,
                const State<Number>  &state,
                const Store          &store)
    {
      store(state.pressure, points.pressure);
      if constexpr (Law::has_deviator)
        for (unsigned int k = 0; k < state.deviator.size(); ++k)
          store(state.deviator[k], points.deviator[k]);
      for (unsigned int k = 0; k < state.history.size(); ++k)
        store(state.history[k], points.history[k]);
    }

    const Law    law;
    const double inverse_density = 1. / law.density;
  };
} // namespace limber

#endif
