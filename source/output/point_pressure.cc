// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/point_pressure.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  PointView<dim>
  part_of(PointView<dim>    points,
          const std::size_t begin,
          const std::size_t size)
  {
    const auto shift = [begin](auto *&array) {
      if (array != nullptr)
        array += begin;
    };
    for (auto &array : points.position)
      shift(array);
    for (auto &array : points.velocity)
      shift(array);
    shift(points.mass);
    shift(points.pressure);
    for (auto &array : points.deviator)
      shift(array);
    for (auto &array : points.history)
      shift(array);
    for (auto &array : points.affine)
      shift(array);
    shift(points.volumetric);
    shift(points.cell);
    points.size = size;
    return points;
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  deviator(const PointView<dim> &points, const std::size_t p)
  {
    dealii::SymmetricTensor<2, 3> s;
    if (points.deviator[0] == nullptr)
      return s;
    s[0][0] = points.deviator[0][p];
    s[1][1] = points.deviator[1][p];
    s[2][2] = -(s[0][0] + s[1][1]);
    s[0][1] = points.deviator[2][p];
    if constexpr (dim == 3)
      {
        s[1][2] = points.deviator[3][p];
        s[0][2] = points.deviator[4][p];
      }
    return s;
  }



  template <int dim>
  PointPressure<dim>::PointPressure(const BackgroundGrid<dim> &grid)
    : plan(grid.shared_cells)
    , sums(grid)
  {}



  template <int dim>
  void
  PointPressure<dim>::compute(const MaterialBody<dim> &body)
  {
    points    = body.points.view();
    projected = body.cell_sums.has_value();
    volume_ratios.resize(points.size);
    body.stress->volume_ratio(points, volume_ratios.data());
    if (projected)
      sum_over_cells();
  }



  template <int dim>
  void
  PointPressure<dim>::sum_over_cells()
  {
    // Points may sit in ghost cells, and those of other ranks in cells here.
    sums.clear(touched);
    touched            = plan.received;
    double *const data = sums.view().next;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const std::uint32_t cell = points.cell[p];
        if (cell == invalid_cell)
          continue;
        if (touched.empty() || touched.back() != cell)
          touched.push_back(cell);
        double *const record = data + std::size_t(cell) * CellSums<dim>::stride;
        record[0] += points.mass[p];
        record[1] += points.mass[p] * volume_ratios[p];
        record[2] += points.mass[p] * points.pressure[p];
      }
    sums.start_completion(plan);
    sums.finish_completion();
  }



  template <int dim>
  CellPressure
  PointPressure<dim>::in_cell(const std::uint32_t cell) const
  {
    if (cell == invalid_cell)
      return {};
    const double *const record = sums.record(cell);
    return {record[0], record[1], record[2]};
  }



  template PointView<2>
  part_of(PointView<2>, const std::size_t, const std::size_t);
  template PointView<3>
  part_of(PointView<3>, const std::size_t, const std::size_t);
  template dealii::SymmetricTensor<2, 3>
  deviator(const PointView<2> &, const std::size_t);
  template dealii::SymmetricTensor<2, 3>
  deviator(const PointView<3> &, const std::size_t);
  template class PointPressure<2>;
  template class PointPressure<3>;
} // namespace limber
