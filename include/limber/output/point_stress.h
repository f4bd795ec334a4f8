// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_point_stress_h
#define limber_output_point_stress_h

#include <deal.II/base/symmetric_tensor.h>

#include <limber/state/material_body.h>

#include <vector>

/**
 * @file Converts the Kirchhoff stress that points store to the Cauchy stress
 * that users see: pressure positive in compression, stress positive in tension.
 */
namespace limber
{
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
   * The Cauchy stress at the points of a body as the locking treatment computes
   * it, weighted by volume: the mean of the cell where that averages over cells
   * (sum of V sigma over sum of V of all points now in the cell); the
   * interpolated nodal pressure where it averages around nodes; otherwise the
   * value of the point. Has to be constructed anew after a change of the mesh.
   */
  template <int dim>
  class PointStress
  {
  public:
    using Tensor = dealii::SymmetricTensor<2, 3>;

    explicit PointStress(const State<dim> &state);

    /** Evaluates this body in its present state; collective. */
    void
    compute(const MaterialBody<dim> &body);

    double
    pressure(std::size_t p) const;

    /** The deviator, zz included. */
    Tensor
    deviator(std::size_t p) const;

    /** Of the point itself, without averaging. */
    double
    point_pressure(const std::size_t p) const
    {
      return points.pressure[p] / kirchhoff_over_cauchy(p);
    }

    Tensor
    point_deviator(std::size_t p) const;

    double
    volume_ratio(const std::size_t p) const
    {
      return volume_ratios[p];
    }

    /** Whether the pressure is an average around nodes. */
    bool
    is_nodal() const
    {
      return averages_around_nodes(kind);
    }

    /** All sums of an owned or ghost cell, if the body is projected. */
    CellPressure
    in_cell(std::uint32_t cell) const;

    /** Of a node, if the pressure is averaged there. */
    double
    at_node(const std::uint32_t node) const
    {
      return nodal.mean(node);
    }

  private:
    /** J; one for small strain in the initial frame, whose forces are those of
     * P = sigma. */
    double
    kirchhoff_over_cauchy(const std::size_t p) const
    {
      return is_small_strain ? 1 : volume_ratios[p];
    }

    void
    sum_over_cells();
    void
    sum_around_nodes();

    const NodalFields<dim> &nodes;     // vertices
    const ExchangePlan      plan;      // all cells that ranks share
    CellFields<dim>         sums;      // mass, m J, m J p
    CellFields<dim>         deviators; // of m J sigma, where averaged
    NodalProjection<dim>    nodal;     // pressure
    PointView<dim>          points;
    std::vector<double>     volume_ratios;
    Treatment               kind            = Treatment::none;
    bool                    is_small_strain = false; // in the initial frame
  };
} // namespace limber

#endif
