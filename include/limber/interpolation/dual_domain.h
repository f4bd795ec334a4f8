// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_dual_domain_h
#define limber_interpolation_dual_domain_h

#include <limber/interpolation/batch_lanes.h>

#include <algorithm>

/**
 * @file The gradients of the dual domain material point method (Zhang, Ma and
 * Giguere, JCP 230 (2011) 6379): shape functions are linear, but the gradient
 * at a point is
 *
 *   alpha(x) grad N_i(x) + (1 - alpha(x)) sum_j N_j(x) G_ij,
 *   G_ij = (1/V_j) int N_j grad N_i dV,   V_j = int N_j dV,
 *
 * so that gradients are continuous, as alpha vanishes on the faces of cells.
 * G is never formed: the mean gradient around each node is assembled cell by
 * cell (add_mean_gradients()), and the stress that points map to nodes becomes
 * forces by its transpose (add_forces_of_stress()).
 *
 * Cells enter the integrals with a weight (weight_of_cell()): where there is
 * no material, there is no velocity to take a gradient of.
 */
namespace limber
{
  /** The dual domain record of node i of a cell. */
  template <int dim>
  inline double *
  dual_domain_record(double *const            records,
                     const CellGeometry<dim> &cell,
                     const int                i)
  {
    return records + std::size_t(cell.node[i] / NodeLayout<dim>::stride) *
                       DualDomainLayout<dim>::stride;
  }



  /**
   * alpha at natural coordinates: the product over directions of 4 xi (1 - xi),
   * one at the centre. It vanishes with the distance from a face as fast as the
   * mass of the nodes behind it, so that its force on a node with tiny mass is
   * small as well.
   */
  template <int dim, class Number>
  __attribute__((always_inline)) inline Number
  own_share(const std::array<Number, dim> &xi)
  {
    Number result = 4. * (xi[0] * (1. - xi[0]));
    for (int d = 1; d < dim; ++d)
      result *= 4. * (xi[d] * (1. - xi[d]));
    return result;
  }



  /** Integrals over a cell of products of N_j and gradients of N_i. */
  template <int dim>
  class DualDomainCell
  {
    using Basis  = Linear<dim>;
    using Nodes  = typename Basis::Nodes;
    using Layout = DualDomainLayout<dim>;

  public:
    /** A cell with its weight, between 0 and 1. */
    DualDomainCell(const CellGeometry<dim> &cell, const double weight)
      : cell(cell)
      , volume(weight)
    {
      for (int d = 0; d < dim; ++d)
        volume /= cell.inverse_edge[d];
    }

    /** Add the volume to those of the nodes. */
    void
    add_volumes(double *const records) const
    {
      for (int i = 0; i < Basis::n_nodes; ++i)
        dual_domain_record(records, cell, i)[Layout::volume] +=
          volume / Basis::n_nodes;
    }

    /**
     * Add int N_j grad v to the tensors of the nodes; v is the field in slots
     * from @p first on of the records @p nodes (NodeLayout), m/s.
     */
    void
    add_mean_gradients(const double *const nodes,
                       const unsigned int  first,
                       double *const       records) const
    {
      for (int d = 0; d < dim; ++d)
        {
          Nodes v;
          for (int i = 0; i < Basis::n_nodes; ++i)
            v[i] = nodes[cell.node[i] + first + d];
          for (int e = 0; e < dim; ++e)
            {
              const Nodes slope = Basis::sign(e) * (v - Basis::across(v, e));
              const Nodes sum   = factor(e) * averaged(slope, e);
              for (int i = 0; i < Basis::n_nodes; ++i)
                dual_domain_record(records, cell, i)[Layout::tensor(d, e)] +=
                  sum[i];
            }
        }
    }

    /**
     * The transpose: subtract from the nodal forces those of the nodal tensors,
     * volume times stress over the nodal volume.
     */
    void
    add_forces_of_stress(double *const records) const
    {
      for (int d = 0; d < dim; ++d)
        {
          Nodes force{};
          for (int e = 0; e < dim; ++e)
            {
              Nodes t;
              for (int i = 0; i < Basis::n_nodes; ++i)
                t[i] =
                  dual_domain_record(records, cell, i)[Layout::tensor(d, e)];
              force -= factor(e) * Basis::sign(e) *
                       averaged<Nodes>(t + Basis::across(t, e), e);
            }
          for (int i = 0; i < Basis::n_nodes; ++i)
            dual_domain_record(records, cell, i)[Layout::force + d] += force[i];
        }
    }

