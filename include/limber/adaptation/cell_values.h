// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_cell_values_h
#define limber_adaptation_cell_values_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/** @file The numbers per cell that refinements compare with their scales. */
namespace limber
{
  /** The largest wave speed in a body as it is, over all ranks, m/s. */
  template <int dim>
  double
  largest_wave_speed(const BackgroundGrid<dim> &grid,
                     const MaterialBody<dim>   &body);

  /**
   * Velocity as a linear function of the place in a cell, by least squares
   * weighted with mass, in natural coordinates from the centre of mass.
   */
  template <int dim>
  struct LinearMotion
  {
    double                 mass = 0; // kg
    dealii::Point<dim>     centre;   // natural coordinates
    dealii::Tensor<1, dim> velocity; // of the centre, m/s
    dealii::Tensor<2, dim> gradient; // by natural coordinates, m/s
    // Whether points spread over a tenth of the cell in every direction; there
    // is no gradient otherwise.
    bool has_gradient = false;
  };

  /** Sums over the points of a cell that its linear motion follows from. */
  template <int dim>
  struct MotionSums
  {
    static constexpr unsigned int n = 1 + 2 * dim + 2 * dim * dim;
    // Mass; mass times place, velocity, place by place, velocity by place
    std::array<double, n> sums{};

    void
    add(const PointView<dim> &points, std::size_t p, const CellGeometry<dim> &);

    /**
     * Those of the points of another cell, whose centre is at @p shift from
     * that of this one and whose edges are @p scale times as long, both in
     * edges of this one.
     */
    void
    add(const MotionSums<dim>         &other,
        const dealii::Tensor<1, dim>  &shift,
        const std::array<double, dim> &scale);

    LinearMotion<dim>
    motion() const;
  };

  /** Of the points of a body in the cells of this rank, owned and ghost, by
   * local number. Collective. */
  template <int dim>
  std::vector<MotionSums<dim>>
  motion_of_cells(const BackgroundGrid<dim> &grid,
                  const MaterialBody<dim>   &body);

  /**
   * What a refinement with a scale compares with it, of the cells of this rank,
   * by local number; zero where the cell has no points, or too few.
   *  - stress: the largest norm of the difference of mean J sigma between the
   *    cell and a neighbour across a face that has points, Pa;
   *  - rate: h |dev D| / c, with the longest edge h of the cell, D of the
   * linear motion of its points and the largest wave speed c of the body;
   *  - plastic strain: the mean of the equivalent plastic strain.
   * Means are weighted with mass, each body has its own, and the largest
   * counts. Points may be in ghost cells. Collective.
   */
  template <int dim>
  std::vector<double>
  cell_values(const Refinement<dim>                                 &refinement,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);
} // namespace limber

#endif
