// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_initial_frame_sweep_h
#define limber_stress_initial_frame_sweep_h

#include <limber/interpolation/assumed_deformation.h>
#include <limber/interpolation/basis.h>
#include <limber/stress/law_on_points.h>
#include <limber/transfer/pulled_back_force.h>

#include <optional>

namespace limber
{
  /**
   * StressUpdate in the initial configuration (total Lagrangian): shape
   * functions are evaluated at reference positions, F grows by dt grad_X v, and
   * the stress of an elastic law follows from F alone, so that errors do not
   * accumulate. A plastic law follows f = F_now F_before^-1 from the state
   * before. One velocity (NodeLayout::strain_velocity) strains and moves the
   * points, so that positions agree with F.
   *
   * With the treatment 'cell' the volumetric part of the stress follows from
   * the mean volume ratio of the points of the cell (F-bar); with
   * 'assumed_strain', for linear functions, the whole stress from F_a of
   * assumed_deformation.h. Points never leave their cell, so they always form
   * one batch on one rank, and strain and P2G of forces are done in one sweep.
   * Elastic stress is not stored then.
   */
  template <class Basis, class Law, Treatment kind>
  class InitialFrameSweep final : public LawOnPoints<Basis::dim, Law>
  {
    static constexpr int  dim    = Basis::dim;
    static constexpr bool finite = Law::finite_strain;
    static constexpr bool flows  = Law::is_plastic;
    using Base                   = LawOnPoints<dim, Law>;
    using Base::inverse_density;
    using Base::law;
    using Base::store_state;
    using Number = PointPack<dim>;
    using Matrix = SmallMatrix<dim, Number>;
    using Places = std::array<Number, dim>;

    // F of a point now and before the step
    struct Deformed
    {
      Matrix F, before;
    };

  public:
    InitialFrameSweep(const Law &law, const StrainTreatment &treatment)
      : Base(law)
      , assumption(treatment)
    {}

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim> *,
           const StressSweep &what) const override
    {
      const PackFindings<dim> found = what.give_force ?
                                        sweep<true>(points, grid, what) :
                                        sweep<false>(points, grid, what);
      StressSummary           result;
      result.wave_speed_squared = maximum(found.waves);
      result.plastic            = sum(found.plastic);
      return result;
    }

    void
    sum_deviators(const PointView<dim> &, const CellSums<dim> &) const override
    {
      throw std::logic_error("histories are not averaged in this frame");
    }

    double
    relax_deviators(const PointView<dim> &,
                    const double *,
                    double) const override
    {
      throw std::logic_error("histories are not averaged in this frame");
    }

    /** The stress contains the means already: P2G needs none. */
    const StrainTreatment &
    treatment() const override
    {
      static const StrainTreatment nothing;
      return nothing;
    }

    bool
    gives_force() const override
    {
      return true;
    }

  private:
    // The operations on the points of a cell
    template <bool give_force>
    struct Batch
    {
      using Velocity =
        NodalCoefficients<Basis, NodeLayout<dim>::strain_velocity, dim>;
      using State = typename Base::template State<Number>;

      const InitialFrameSweep &owner;
      const PointView<dim>    &points;
      const GridView<dim>     &grid;
      const CellBatch          batch;
      const CellGeometry<dim> &cell;
      const Velocity           velocity;
      const StressSweep       &what;
      PackFindings<dim>       &found;

      /** Call work(lanes) for each pack. */
      template <class Work>
      __attribute__((always_inline)) void
      for_each_pack(const Work &work) const
      {
        limber::for_each_pack<dim>(batch, work);
      }

      /** Treatment 'none': each point with its own F. */
      __attribute__((always_inline)) void
      at_points() const
      {
        PulledBackForce<Basis> force(grid, batch.cell);
        for_each_pack([&](const auto &lanes) __attribute__((always_inline)) {
          const Places   xi  = lanes.natural(points, cell);
          const Deformed now = deform(lanes, xi);
          const Number   J   = volume_ratio_of(now.F);
          const State    state =
            stress_at(now, J, growth_of(J, now.before), lanes);
          give(state, state.pressure, now.F, J, xi, lanes, force);
        });
        if constexpr (give_force)
          force.add_to_nodes();
      }

