// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/linear.h>
#include <limber/points/cell_batch.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/points_to_grid.h>

#include <utility>

namespace limber
{
  namespace
  {
    /** The stress of a point times its volume; pressure left out on request. */
    template <int dim, bool deviator, bool with_pressure>
    __attribute__((always_inline)) inline std::array<double, dim *(dim + 1) / 2>
    force_density(const PointView<dim> &points,
                  const std::size_t     p,
                  const double          volume)
    {
      std::array<double, dim *(dim + 1) / 2> t{};
      if constexpr (deviator)
        {
          const double xx = volume * points.deviator[0][p];
          const double yy = volume * points.deviator[1][p];
          t[0]            = xx;
          t[1]            = yy;
          if constexpr (dim == 2)
            t[2] = volume * points.deviator[2][p];
          else
            {
              t[2] = -xx - yy;
              t[3] = volume * points.deviator[2][p];
              t[4] = volume * points.deviator[3][p];
              t[5] = volume * points.deviator[4][p];
            }
        }
      if constexpr (with_pressure)
        for (int d = 0; d < dim; ++d)
          t[d] -= volume * points.pressure[p];
      return t;
    }



    /**
     * Turn complete sums of a cell into averages; returns the mean weights of
     * its nodes over the points.
     */
    template <int dim>
    inline typename Linear<dim>::Nodes
    store_averages(const typename Linear<dim>::Nodes &shares,
                   const double                       volumetric,
                   double *const                      record)
    {
      const auto   moments      = Linear<dim>::to_moments(shares);
      const double mass         = moments[0];
      const double inverse_mass = 1. / mass;
      store(moments * inverse_mass, record);
      record[CellSums<dim>::mass]       = mass;
      record[CellSums<dim>::volumetric] = volumetric * inverse_mass;
      return shares * inverse_mass;
    }



    /** The force of sum V p on the nodes, given their mean weights. */
    template <int dim>
    inline typename Linear<dim>::Nodes
    mean_pressure_force(const CellGeometry<dim>           &cell,
                        const double                       pressure,
                        const typename Linear<dim>::Nodes &weights,
                        const int                          d)
    {
      return (pressure * cell.inverse_edge[d]) * Linear<dim>::sign(d) *
             (weights + Linear<dim>::across(weights, d));
    }



    template <int  dim,
              bool momentum,
              bool force,
              bool affine,
              bool deviator,
              bool projected>
    std::size_t
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const double          inverse_density,
          const bool            history,
          const CellSums<dim>  *sums)
    {
      using Kernel = Linear<dim>;
      using Nodes  = typename Kernel::Nodes;
      using Layout = NodeLayout<dim>;
      // f and p of the record, behind m
      constexpr unsigned int n_values = 1 + 2 * dim;

      return for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];

        std::array<Nodes, n_values> to_nodes{};
        std::array<Nodes, dim>      gradient_scale;
        for (int d = 0; d < dim; ++d)
          gradient_scale[d] = Kernel::sign(d) * cell.inverse_edge[d];
        double pressure = 0, volumetric = 0;

        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            const double           mass = points.mass[p];
            std::array<Nodes, dim> w;
            for (int d = 0; d < dim; ++d)
              w[d] = Kernel::weights(d,
                                     (points.position[d][p] - cell.origin[d]) *
                                       cell.inverse_edge[d]);

            if constexpr (momentum)
              {
                Nodes mass_weight = w[0] * w[1];
                if constexpr (dim == 3)
                  mass_weight *= w[2];
                mass_weight *= mass;
                to_nodes[Layout::mass] += mass_weight;
                for (int d = 0; d < dim; ++d)
                  {
                    Nodes velocity = broadcast<Nodes>(points.velocity[d][p]);
                    if constexpr (affine)
                      // x_i - x: one weight of the other end, signed
                      for (int e = 0; e < dim; ++e)
                        velocity += points.affine[d * dim + e][p] /
                                    cell.inverse_edge[e] *
                                    (Kernel::sign(e) * Kernel::across(w[e], e));
                    to_nodes[Layout::momentum + d] += mass_weight * velocity;
                  }
              }

