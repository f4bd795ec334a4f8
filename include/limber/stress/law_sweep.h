// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_law_sweep_h
#define limber_stress_law_sweep_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/materials/law.h>
#include <limber/stress/stress_update.h>

#include <algorithm>

namespace limber
{
  /** Means over the points of a cell, once average_cells() has made them. */
  template <int dim>
  class CellMeans
  {
  public:
    explicit CellMeans(const double *const cell_sums)
      : record(cell_sums)
    {}

    double
    volumetric() const
    {
      return record[CellSums<dim>::volumetric];
    }

    /**
     * The mean of the divergence of a velocity field, given the coefficients
     * of its components. The gradient of a multilinear function is made of
     * monomials, so its mean over the points is that of the monomials.
     */
    template <class Coefficients>
    double
    divergence(const Coefficients      &coefficients,
               const unsigned int       first,
               const CellGeometry<dim> &cell) const
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        {
          const auto c          = coefficients.component(first + d);
          double     derivative = 0;
          for (int k = 0; k < 1 << dim; ++k)
            if (k >> d & 1)
              derivative += k == 1 << d ? c(k) : c(k) * record[k ^ (1 << d)];
          result += derivative * cell.inverse_edge[d];
        }
      return result;
    }

  private:
    const double *const record; // CellSums
  };



  /** StressUpdate for one law, with or without averages over cells. */
  template <int dim, class Law, bool projected>
  class LawSweep final : public StressUpdate<dim>
  {
  public:
    explicit LawSweep(const Law &law)
      : law(law)
    {}

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim>  *sums,
           const StressSweep    &what) const override
    {
      return what.move ? sweep<true>(points, grid, sums, what) :
                         sweep<false>(points, grid, sums, what);
    }

    StateSummary
    summarize(const PointView<dim> &points) const override
    {
      StateSummary result;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto state =
            load_state<double>(points, [&](const double *a) { return a[p]; });
          result.strain_energy += points.mass[p] * inverse_density *
                                  law.template strain_energy<dim>(state);
          const double J         = law.template volume_ratio<dim>(state);
          result.smallest_volume = std::min(result.smallest_volume, J);
          result.largest_volume  = std::max(result.largest_volume, J);
        }
      return result;
    }

    double
    wave_speed_squared(const PointView<dim> &points) const override
    {
      double result = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        result = std::max(result,
                          law.template wave_speed_squared<dim>(
                            load_state<double>(points, [&](const double *a) {
                              return a[p];
                            })));
      return result;
    }

    double
    volume_ratio_at_rest(const double pressure) const override
    {
      return law.template volume_ratio<dim>(
        law.template initialise<dim>(pressure));
    }

    void
    initialise(const PointView<dim> &points,
               const std::size_t     p,
               const double          pressure) const override
    {
      const auto state = law.template initialise<dim>(pressure);
      store_state(points, state, [&](const double value, double *const a) {
        a[p] = value;
      });
    }

    void
    volume_ratio(const PointView<dim> &points,
                 double *const         volume_ratio) const override
    {
      for (std::size_t p = 0; p < points.size; ++p)
        volume_ratio[p] = law.template volume_ratio<dim>(
          load_state<double>(points, [&](const double *a) { return a[p]; }));
    }

    unsigned int
    n_history() const override
    {
      return Law::template n_history<dim>;
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

  private:
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

    template <class Number>
    static Number &
    volumetric_variable(State<Number> &state)
    {
      if constexpr (Law::volumetric < 0)
        return state.pressure;
      else
        return state.history[Law::volumetric];
    }



    template <bool moves>
    StressSummary
    sweep(const PointView<dim>      &points,
          const GridView<dim>       &grid,
          const CellSums<dim> *const sums,
          const StressSweep         &what) const
    {
      using Number = PointPack<dim>;
      using Kernel = Linear<dim>;
      using Layout = NodeLayout<dim>;

      const unsigned int strained      = what.remapped ? dim : 0;
      const bool         measure_waves = !law.has_constant_wave_speed();
      Number             waves{}, viscous{}, removed{}, displacement{};

      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        // new velocity and, right behind it, the re-mapped one
        const NodalCoefficients<dim, Layout::velocity, 2 * dim> nodal(
          cell, grid.nodes);

        [[maybe_unused]] double mean_volumetric = 0, mean_increment = 0;
        if constexpr (projected)
          {
            const CellMeans<dim> mean(sums->data +
                                      batch.cell * CellSums<dim>::stride);
            mean_volumetric = mean.volumetric();
            mean_increment = what.step * mean.divergence(nodal, strained, cell);
          }

        for_each_pack<dim>(batch, [&](const auto &lanes) {
          const auto xi = lanes.natural(points, cell);

          MotionIncrement<dim, Number> motion;
          motion.step = what.step;
          for (int d = 0; d < dim; ++d)
            {
              const auto gradient =
                Kernel::template gradient<Number>(nodal.component(strained + d),
                                                  xi);
              for (int e = 0; e < dim; ++e)
                motion.gradient[d][e] =
                  (what.step * cell.inverse_edge[e]) * gradient[e];
            }
          motion.volumetric = motion.trace();

          auto state = load_state<Number>(points, [&](const double *a) {
            return lanes.load(a);
          });
          // reference volume, zero in lanes beyond the batch
          [[maybe_unused]] const Number volume =
            lanes.only_active(lanes.load(points.mass)) * inverse_density;

          if constexpr (projected)
            {
              motion.volumetric = broadcast<Number>(mean_increment);
              if (what.relaxation > 0)
                {
                  Number      &variable = volumetric_variable(state);
                  const Number before   = law.volumetric_energy(variable);
                  variable += what.relaxation * (mean_volumetric - variable);
                  removed +=
                    volume * (before - law.volumetric_energy(variable));
                }
            }

          const auto dissipation = law.template update<dim>(motion, state);
          if constexpr (Law::dissipates)
            {
              viscous += volume * dissipation.viscous;
              removed += volume * dissipation.cutoff;
            }
          store_state(points, state, [&](const Number &value, double *a) {
            lanes.store(value, a);
          });
          if (measure_waves)
            waves = larger(waves,
                           lanes.only_active(
                             law.template wave_speed_squared<dim>(state)));

          if constexpr (moves)
            {
              std::array<Number, dim> shift;
              for (int d = 0; d < dim; ++d)
                shift[d] =
                  what.step *
                  Kernel::template value<Number>(nodal.component(d), xi);
              displacement = larger(
                displacement,
                move_points<dim>(points, grid, batch.cell, lanes, shift));
            }
        });
      });

      StressSummary result;
      result.wave_speed_squared =
        measure_waves ? maximum(waves) :
                        law.template wave_speed_squared<dim>(State<double>{});
      result.viscous      = sum(viscous);
      result.history      = sum(removed);
      result.displacement = maximum(displacement);
      return result;
    }

    const Law    law;
    const double inverse_density = 1. / law.density;
  };
} // namespace limber

#endif