  private:
    // int N_j over the cell along direction e, times the slope of N_i
    double
    factor(const int e) const
    {
      return 0.5 * volume * cell.inverse_edge[e];
    }

    // int N_j N_i along the other directions, over the edges
    template <class Number>
    static Number
    averaged(Number a, const int e)
    {
      for (int f = 0; f < dim; ++f)
        if (f != e)
          a = (1. / 3.) * a + (1. / 6.) * Basis::across(a, f);
      return a;
    }

    const CellGeometry<dim> &cell;
    double                   volume; // weighted, m^3
  };



  /**
   * Weight of a cell that contains points: one as long as no node of it has
   * less than 2^-dim of the mass of another, as at the corner of a body that
   * fills its cells; less for emptier cells, zero if a node has no mass. So
   * gradients are continuous when a point enters an empty cell, and the force
   * on a node with tiny mass is small as well.
   */
  template <int dim>
  inline double
  weight_of_cell(const double *const nodes, const CellGeometry<dim> &cell)
  {
    double least = nodes[cell.node[0] + NodeLayout<dim>::mass], most = least;
    for (int i = 1; i < Linear<dim>::n_nodes; ++i)
      {
        const double mass = nodes[cell.node[i] + NodeLayout<dim>::mass];
        least             = std::min(least, mass);
        most              = std::max(most, mass);
      }
    return most > 0 ? std::min(1., Linear<dim>::n_nodes * least / most) : 0;
  }



  /** The dual domain velocity gradient at points of a cell, 1/s. */
  template <int dim, unsigned int first, unsigned int strained>
  class DualDomainGradient
  {
    using Basis  = Linear<dim>;
    using Layout = DualDomainLayout<dim>;

  public:
    /**
     * Velocities are in the nodal slots from @p first on, two fields, of which
     * that from component @p strained on is differentiated.
     */
    __attribute__((always_inline))
    DualDomainGradient(const GridView<dim> &grid, const std::uint32_t cell)
      : cell(grid.cells[cell])
      , velocity(grid, cell)
    {
      for (int i = 0; i < Basis::n_nodes; ++i)
        {
          const double *const record =
            dual_domain_record(grid.dual_domain, this->cell, i);
          for (unsigned int row = 0; row < n_rows; ++row)
            coefficients[row][i] = load<Row>(record + row * 4);
        }
      for (unsigned int row = 0; row < n_rows; ++row)
        Basis::to_monomials(coefficients[row]);
    }

    /** At natural coordinates xi. */
    template <class Number>
    __attribute__((always_inline)) SmallMatrix<dim, Number>
    at(const std::array<Number, dim> &xi) const
    {
      const Number             own = own_share<dim>(xi);
      SmallMatrix<dim, Number> result;
      for (int d = 0; d < dim; ++d)
        {
          const auto slope =
            Basis::template gradient<Number>(velocity.component(strained + d),
                                             xi);
          for (int e = 0; e < dim; ++e)
            {
              const unsigned int slot     = Layout::tensor(d, e);
              const Number       of_nodes = Basis::template value<Number>(
                [this, slot](const int k) {
                  return coefficients[slot / 4][k][slot % 4];
                },
                xi);
              result[d][e] =
                of_nodes + own * (cell.inverse_edge[e] * slope[e] - of_nodes);
            }
        }
      return result;
    }

    /** The velocity components themselves. */
    auto
    component(const unsigned int c) const
    {
      return velocity.component(c);
    }

  private:
    using Row                            = Pack<4>;
    static constexpr unsigned int n_rows = dim == 2 ? 1 : 3;

    const CellGeometry<dim>                            &cell;
    const NodalCoefficients<Basis, first, 2 * dim>      velocity;
    std::array<std::array<Row, Basis::n_nodes>, n_rows> coefficients;
  };
} // namespace limber

#endif