            if constexpr (force && (deviator || !projected))
              {
                const auto t = force_density<dim, deviator, !projected>(
                  points, p, mass * inverse_density);
                if constexpr (dim == 2)
                  {
                    const Nodes g0 = gradient_scale[0] * w[1];
                    const Nodes g1 = gradient_scale[1] * w[0];
                    to_nodes[1] -= t[0] * g0 + t[2] * g1;
                    to_nodes[2] -= t[2] * g0 + t[1] * g1;
                  }
                else
                  {
                    const Nodes g0 = gradient_scale[0] * (w[1] * w[2]);
                    const Nodes g1 = gradient_scale[1] * (w[0] * w[2]);
                    const Nodes g2 = gradient_scale[2] * (w[0] * w[1]);
                    to_nodes[1] -= t[0] * g0 + t[3] * g1 + t[5] * g2;
                    to_nodes[2] -= t[3] * g0 + t[1] * g1 + t[4] * g2;
                    to_nodes[3] -= t[5] * g0 + t[4] * g1 + t[2] * g2;
                  }
              }
            if constexpr (projected && force)
              pressure += mass * points.pressure[p];
            if constexpr (projected && momentum)
              if (history)
                volumetric += mass * points.volumetric[p];
          }

        if constexpr (projected)
          {
            double *const cell_sums =
              sums->data + batch.cell * CellSums<dim>::stride;
            if constexpr (momentum)
              {
                store(load<Nodes>(cell_sums) + to_nodes[Layout::mass],
                      cell_sums);
                cell_sums[CellSums<dim>::volumetric] += volumetric;
              }
            if constexpr (force)
              cell_sums[CellSums<dim>::pressure] += pressure * inverse_density;
          }
        add_to_nodes<dim, Layout::mass>(cell, to_nodes, grid.nodes);
      });
    }



    // From run-time switches to template arguments, one switch at a time.
    template <int dim, bool... chosen>
    std::size_t
    choose(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const GiveToGrid     &what,
           const CellSums<dim>  *sums)
    {
      if constexpr (sizeof...(chosen) == 5)
        return sweep<dim, chosen...>(
          points, grid, what.inverse_density, what.history, sums);
      else
        {
          const bool switches[] = {what.momentum,
                                   what.force,
                                   what.affine,
                                   points.deviator[0] != nullptr,
                                   sums != nullptr};
          return switches[sizeof...(chosen)] ?
                   choose<dim, chosen..., true>(points, grid, what, sums) :
                   choose<dim, chosen..., false>(points, grid, what, sums);
        }
    }
  } // namespace



  template <int dim>
  std::size_t
  points_to_grid(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const GiveToGrid     &what,
                 const CellSums<dim>  *sums)
  {
    return choose<dim>(points, grid, what, sums);
  }



  namespace
  {
    template <int dim>
    inline void
    add_mean_pressure(const CellGeometry<dim>           &cell,
                      const double                       pressure,
                      const typename Linear<dim>::Nodes &weights,
                      double *const                      nodes)
    {
      std::array<typename Linear<dim>::Nodes, dim> force;
      for (int d = 0; d < dim; ++d)
        force[d] = mean_pressure_force<dim>(cell, pressure, weights, d);
      add_to_nodes<dim, NodeLayout<dim>::force>(cell, force, nodes);
    }
  } // namespace



  template <int dim>
  void
  average_cells(const std::uint32_t *const cells,
                const std::size_t          n_cells,
                const GridView<dim>       &grid,
                const CellSums<dim>       &sums,
                const bool                 add_force)
  {
    using Nodes = typename Linear<dim>::Nodes;

    for (std::size_t k = 0; k < n_cells; ++k)
      {
        double *const record = sums.data + cells[k] * CellSums<dim>::stride;
        const Nodes   shares = load<Nodes>(record);
        if (!(sum(shares) > 0))
          continue;
        const Nodes weights =
          store_averages<dim>(shares,
                              record[CellSums<dim>::volumetric],
                              record);
        if (add_force)
          add_mean_pressure<dim>(grid.cells[cells[k]],
                                 record[CellSums<dim>::pressure],
                                 weights,
                                 grid.nodes);
      }
  }



  template <int dim>
  void
  add_projected_pressure(const std::uint32_t *const cells,
                         const std::size_t          n_cells,
                         const GridView<dim>       &grid,
                         const CellSums<dim>       &sums)
  {
    using Kernel = Linear<dim>;
    using Nodes  = typename Kernel::Nodes;

    for (std::size_t k = 0; k < n_cells; ++k)
      {
        const double *const record =
          sums.data + cells[k] * CellSums<dim>::stride;
        if (!(record[CellSums<dim>::mass] > 0))
          continue;
        Nodes means = load<Nodes>(record);
        means[0]    = 1; // the mean of the monomial 1
        add_mean_pressure<dim>(grid.cells[cells[k]],
                               record[CellSums<dim>::pressure],
                               Kernel::from_moments(means),
                               grid.nodes);
      }
  }



  template std::size_t
  points_to_grid(const PointView<2> &,
                 const GridView<2> &,
                 const GiveToGrid &,
                 const CellSums<2> *);
  template std::size_t
  points_to_grid(const PointView<3> &,
                 const GridView<3> &,
                 const GiveToGrid &,
                 const CellSums<3> *);
  template void
  average_cells(const std::uint32_t *,
                std::size_t,
                const GridView<2> &,
                const CellSums<2> &,
                bool);
  template void
  average_cells(const std::uint32_t *,
                std::size_t,
                const GridView<3> &,
                const CellSums<3> &,
                bool);
  template void
  add_projected_pressure(const std::uint32_t *,
                         std::size_t,
                         const GridView<2> &,
                         const CellSums<2> &);
  template void
  add_projected_pressure(const std::uint32_t *,
                         std::size_t,
                         const GridView<3> &,
                         const CellSums<3> &);
} // namespace limber
