// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/domain_means.h>
#include <limber/interpolation/dual_domain.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/dual_domain_transfer.h>


namespace limber
{
  namespace
  {
    /** Values of the monomials at natural coordinates xi. */
    template <int dim, class Number>
    __attribute__((always_inline)) inline std::array<Number, (1 << dim)>
    monomials(const std::array<Number, dim> &xi)
    {
      std::array<Number, (1 << dim)> result;
      result[0] = broadcast<Number>(1.);
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < 1 << d; ++k)
          result[k | 1 << d] = result[k] * xi[d];
      return result;
    }



    /** Sums of a batch before P2G. */
    template <int dim, bool averaged, bool deviator>
    class DualDomainStress
    {
      using Basis                  = Linear<dim>;
      using Nodes                  = typename Basis::Nodes;
      using Number                 = PointPack<dim>;
      static constexpr int n_nodes = Basis::n_nodes;
      // Without deviator all diagonal components are equal.
      static constexpr int n_components = deviator ? dim * (dim + 1) / 2 : 1;

    public:
      DualDomainStress(const CellGeometry<dim> &cell)
        : cell(cell)
      {
        for (auto &of_component : on_coefficients)
          set_zero(of_component);
        for (auto &of_component : tensor)
          set_zero(of_component);
      }

      template <class Lanes>
      __attribute__((always_inline)) void
      add(const PointView<dim>  &points,
          const DomainMean<dim> &projected_pressure,
          const double           inverse_density,
          const Lanes           &lanes)
      {
        const auto   xi = lanes.natural(points, cell);
        const Number volume =
          inverse_density * lanes.only_active(lanes.load(points.mass));
        const Number p =
          averaged ? projected_pressure.value(xi) : lanes.load(points.pressure);
        SmallMatrix<dim, Number> t{};
        if constexpr (deviator)
          t = stress_deviator<dim>(points, lanes);
        for (int d = 0; d < dim; ++d)
          t[d][d] -= p;

        const auto   at       = monomials<dim>(xi);
        const Number own      = own_share<dim>(xi);
        const Number of_point = volume * own, of_nodes = volume - of_point;
        for (int c = 0; c < n_components; ++c)
          {
            const auto [d, e]     = indices(c);
            const Number to_nodes = of_nodes * t[d][e];
            for (int k = 0; k < n_nodes; ++k)
              tensor[c][k] += to_nodes * at[k];
          }
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            if (deviator || d == e)
              {
                const Number slope = cell.inverse_edge[e] * of_point * t[d][e];
                for (int k = 0; k < n_nodes; ++k)
                  if (k >> e & 1)
                    on_coefficients[d][k] += slope * at[k ^ (1 << e)];
              }
      }

      /** P2G: forces, and tensors to the @p records. */
      __attribute__((always_inline)) void
      give(double *const nodes, double *const records) const
      {
        using Layout = DualDomainLayout<dim>;
        std::array<Nodes, dim> forces;
        for (int d = 0; d < dim; ++d)
          forces[d] = -Basis::to_nodes(sums_over_lanes(on_coefficients[d]));
        add_to_nodes<dim, NodeLayout<dim>::force>(cell, forces, nodes);
        for (int c = 0; c < n_components; ++c)
          {
            const Nodes of_nodes = Basis::to_nodes(sums_over_lanes(tensor[c]));
            const auto [d, e]    = indices(c);
            for (int i = 0; i < n_nodes; ++i)
              {
                double *const record = dual_domain_record(records, cell, i);
                if constexpr (deviator)
                  {
                    record[Layout::tensor(d, e)] += of_nodes[i];
                    if (d != e)
                      record[Layout::tensor(e, d)] += of_nodes[i];
                  }
                else
                  for (int f = 0; f < dim; ++f)
                    record[Layout::tensor(f, f)] += of_nodes[i];
              }
          }
      }

