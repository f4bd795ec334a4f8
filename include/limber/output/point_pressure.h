// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_point_pressure_h
#define limber_output_point_pressure_h

#include <deal.II/base/symmetric_tensor.h>

#include <limber/state/material_body.h>

#include <vector>

/**
 * @file From the Kirchhoff stress that points store to the Cauchy stress that
 * users see: pressure positive in compression, stress positive in tension.
 */
namespace limber
{
  /** Points [begin, begin + size) of a view. */
  template <int dim>
  PointView<dim>
  part_of(PointView<dim>    points,
          const std::size_t begin,
          const std::size_t size);



  /** The Kirchhoff deviator of point p as a matrix; zz, where it is one. */
  template <int dim>
  dealii::SymmetricTensor<2, 3>
  deviator(const PointView<dim> &points, const std::size_t p);



  /** Sums over the points of one body in a cell. */
  struct CellPressure
  {
    double mass     = 0; // kg
    double volume   = 0; // times the reference density: sum of m J, kg
    double pressure = 0; // likewise, sum of m J p, kg Pa

    /** Cauchy, Pa; an empty cell bears none. */
    double
    mean_pressure() const
    {
      return volume != 0 ? pressure / volume : 0;
    }

    double
    mean_volume_ratio() const
    {
      return mass != 0 ? volume / mass : 1;
    }
  };



  /**
   * The Cauchy pressure at the points of a body as the treatment of locking
   * sees it: where pressure is averaged over cells, that average (sum of V p
   * over sum of V of all points now in the cell), else the value of the point.
   * To be made anew after a change of the mesh.
   */
  template <int dim>
  class PointPressure
  {
  public:
    explicit PointPressure(const BackgroundGrid<dim> &grid);

    /** Turn to this body in its present state; collective. */
    void
    compute(const MaterialBody<dim> &body);

    double
    pressure(const std::size_t p) const
    {
      return projected ? in_cell(points.cell[p]).mean_pressure() :
                         point_pressure(p);
    }

    /** Before the average. */
    double
    point_pressure(const std::size_t p) const
    {
      return points.pressure[p] / volume_ratios[p];
    }

    double
    volume_ratio(const std::size_t p) const
    {
      return volume_ratios[p];
    }

    /** All sums of an owned or ghost cell, if the body is projected. */
    CellPressure
    in_cell(const std::uint32_t cell) const;

  private:
    void
    sum_over_cells();

    const ExchangePlan         plan;    // all cells that ranks share
    CellFields<dim>            sums;    // mass, m J, m J p
    std::vector<std::uint32_t> touched; // cells whose sums are not zero
    PointView<dim>             points;
    std::vector<double>        volume_ratios;
    bool                       projected = false;
  };
} // namespace limber

#endif
