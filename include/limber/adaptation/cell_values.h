// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_cell_values_h
#define limber_adaptation_cell_values_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/**
 * @file Refinement indicators: the values per cell that are compared with
 * 'Scale'.
 */
namespace limber
{
  /** The largest wave speed in a body at present, over all ranks, m/s. */
  template <int dim>
  double
  largest_wave_speed(const BackgroundGrid<dim> &grid,
                     const MaterialBody<dim>   &body);

  /**
   * Linear fit of the velocity in a cell: mass-weighted least squares, in
   * natural coordinates relative to the centre of mass.
   */
  template <int dim>
  struct LinearMotion
  {
    double                 mass = 0; // kg
    dealii::Point<dim>     centre;   // natural coordinates
    dealii::Tensor<1, dim> velocity; // of the centre, m/s
    dealii::Tensor<2, dim> gradient; // in natural coordinates, m/s
    // Whether points spread over a tenth of the cell in every direction;
    // otherwise there is no gradient.
    bool has_gradient = false;
  };

  /** Moments of the points of a cell, from which the linear fit follows. */
  template <int dim>
  struct MotionSums
  {
    static constexpr unsigned int n = 1 + 2 * dim + 2 * dim * dim;
    // Mass, and sums of mass times x, v, x x, v x
    std::array<double, n> sums{};

    void
    add(const PointView<dim> &points, std::size_t p, const CellGeometry<dim> &);

    /**
     * Add those of another cell, whose centre is at @p shift from that of this
     * one and whose edges are @p scale times as long, both in edges of this
     * one.
     */
    void
    add(const MotionSums<dim>         &other,
        const dealii::Tensor<1, dim>  &shift,
        const std::array<double, dim> &scale);

    LinearMotion<dim>
    motion() const;
  };

  /**
   * The moments of the points of a body in owned and ghost cells, by local
   * number. Collective.
   */
  template <int dim>
  std::vector<MotionSums<dim>>
  motion_of_cells(const BackgroundGrid<dim> &grid,
                  const MaterialBody<dim>   &body);

  /**
   * The indicator of a refinement with a scale in the cells of this rank, by
   * local number; zero if a cell has no, or too few, points.
   * - stress: the largest norm of the jump of mean J sigma between the cell and
   *   a face neighbour with points, Pa;
   * - rate: h |dev D| / c, with the longest edge h of the cell, D from the
   *   linear fit of the velocity and the largest wave speed c of the body;
   * - plastic strain: the mean equivalent plastic strain.
   *
   * Means are mass-weighted and per body; the largest over the bodies counts.
   * Points may be in ghost cells. Collective.
   */
  template <int dim>
  std::vector<double>
  cell_values(const Refinement<dim>                                 &refinement,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);
} // namespace limber

#endif