    private:
      // Indices of component c of a symmetric tensor: the diagonal first
      static constexpr std::pair<int, int>
      indices(const int c)
      {
        return c < dim      ? std::pair<int, int>(c, c) :
               c == dim     ? std::pair<int, int>(0, 1) :
               c == dim + 1 ? std::pair<int, int>(1, 2) :
                              std::pair<int, int>(0, 2);
      }

      const CellGeometry<dim>                              &cell;
      std::array<std::array<Number, n_nodes>, dim>          on_coefficients;
      std::array<std::array<Number, n_nodes>, n_components> tensor;
    };



    template <int dim, bool averaged, bool deviator>
    std::size_t
    give_stress(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const P2GOptions     &what)
    {
      return for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim>                  &cell = grid.cells[batch.cell];
        const DomainMean<dim>                     pressure(what.treatment.kind,
                                       what.projected_pressure,
                                       cell,
                                       batch.cell);
        DualDomainStress<dim, averaged, deviator> stress(cell);
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            stress.add(points, pressure, what.inverse_density, lanes);
          });
        stress.give(grid.nodes, grid.dual_domain);
      });
    }



    template <class Sums, int dim, unsigned int strained>
    void
    sum_up(const PointView<dim> &points,
           const GridView<dim>  &grid,
           double *const         records)
    {
      using Number = PointPack<dim>;
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        const DualDomainGradient<dim, NodeLayout<dim>::velocity, strained>
             gradient(grid, batch.cell);
        Sums sums;
        for_each_pack<dim>(batch, [&](const auto &lanes) {
          const auto of_points  = gradient.at(lanes.natural(points, cell));
          Number     divergence = of_points[0][0];
          for (int d = 1; d < dim; ++d)
            divergence += of_points[d][d];
          for (int k = 0; k < lanes.n; ++k)
            sums.add(natural_place(points, cell, lanes.first + k),
                     points.mass[lanes.first + k],
                     divergence[k]);
        });
        sums.add_to(cell, batch.cell, records);
      });
    }
  } // namespace



  template <int dim>
  std::size_t
  stress_to_dual_domain(const PointView<dim> &points,
                        const GridView<dim>  &grid,
                        const P2GOptions     &what)
  {
    check_treatment_of_domains(what.treatment.kind);
    const auto with = [&](const auto averaged) {
      return points.deviator[0] != nullptr ?
               give_stress<dim, averaged(), true>(points, grid, what) :
               give_stress<dim, averaged(), false>(points, grid, what);
    };
    return what.treatment.kind == Treatment::none ? with(std::false_type()) :
                                                    with(std::true_type());
  }



  template <class Sums, int dim>
  void
  sum_divergence_of_dual_domain(const PointView<dim> &points,
                                const GridView<dim>  &grid,
                                const bool            remapped,
                                double *const         records)
  {
    if (remapped)
      sum_up<Sums, dim, dim>(points, grid, records);
    else
      sum_up<Sums, dim, 0>(points, grid, records);
  }



  template std::size_t
  stress_to_dual_domain(const PointView<2> &,
                        const GridView<2> &,
                        const P2GOptions &);
  template std::size_t
  stress_to_dual_domain(const PointView<3> &,
                        const GridView<3> &,
                        const P2GOptions &);
  template void
  sum_divergence_of_dual_domain<CellMeanSums<2>>(const PointView<2> &,
                                                 const GridView<2> &,
                                                 bool,
                                                 double *);
  template void
  sum_divergence_of_dual_domain<CellMeanSums<3>>(const PointView<3> &,
                                                 const GridView<3> &,
                                                 bool,
                                                 double *);
  template void
  sum_divergence_of_dual_domain<NodalMeanSums<2>>(const PointView<2> &,
                                                  const GridView<2> &,
                                                  bool,
                                                  double *);
  template void
  sum_divergence_of_dual_domain<NodalMeanSums<3>>(const PointView<3> &,
                                                  const GridView<3> &,
                                                  bool,
                                                  double *);
} // namespace limber