      /** Treatment 'cell': with the mean volume ratio. */
      __attribute__((always_inline)) void
      with_mean_volume() const
      {
        Number mass{}, volume{}, volume_before{};
        for_each_pack([&](const auto &lanes) __attribute__((always_inline)) {
          const Deformed now = deform(lanes, lanes.natural(points, cell));
          const Number   m   = lanes.only_active(lanes.load(points.mass));
          mass += m;
          volume += m * volume_ratio_of(now.F);
          if constexpr (flows)
            volume_before += m * volume_ratio_of(now.before);
        });
        const Number J = broadcast<Number>(sum(volume) / sum(mass));

        PulledBackForce<Basis> force(grid, batch.cell);
        if constexpr (flows)
          flow_with_mean_volume(
            J,
            broadcast<Number>(sum(volume) / sum(volume_before)),
            owner.inverse_density * broadcast<Number>(sum(mass)),
            force);
        else
          for_each_pack([&](const auto &lanes) __attribute__((always_inline)) {
            const Matrix F     = deformation_gradient<dim>(points, lanes);
            const State  state = stress_at({F, F}, J, J, lanes);
            give(state,
                 state.pressure,
                 F,
                 J,
                 lanes.natural(points, cell),
                 lanes,
                 force);
          });
        if constexpr (give_force)
          force.add_to_nodes();
      }

      // Each point does its return mapping at the mean growth of the volume.
      // The derivative of their energy by it is the mean of J p, which is
      // therefore the pressure of all points in the force.
      __attribute__((always_inline)) void
      flow_with_mean_volume(const Number           &J,
                            const Number           &growth,
                            const Number           &volume,
                            PulledBackForce<Basis> &force) const
      {
        Number pressure{};
        for_each_pack([&](const auto &lanes) __attribute__((always_inline)) {
          const Matrix F  = deformation_gradient<dim>(points, lanes);
          const Places xi = lanes.natural(points, cell);
          const State  state =
            stress_at({F, deformation_before(F, xi)}, J, growth, lanes);
          pressure += volume_of(lanes) * state.pressure;
        });
        if constexpr (give_force)
          {
            pressure = broadcast<Number>(sum(pressure)) / volume;
            for_each_pack([&](const auto &lanes)
                            __attribute__((always_inline)) {
                              give(owner.stored_state(points, lanes),
                                   pressure,
                                   deformation_gradient<dim>(points, lanes),
                                   J,
                                   lanes.natural(points, cell),
                                   lanes,
                                   force);
                            });
          }
      }

      /** Update F += dt grad_X v and x += dt v. */
      template <class Lanes>
      __attribute__((always_inline)) Deformed
      deform(const Lanes &lanes, const Places &xi) const
      {
        Deformed result;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            const auto component = velocity.component(d);
            const auto slope = Basis::template gradient<Number>(component, xi);
#pragma GCC unroll 8
            for (int e = 0; e < dim; ++e)
              {
                double *const array = points.deformation[d * dim + e];
                result.before[d][e] = lanes.load(array);
                result.F[d][e]      = result.before[d][e] +
                                 (what.step * cell.inverse_edge[e]) * slope[e];
                lanes.store(result.F[d][e], array);
              }
            lanes.store(lanes.load(points.position[d]) +
                          what.step *
                            Basis::template value<Number>(component, xi),
                        points.position[d]);
          }
        return result;
      }

