// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_law_sweep_h
#define limber_stress_law_sweep_h

#include <limber/interpolation/strain_operator.h>
#include <limber/stress/law_on_points.h>

namespace limber
{
  /** (1 + a/2) u: the way u along a field that changes by a on the way. */
  template <int dim, class Number>
  std::array<Number, dim>
  curve(const std::array<Number, dim>                  &u,
        const std::array<std::array<Number, dim>, dim> &a)
  {
    std::array<Number, dim> result = u;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        result[d] += 0.5 * (a[d][e] * u[e]);
    return result;
  }



  /** StressUpdate for one basis, one law and one projection of its strain. */
  template <class Basis, class Law, Projection kind>
  class LawSweep final : public LawOnPoints<Basis::dim, Law>
  {
    static constexpr int dim = Basis::dim;
    using Base               = LawOnPoints<dim, Law>;
    using Base::inverse_density;
    using Base::law;
    using Base::state_of;
    using Base::store_state;

  public:
    LawSweep(const Law &law, const StrainProjection &projection)
      : Base(law)
      , strain_projection(projection)
    {}

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim>  *sums,
           const StressSweep    &what) const override
    {
      return what.move > 0 ? sweep<true>(points, grid, sums, what) :
                             sweep<false>(points, grid, sums, what);
    }

