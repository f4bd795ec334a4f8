// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_light_nodes_h
#define limber_transfer_light_nodes_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>
#include <limber/interpolation/linear.h>

#include <algorithm>
#include <array>

namespace limber
{
  /**
   * Small-cut stabilisation of APIC with linear functions: what the affine
   * velocities of points leave out of the increments of light nodes.
   *
   * Nodes beyond a free surface that a point has just reached have next to no
   * mass m_i, but feel a force like all others: their increment dv_i is
   * unbounded. Weighted by N_i, the velocity of the point remains bounded; its
   * gradient does not, and APIC maps it back to the nodes in the next step. So
   * the affine velocity takes from a node that is lighter than m_c only
   *
   *   dv(x) + theta_i (dv_i - dv(x)),   theta_i = min(1, m_i / m_c),
   *
   * which is stable if m_c is no less than C^2/4 of the mass of the points in
   * the cell per direction in which nodes are light, with the Courant number C.
   * Linear momentum is not affected. doc/theory/transfers.md.
   */
  template <int dim>
  class LightNodes
  {
  public:
    /** No light nodes. */
    LightNodes() = default;

    /**
     * The light nodes of a cell, with @p least_mass = m_c (kg). Hanging nodes
     * have been given the mass of their lightest master.
     */
    LightNodes(const CellGeometry<dim> &cell,
               const double *const      nodes,
               const double             least_mass)
    {
      std::array<double, n_nodes> left_out;
      for (unsigned int i = 0; i < n_nodes; ++i)
        {
          const double mass = nodes[cell.node[i] + NodeLayout<dim>::mass];
          left_out[i]       = std::max(0., 1 - mass / least_mass);
          are_there |= left_out[i] > 0;
        }
      if (!are_there)
        return;
      for (int d = 0; d < dim; ++d)
        {
          for (unsigned int i = 0; i < n_nodes; ++i)
            increment[d][i] =
              left_out[i] *
              nodes[cell.node[i] + NodeLayout<dim>::increment + d];
          Linear<dim>::to_monomials(increment[d]);
        }
      Linear<dim>::to_monomials(left_out);
      share = left_out;
    }

    bool
    any() const
    {
      return are_there;
    }

    /**
     * Gradient, in natural coordinates, of (1 - theta_i) (dv_i - dv(x)) in
     * direction @p d, with dv(x) = @p at_point.
     */
    template <class Number>
    std::array<Number, dim>
    gradient(const int                      d,
             const Number                  &at_point,
             const std::array<Number, dim> &xi) const
    {
      const auto of = [&](const std::array<double, n_nodes> &c) {
        return Linear<dim>::template gradient<Number>(
          [&](const int k) { return broadcast<Number>(c[k]); }, xi);
      };
      auto       result = of(increment[d]);
      const auto shares = of(share);
      for (int e = 0; e < dim; ++e)
        result[e] -= at_point * shares[e];
      return result;
    }

  private:
    static constexpr unsigned int n_nodes = 1 << dim;

    bool are_there = false;
    // Coefficients of monomials: of (1 - theta_i) dv_i and of 1 - theta_i
    std::array<std::array<double, n_nodes>, dim> increment;
    std::array<double, n_nodes>                  share;
  };
} // namespace limber

#endif
