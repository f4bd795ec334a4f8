// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_strain_sweep_h
#define limber_stress_strain_sweep_h

#include <limber/interpolation/strain_operator.h>
#include <limber/interpolation/uniform_divergence.h>
#include <limber/stress/law_on_points.h>

namespace limber
{
  /**
   * (1 + a/2) u: displacement along a field whose increment has the gradient a.
   */
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



  /**
   * The sweep that strains points by a basis with a shared stencil and one
   * treatment, and moves them. The law is strain(points, lanes, motion, change,
   * found), which updates a pack whose motion is known and returns its
   * volumetric variables (LawOnPoints::strain).
   */
  template <class Basis, Treatment kind, bool uses_spin, class Strain>
  class StrainSweep
  {
    static constexpr int dim = Basis::dim;
    using Number             = PointPack<dim>;

  public:
    /**
     * Returns how far points have moved; results of the law are in @p found.
     */
    static StressSummary
    run(const PointView<dim>      &points,
        const GridView<dim>       &grid,
        const CellSums<dim> *const sums,
        const StressSweep         &what,
        const StrainTreatment     &treatment,
        const Strain              &strain,
        PackFindings<dim>         &found)
    {
      return what.move > 0 ?
               run<true>(points, grid, sums, what, treatment, strain, found) :
               run<false>(points, grid, sums, what, treatment, strain, found);
    }

  private:
    // Data that the points of a batch share, in one object such that the
    // out-of-line function for incomplete packs gets one address: to pass each
    // part by its own took a fifth of the sweep.
    struct Batch
    {
      using Layout = NodeLayout<dim>;
      using Nodal  = NodalCoefficients<Basis, Layout::velocity, 2 * dim>;
      using Field  = typename Nodal::VectorField;

      __attribute__((always_inline)) Batch(const StrainTreatment &treatment,
                                           const CellBatch       &batch,
                                           const GridView<dim>   &grid,
                                           const CellSums<dim>   *sums,
                                           const StressSweep     &what)
        : cell_number(batch.cell)
        , cell(grid.cells[batch.cell])
        , nodal(grid, batch.cell)
        , strained(nodal.field(what.remapped ? dim : 0))
        , means(sums, batch.cell)
        , shift(what.shift ? what.shift_share * what.shift[batch.cell] : 0)
        , implicit(kind == Treatment::cell ? what.implicit : nullptr)
        , is_cut(implicit != nullptr && implicit->cuts_tension &&
                 implicit->pressure[batch.cell] == 0)
        , divergence(what.projected_divergence, cell)
        , strain(strained, cell, means, divergence, treatment, what.step)
      {}

      Batch(const Batch &) = delete; // the parts know each other's addresses

      const std::uint32_t                      cell_number;
      const CellGeometry<dim>                 &cell;
      const Nodal                              nodal; // new, then re-mapped
      const Field                              strained;
      const CellMeans<Basis>                   means;
      const double                             shift;
      const CellPressures *const               implicit;
      const bool                               is_cut; // tension
      const NodalMean<dim, kind>               divergence;
      const StrainOperator<Basis, kind, Field> strain;
    };



    // A sweep in progress.
    template <bool moves>
    struct Progress
    {
      template <class Lanes>
      __attribute__((always_inline)) void
      update(const Batch &batch, const Lanes &lanes)
      {
        const auto xi = lanes.natural(points, batch.cell);

        MotionIncrement<dim, Number> motion;
        motion.step   = what.step;
        motion.square = what.square;
        batch.strain.template evaluate<Number, uses_spin>(xi, motion);
        if constexpr (kind == Treatment::cell)
          if (rarely(what.volume_shares != nullptr && !batch.implicit))
            // including the second order in the step, as volume would grow in
            // rotations otherwise
            motion.volumetric += (what.volume_shares[batch.cell_number] - 1) *
                                 (motion.volume_ratio() - 1.);
        if (rarely(batch.implicit != nullptr))
          {
            motion.mean_volume    = true;
            const double dilation = batch.implicit->dilation[batch.cell_number];
            if (batch.implicit->is_whole)
              motion.volumetric = broadcast<Number>(dilation);
            else
              motion.volumetric =
                what.volume_shares ?
                  what.volume_shares[batch.cell_number] * motion.volumetric +
                    dilation :
                  motion.volumetric + dilation;
          }

        // relaxation to the cell mean, and checkerboard control
        HistoryChange change;
        if constexpr (projected)
          if (changes_history)
            change = {true,
                      what.relaxation,
                      batch.means.volumetric(),
                      batch.shift};
        if (rarely(batch.is_cut))
          {
            change            = {true, 1, 1, 0};
            motion.volumetric = Number{};
          }
        const Number volumetric = strain(points, lanes, motion, change, found);

        if (rarely(batch.implicit != nullptr && batch.implicit->pressure))
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
            if constexpr (kind == Treatment::cell &&
                          std::is_same_v<Basis, Linear<dim>>)
              if (rarely(what.uniform_divergence))
                {
                  const auto beyond = beyond_uniform_divergence<dim, Number>(
                    [&](const int d) { return batch.nodal.component(d); },
                    batch.cell,
                    batch.means,
                    xi);
                  for (int d = 0; d < dim; ++d)
                    shift[d] -= what.move * beyond[d];
                }
            const auto moved =
              move_points<dim>(points, grid, batch.cell_number, lanes, shift);
            displacement = larger(displacement, moved.displacement);
            // sums may be wanted even without means over cells
            if (needs_cell_means(kind) || (projected && sums))
              {
                const CellGatherer<Basis> gatherer(*sums);
                if (moved.inside)
                  gatherer.add(batch.cell_number,
                               moved.xi,
                               lanes.only_active(lanes.load(points.mass)),
                               volumetric);
                else
                  gatherer.add_one_by_one(points,
                                          grid,
                                          lanes.first,
                                          lanes.first + lanes.n);
              }
          }
      }

      const PointView<dim>      &points;
      const GridView<dim>       &grid;
      const CellSums<dim> *const sums;
      const StressSweep         &what;
      const Strain              &strain;
      const bool                 changes_history;
      PackFindings<dim>          found{};
      Number                     displacement{};
    };



    template <bool moves>
    static StressSummary
    run(const PointView<dim>      &points,
        const GridView<dim>       &grid,
        const CellSums<dim> *const sums,
        const StressSweep         &what,
        const StrainTreatment     &treatment,
        const Strain              &strain,
        PackFindings<dim>         &found)
    {
      Progress<moves> progress{points,
                               grid,
                               sums,
                               what,
                               strain,
                               what.relaxation > 0 || what.shift != nullptr};
      for_each_batch(
        points,
        [&](const CellBatch &cell_batch) __attribute__((always_inline)) {
          const Batch batch(treatment, cell_batch, grid, sums, what);
          for_each_pack<dim>(
            cell_batch, [&](const auto &lanes) __attribute__((always_inline)) {
              progress.update(batch, lanes);
            });
        });
      found = progress.found;
      StressSummary result;
      result.displacement = maximum(progress.displacement);
      return result;
    }

    static constexpr bool projected = kind != Treatment::none;
  };
} // namespace limber

#endif