    void
    sum_deviators(const PointView<dim> &points,
                  const CellSums<dim>  &sums) const override
    {
      if constexpr (Law::keeps_deviator)
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const auto e =
              law.template deviatoric_strain<dim>(state_of(points, p));
            double *const record = sums.open(points.cell[p]);
            record[DeviatorSums::mass] += points.mass[p];
            for (unsigned int k = 0; k < e.size(); ++k)
              record[DeviatorSums::strain + k] += points.mass[p] * e[k];
          }
      else
        throw std::logic_error("no deviatoric history");
    }

    double
    relax_deviators(const PointView<dim> &points,
                    const double *const   sums,
                    const double          share) const override
    {
      double removed = 0;
      if constexpr (Law::keeps_deviator && averages_shear_in_cells(kind))
        for (std::size_t p = 0; p < points.size; ++p)
          {
            auto                state = state_of(points, p);
            auto                e = law.template deviatoric_strain<dim>(state);
            const double *const record =
              sums + points.cell[p] * DeviatorSums::stride;
            const double inverse_mass = 1 / record[DeviatorSums::mass];
            for (unsigned int k = kind == Projection::cell_full ? 0 : 2;
                 k < e.size();
                 ++k)
              e[k] += share *
                      (record[DeviatorSums::strain + k] * inverse_mass - e[k]);
            const double before = law.template deviatoric_energy<dim>(state);
            law.template set_deviatoric_strain<dim>(state, e);
            removed += points.mass[p] * inverse_density *
                       (before - law.template deviatoric_energy<dim>(state));
            store_state(points,
                        state,
                        [&](const double value, double *const a) {
                          a[p] = value;
                        });
          }
      else
        throw std::logic_error("no deviatoric history that is averaged");
      return removed;
    }

    const StrainProjection &
    projection() const override
    {
      return strain_projection;
    }

  private:
    using DeviatorSums = limber::DeviatorSums<dim>;

    template <class Number>
    using State = typename Base::template State<Number>;

    template <class Number>
    static Number &
    volumetric_variable(State<Number> &state)
    {
      if constexpr (Law::volumetric < 0)
        return state.pressure;
      else
        return state.history[Law::volumetric];
    }



    // What the points of a batch share. One object, so that work on a pack,
    // which is called apart for the last points of a batch, knows it by one
    // address: to pass every part by its own took a fifth of the sweep.
    struct Batch
    {
      using Layout = NodeLayout<dim>;
      using Nodal  = NodalCoefficients<Basis, Layout::velocity, 2 * dim>;
      using Field  = typename Nodal::VectorField;

      __attribute__((always_inline)) Batch(const LawSweep      &sweep,
                                           const CellBatch     &batch,
                                           const GridView<dim> &grid,
                                           const CellSums<dim> *sums,
                                           const StressSweep   &what)
        : cell_number(batch.cell)
        , cell(grid.cells[batch.cell])
        , nodal(grid, batch.cell)
        , strained(nodal.field(what.remapped ? dim : 0))
        , means(sums, batch.cell)
        , shift(what.shift ? what.shift_share * what.shift[batch.cell] : 0)
        , implicit(kind == Projection::cell ? what.implicit : nullptr)
        , divergence(what.projected_divergence, cell)
        , strain(strained,
                 cell,
                 means,
                 divergence,
                 sweep.strain_projection,
                 what.step)
      {}

      Batch(const Batch &) = delete; // the parts know each other's addresses

      const std::uint32_t                      cell_number;
      const CellGeometry<dim>                 &cell;
      const Nodal                              nodal; // new, then re-mapped
      const Field                              strained;
      const CellMeans<Basis>                   means;
      const double                             shift;
      const CellPressures *const               implicit;
      const NodalMean<dim, kind>               divergence;
      const StrainOperator<Basis, kind, Field> strain;
    };



    // A sweep in progress.
    template <bool moves>
    struct Sweep
    {
      using Number = PointPack<dim>;

      template <class Lanes>
      __attribute__((always_inline)) void
      update(const Batch &batch, const Lanes &lanes)
      {
        const auto xi = lanes.natural(points, batch.cell);

        MotionIncrement<dim, Number> motion;
        motion.step   = what.step;
        motion.square = what.square;
        batch.strain.template evaluate<Number, Law::uses_spin>(xi, motion);
        if (rarely(batch.implicit != nullptr))
          {
            motion.mean_volume = true;
            motion.volumetric += batch.implicit->dilation[batch.cell_number];
          }

        auto state = owner.strain(
          points,
          lanes,
          motion,
          [&](State<Number> & former, const Number &mass)
            __attribute__((always_inline)) {
              if constexpr (projected)
                if (changes_history)
                  change_history(batch, mass, volumetric_variable(former));
            },
          measure_waves,
          found);

        if (rarely(batch.implicit != nullptr))
          lanes.store(broadcast<Number>(
                        batch.implicit->pressure[batch.cell_number]),
                      points.pressure);

        if constexpr (moves)
          {
            std::array<Number, dim> shift;
            for (int d = 0; d < dim; ++d)
              shift[d] =
                what.move *
                Basis::template value<Number>(batch.nodal.component(d), xi);
            if (rarely(what.curved))
              shift = curve<dim>(shift, motion.gradient);
            const auto moved =
              move_points<dim>(points, grid, batch.cell_number, lanes, shift);
            displacement = larger(displacement, moved.displacement);
            // without means over cells the sums may still be wanted
            if (needs_cell_means(kind) || (projected && sums))
              {
                const CellGatherer<Basis> gatherer(*sums);
                if (moved.inside)
                  gatherer.add(batch.cell_number,
                               moved.xi,
                               lanes.only_active(lanes.load(points.mass)),
                               volumetric_variable(state));
                else
                  gatherer.add_one_by_one(points,
                                          grid,
                                          lanes.first,
                                          lanes.first + lanes.n);
              }
          }
      }

      /** Towards the mean of the cell, or by what the cell gets. */
      __attribute__((always_inline)) void
      change_history(const Batch &batch, const Number &mass, Number &variable)
      {
        const Number before = owner.law.volumetric_energy(variable);
        variable +=
          what.relaxation * (batch.means.volumetric() - variable) + batch.shift;
        found.removed += mass * owner.inverse_density *
                         (before - owner.law.volumetric_energy(variable));
      }

      const LawSweep            &owner;
      const PointView<dim>      &points;
      const GridView<dim>       &grid;
      const CellSums<dim> *const sums;
      const StressSweep         &what;
      const bool                 measure_waves, changes_history;
      typename Base::Findings    found{};
      Number                     displacement{};
    };



    template <bool moves>
    StressSummary
    sweep(const PointView<dim>      &points,
          const GridView<dim>       &grid,
          const CellSums<dim> *const sums,
          const StressSweep         &what) const
    {
      Sweep<moves> sweep{*this,
                         points,
                         grid,
                         sums,
                         what,
                         !law.has_constant_wave_speed(),
                         what.relaxation > 0 || what.shift != nullptr};
      for_each_batch(
        points,
        [&](const CellBatch &cell_batch) __attribute__((always_inline)) {
          const Batch batch(*this, cell_batch, grid, sums, what);
          for_each_pack<dim>(
            cell_batch, [&](const auto &lanes) __attribute__((always_inline)) {
              sweep.update(batch, lanes);
            });
        });

      StressSummary result = this->summary(sweep.found, sweep.measure_waves);
      result.displacement  = maximum(sweep.displacement);
      return result;
    }

    static constexpr bool projected = kind != Projection::none;

    const StrainProjection strain_projection;
  };
} // namespace limber

#endif
