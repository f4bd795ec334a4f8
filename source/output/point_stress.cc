// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/nodal_means.h>
#include <limber/materials/linear_elastic.h>
#include <limber/output/point_stress.h>
#include <limber/transfer/project_on_nodes.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** The tensor of its independent components, in the order of n_deviator. */
    template <int dim, class Component>
    dealii::SymmetricTensor<2, 3>
    full_deviator(const Component &component)
    {
      dealii::SymmetricTensor<2, 3> s;
      s[0][0] = component(0);
      s[1][1] = component(1);
      s[2][2] = -(s[0][0] + s[1][1]);
      s[0][1] = component(2);
      if constexpr (dim == 3)
        {
          s[1][2] = component(3);
          s[0][2] = component(4);
        }
      return s;
    }
  } // namespace



  template <int dim>
  PointStress<dim>::PointStress(const State<dim> &state)
    : nodes(state.nodes.vertices())
    , plan(state.grid.shared_cells)
    , sums(state.grid)
    , deviators(state.grid)
    , nodal(state.grid.vertices)
  {}



  template <int dim>
  void
  PointStress<dim>::compute(const MaterialBody<dim> &body)
  {
    points          = body.points.view();
    kind            = body.stress->treatment().kind;
    is_small_strain = body.description.frame == Frame::initial &&
                      body.description.law == LinearElastic::name;
    volume_ratios.resize(points.size);
    body.stress->volume_ratio(points, volume_ratios.data());
    if (kind != Treatment::none)
      sum_over_cells();
    if (is_nodal())
      sum_around_nodes();
  }



  template <int dim>
  void
  PointStress<dim>::sum_over_cells()
  {
    const bool averages_deviator =
      averages_shear_in_cells(kind) && points.deviator[0] != nullptr;
    // Points may sit in ghost cells, and those of other ranks in cells here.
    const CellSums<dim> of_cells     = sums.view();
    const CellSums<dim> of_deviators = deviators.view();
    static_assert(n_deviator<dim> <= 1 << dim);
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const std::uint32_t cell = points.cell[p];
        if (cell == invalid_cell)
          continue;
        double *const record = of_cells.open(cell);
        record[0] += points.mass[p];
        record[1] += points.mass[p] * volume_ratios[p];
        record[2] += points.mass[p] * volume_ratios[p] * point_pressure(p);
        if (averages_deviator)
          {
            double *const deviator = of_deviators.open(cell);
            for (unsigned int k = 0; k < n_deviator<dim>; ++k)
              deviator[k] += points.mass[p] * volume_ratios[p] *
                             points.deviator[k][p] / kirchhoff_over_cauchy(p);
          }
      }
    sums.start_completion(plan);
    if (averages_deviator)
      deviators.start_completion(plan);
    sums.finish_completion();
    if (averages_deviator)
      deviators.finish_completion();
  }



  template <int dim>
  void
  PointStress<dim>::sum_around_nodes()
  {
    std::vector<double> pressures(points.size);
    for (std::size_t p = 0; p < points.size; ++p)
      pressures[p] = point_pressure(p);
    nodal.clear(nodes.active_nodes());
    sum_weighted<dim>(points,
                      nodes.grid.view(),
                      volume_ratios.data(),
                      pressures.data(),
                      nodal.data());
    nodal.start_completion(nodes.node_plan());
    nodal.finish_completion(nodes.active_nodes());
  }



  template <int dim>
  double
  PointStress<dim>::pressure(const std::size_t p) const
  {
    const std::uint32_t cell = points.cell[p];
    if (kind == Treatment::none || cell == invalid_cell)
      return point_pressure(p);
    if (!is_nodal())
      return in_cell(cell).mean_pressure();

    const CellGeometry<dim> &geometry = nodes.grid.geometry[cell];
    return NodalMean<dim, Treatment::node>(nodal.data(), geometry)
      .template value<double>(natural_place(points, geometry, p));
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  PointStress<dim>::point_deviator(const std::size_t p) const
  {
    if (points.deviator[0] == nullptr)
      return {};
    return full_deviator<dim>(
             [&](const unsigned int k) { return points.deviator[k][p]; }) /
           kirchhoff_over_cauchy(p);
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  PointStress<dim>::deviator(const std::size_t p) const
  {
    Tensor              result = point_deviator(p);
    const std::uint32_t cell   = points.cell[p];
    if (!averages_shear_in_cells(kind) || points.deviator[0] == nullptr ||
        cell == invalid_cell)
      return result;
    const double *const record = deviators.record(cell);
    const Tensor        mean =
      full_deviator<dim>([&](const unsigned int k) { return record[k]; }) /
      in_cell(cell).volume;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        if (i != j || kind == Treatment::cell_full)
          result[i][j] = mean[i][j];
    return result;
  }



  template <int dim>
  CellPressure
  PointStress<dim>::in_cell(const std::uint32_t cell) const
  {
    if (cell == invalid_cell)
      return {};
    const double *const record = sums.record(cell);
    return {record[0], record[1], record[2]};
  }



  template class PointStress<2>;
  template class PointStress<3>;
} // namespace limber