      /** F before deform(), from @p F after it. */
      __attribute__((always_inline)) Matrix
      deformation_before(Matrix F, const Places &xi) const
      {
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            const auto slope =
              Basis::template gradient<Number>(velocity.component(d), xi);
#pragma GCC unroll 8
            for (int e = 0; e < dim; ++e)
              F[d][e] -= (what.step * cell.inverse_edge[e]) * slope[e];
          }
        return F;
      }

      /** Add the internal force of a stress. */
      template <class Lanes>
      __attribute__((always_inline)) void
      give(const State            &state,
           const Number           &pressure,
           const Matrix           &F,
           const Number           &J,
           const Places           &xi,
           const Lanes            &lanes,
           PulledBackForce<Basis> &force) const
      {
        if constexpr (give_force)
          {
            auto VP        = piola_kirchhoff_stress<dim, finite>(state.deviator,
                                                          pressure,
                                                          F,
                                                          J);
            const Number V = volume_of(lanes);
            for (auto &row : VP)
              for (Number &entry : row)
                entry *= V;
            force.add(VP, xi, lanes);
          }
      }

      /**
       * Stress at the volume ratio J or, with a plastic law, its growth in the
       * step.
       */
      template <class Lanes>
      __attribute__((always_inline)) State
      stress_at(const Deformed                &now,
                [[maybe_unused]] const Number &J,
                [[maybe_unused]] const Number &growth,
                const Lanes                   &lanes) const
      {
        State state;
        if constexpr (flows)
          state = flow(now, growth, lanes);
        else
          state = owner.law.template at_deformation<dim>(now.F, J);
        if constexpr (flows || !give_force)
          store_state(points,
                      state,
                      [&](const Number &value, double *const array) {
                        lanes.store(value, array);
                      });
        Number speed = owner.law.template wave_speed_squared<dim>(state);
        if constexpr (finite)
          speed *= largest_shortening(now.F);
        found.waves = larger(found.waves, lanes.only_active(speed));
        return state;
      }

      /**
       * Plastic law: state after the step, with the given growth of the volume.
       */
      template <class Lanes>
      __attribute__((always_inline)) State
      flow(const Deformed &now, const Number &growth, const Lanes &lanes) const
      {
        if (!(what.step > 0))
          return owner.stored_state(points, lanes);
        return owner.flow(points,
                          lanes,
                          times_inverse<dim>(now.F, now.before),
                          growth,
                          what.step,
                          found);
      }

      /** Growth of the volume ratio to J since @p before. */
      __attribute__((always_inline)) static Number
      growth_of(const Number &J, [[maybe_unused]] const Matrix &before)
      {
        if constexpr (flows)
          return J / volume_ratio_of(before);
        else
          return J;
      }

      /** Initial volume, m^dim; zero in idle lanes. */
      template <class Lanes>
      __attribute__((always_inline)) Number
      volume_of(const Lanes &lanes) const
      {
        return owner.inverse_density *
               lanes.only_active(lanes.load(points.mass));
      }
    };



    /**
     * A cell with assumed strain (F_a). Its operations are one long dependency
     * chain: the mean of its points rotates the frame in which each is
     * strained, and the mean of their stress acts on all. So its stages are
     * done for a few cells in turn, such that the processor works on one while
     * another waits.
     */
    template <bool give_force>
    class AssumedCell
    {
    public:
      __attribute__((always_inline)) explicit AssumedCell(
        const Batch<give_force> &batch)
        : points(batch)
        , assumed(batch.owner.assumption)
        , assumed_before(batch.owner.assumption)
        , stress(batch.cell, assumed)
      {}

      AssumedCell(const AssumedCell &) = delete; // stress refers to assumed

      __attribute__((always_inline)) void
      deform()
      {
        points.for_each_pack([&](
          const auto &lanes) __attribute__((always_inline)) {
          const Places   xi  = lanes.natural(points.points, points.cell);
          const Deformed now = points.deform(lanes, xi);
          const Number mass = lanes.only_active(lanes.load(points.points.mass));
          assumed.add(now.F, xi, mass);
          if constexpr (flows)
            assumed_before.add(now.before, xi, mass);
        });
        assumed.finish();
        if constexpr (flows)
          assumed_before.finish();
      }

      __attribute__((always_inline)) void
      find_stress()
      {
        std::size_t n = 0;
        points.for_each_pack([&](
          const auto &lanes) __attribute__((always_inline)) {
          KeptPack &pack = n < n_kept ? kept[n] : other;
          ++n;
          stress_of(lanes, pack, false);
          if constexpr (give_force && finite)
            stress.add_to_mean_volume(pack.of_volume, pack.J, pack.V);
          if constexpr (give_force)
            stress.add_to_means(pack.P, pack.xi, pack.V);
        });
        if constexpr (give_force)
          stress.finish_means();
      }

      __attribute__((always_inline)) void
      add_force()
      {
        std::size_t n = 0;
        points.for_each_pack([&](const auto &lanes)
                               __attribute__((always_inline)) {
                                 const bool is_kept = n < n_kept;
                                 KeptPack  &pack    = is_kept ? kept[n] : other;
                                 ++n;
                                 if (rarely(!is_kept))
                                   stress_of(lanes, pack, true);
                                 stress.add(pack.P, pack.F, pack.xi, pack.V);
                               });
        add_to_nodes<dim, NodeLayout<dim>::force>(points.cell,
                                                  stress.forces(),
                                                  points.grid.nodes);
      }

    private:
      struct Nothing
      {
        explicit Nothing(const StrainTreatment &)
        {}
      };

      // The first packs, usually all of them, are kept for the second pass.
      struct KeptPack
      {
        Matrix F, P;
        Places xi;
        Number V, J, of_volume; // m^dim; J_a; dW/dJ_a, Pa
      };

      template <class Lanes>
      __attribute__((always_inline)) void
      stress_of(const Lanes                &lanes,
                KeptPack                   &pack,
                [[maybe_unused]] const bool again) const
      {
        pack.xi             = lanes.natural(points.points, points.cell);
        pack.F              = deformation_gradient<dim>(points.points, lanes);
        const Matrix strain = assumed.evaluate(pack.F, pack.xi);
        const Matrix F      = assumed.turned(strain);
        const Number J      = assumed.volume_ratio(strain);
        Matrix       before = F;
        Number       growth = J;
        if constexpr (flows)
          {
            before = assumed_before.evaluate(points.deformation_before(pack.F,
                                                                       pack.xi),
                                             pack.xi);
            growth /= assumed_before.volume_ratio(before);
            before = assumed_before.turned(before);
          }
        const auto state = flows && again ?
                             points.owner.stored_state(points.points, lanes) :
                             points.stress_at({F, before}, J, growth, lanes);
        if constexpr (give_force)
          {
            pack.P = assumed.turned_back(piola_kirchhoff_stress<dim, finite>(
              state.deviator, finite ? Number{} : state.pressure, F, J));
            pack.V = points.volume_of(lanes);
            if constexpr (finite)
              {
                pack.J         = J;
                pack.of_volume = -state.pressure / J;
                for (int d = 0; d < dim; ++d)
                  pack.P[d][d] += pack.of_volume * assumed.volume;
              }
          }
      }

      const Batch<give_force>         points;
      AssumedDeformation<dim, finite> assumed;
      std::conditional_t<flows, AssumedDeformation<dim, finite>, Nothing>
                                            assumed_before;
      AssumedDeformationStress<dim, finite> stress;
      static constexpr std::size_t          n_kept = 4;
      std::array<KeptPack, n_kept>          kept;
      KeptPack                              other;
    };



    /** A few cells with assumed strain, processed together. */
    template <bool give_force>
    class AssumedCells
    {
    public:
      __attribute__((always_inline)) void
      add(const Batch<give_force> &batch)
      {
        cells[n].emplace(batch);
        if (++n == cells.size())
          work();
      }

      __attribute__((always_inline)) void
      work()
      {
        for (std::size_t k = 0; k < n; ++k)
          cells[k]->deform();
        for (std::size_t k = 0; k < n; ++k)
          cells[k]->find_stress();
        if constexpr (give_force)
          for (std::size_t k = 0; k < n; ++k)
            cells[k]->add_force();
        n = 0;
      }

    private:
      static constexpr std::size_t together = dim == 2 ? 4 : 1;
      std::array<std::optional<AssumedCell<give_force>>, together> cells;
      std::size_t                                                  n = 0;
    };



    template <bool give_force>
    PackFindings<dim>
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const StressSweep    &what) const
    {
      PackFindings<dim>                         found;
      [[maybe_unused]] AssumedCells<give_force> assumed;
      for_each_batch(
        points,
        [&](const CellBatch &cell_batch) __attribute__((always_inline)) {
          const Batch<give_force> batch{*this,
                                        points,
                                        grid,
                                        cell_batch,
                                        grid.cells[cell_batch.cell],
                                        {grid, cell_batch.cell},
                                        what,
                                        found};
          if constexpr (kind == Treatment::none)
            batch.at_points();
          else if constexpr (kind == Treatment::cell)
            batch.with_mean_volume();
          else
            assumed.add(batch);
        });
      if constexpr (kind == Treatment::assumed_strain)
        assumed.work();
      return found;
    }

    static Number
    volume_ratio_of(const Matrix &F)
    {
      if constexpr (Law::finite_strain)
        return determinant<dim>(F);
      Number result = F[0][0];
      for (int d = 1; d < dim; ++d)
        result += F[d][d] - 1.;
      return result;
    }

    /**
     * An upper bound (Gershgorin) of the largest eigenvalue of F^-1 F^-T: the
     * square of the initial lengths that a wave passes per present length. One
     * at rest and in any rotation.
     */
    static Number
    largest_shortening(const Matrix &F)
    {
      const Matrix cof  = cofactor<dim>(F);
      const Number J    = determinant<dim>(F);
      Number       most = Number{};
      for (int i = 0; i < dim; ++i)
        {
          Number row{};
          for (int j = 0; j < dim; ++j)
            {
              Number entry{};
              for (int k = 0; k < dim; ++k)
                entry += cof[k][i] * cof[k][j];
              row += magnitude(entry);
            }
          most = larger(most, row);
        }
      return most / (J * J);
    }

    const StrainTreatment assumption; // for the assumed strain
  };
} // namespace limber

#endif
