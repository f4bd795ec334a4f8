// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_linear_h
#define limber_interpolation_linear_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

#include <array>
#include <utility>

namespace limber
{
  /**
   * Bilinear and trilinear functions (Q1) on a rectangular cell. Node i lies at
   * the upper end in direction d if bit d of i is set, which is deal.II's order
   * of vertices.
   *
   * P2G has nodes as lanes of a pack: the weights of all nodes of the cell at
   * one point. G2P has points as lanes: once per batch the nodal values are
   * converted to coefficients of the monomials 1, xi, eta, xi eta, ..., which
   * are evaluated at many points.
   */
  template <int dimension>
  struct Linear
  {
    static constexpr int dim     = dimension;
    static constexpr int n_nodes = 1 << dim;
    using Nodes                  = Pack<n_nodes>;

    /** Index distance of neighbours (nodes or monomials) in direction d. */
    static constexpr int
    stride(const int d)
    {
      return 1 << d;
    }

    /** The end (0, 1) of node i, or the power of monomial i, along d. */
    static constexpr int
    power(const int i, const int d)
    {
      return i >> d & 1;
    }

    template <class Grid>
    static const CellGeometry<dim> &
    nodes_of(const Grid &grid, const std::uint32_t cell)
    {
      return grid.cells[cell];
    }

    /** Lanes of nodes at the upper end in direction d: +1, others -1. */
    static Nodes
    sign(const int d)
    {
      return signs[d];
    }

    /** One-dimensional weights in direction d at natural coordinate xi. */
    static Nodes
    weights(const int d, const double xi)
    {
      return lower_ends[d] + signs[d] * xi;
    }

    /** Swap the lanes of the two ends of each edge in direction d. */
    static Nodes
    across(const Nodes &a, const int d)
    {
      if constexpr (n_nodes > widest_pack)
        {
          const auto lower = some_lanes<Pack<4>>(a, 0),
                     upper = some_lanes<Pack<4>>(a, 4);
          if (d == 2)
            return joined(upper, lower);
          using Four       = typename internal::PackType<4>::mask;
          const Four other = d == 0 ? Four{1, 0, 3, 2} : Four{2, 3, 0, 1};
          return joined(__builtin_shuffle(lower, other),
                        __builtin_shuffle(upper, other));
        }
      else
        return __builtin_shuffle(a, opposites[d]);
    }

    /**
     * Turn nodal values a[i] into coefficients of monomials, in place:
     * coefficient k belongs to the product of the coordinates whose bits are
     * set in k. Lanes are components.
     */
    template <class Number>
    static void
    to_monomials(std::array<Number, n_nodes> &a, const CellGeometry<dim> & = {})
    {
      for (int d = 0; d < dim; ++d)
        for (int i = 0; i < n_nodes; ++i)
          if (i >> d & 1)
            a[i] -= a[i ^ (1 << d)];
    }

    /**
     * The transpose of to_monomials() with one lane per coefficient: from
     * forces on coefficients to forces on nodes.
     */
    static Nodes
    to_nodes(Nodes a)
    {
      for (int d = 0; d < dim; ++d)
        a -= lower_ends[d] * across(a, d);
      return a;
    }

    /**
     * From values of the monomials, or their means, to those of their
     * derivatives in direction d, one lane per monomial.
     */
    static Nodes
    derivatives(const Nodes &monomials, const int d)
    {
      return __builtin_shuffle(monomials, Nodes{}, without[d]);
    }

    /** Lane of the monomial xi_d: 1, others 0. */
    static Nodes
    linear(const int d)
    {
      return linear_monomials[d];
    }

    /** Lane of the product of all coordinates: 1, others 0. */
    static Nodes
    last()
    {
      Nodes result{};
      result[n_nodes - 1] = 1;
      return result;
    }

    /** Lanes of products of two or more coordinates: 1, others 0. */
    static Nodes
    bilinear()
    {
      Nodes result = broadcast<Nodes>(1.) - linear_monomials[0];
      for (int d = 1; d < dim; ++d)
        result -= linear_monomials[d];
      result[0] = 0;
      return result;
    }

    /** Value at natural coordinates xi; c(k) is the k-th coefficient. */
    template <class Number, class Coefficient>
    static Number
    value(const Coefficient &c, const std::array<Number, dim> &xi)
    {
      const Number lower =
        (c(0) + c(1) * xi[0]) + (c(2) + c(3) * xi[0]) * xi[1];
      if constexpr (dim == 2)
        return lower;
      else
        return lower +
               ((c(4) + c(5) * xi[0]) + (c(6) + c(7) * xi[0]) * xi[1]) * xi[2];
    }

    /** Derivatives with respect to the natural coordinates. */
    template <class Number, class Coefficient>
    static std::array<Number, dim>
    gradient(const Coefficient &c, const std::array<Number, dim> &xi)
    {
      if constexpr (dim == 2)
        return {{c(1) + c(3) * xi[1], c(2) + c(3) * xi[0]}};
      else
        {
          const Number top = c(6) + c(7) * xi[0];
          return {{(c(1) + c(3) * xi[1]) + (c(5) + c(7) * xi[1]) * xi[2],
                   (c(2) + c(3) * xi[0]) + top * xi[2],
                   (c(4) + c(5) * xi[0]) + top * xi[1]}};
        }
    }

  private:
    using Numbers = typename internal::PackType<n_nodes>::mask;

    // Compile-time constants: one lane per node, one entry per direction.
    template <int... node>
    static constexpr std::array<Nodes, dim>
    end_values(const double lower,
               const double upper,
               std::integer_sequence<int, node...>)
    {
      std::array<Nodes, dim> result{};
      for (int d = 0; d < dim; ++d)
        result[d] = Nodes{(node >> d & 1 ? upper : lower)...};
      return result;
    }

    template <int... node>
    static constexpr std::array<Numbers, dim>
    opposite_nodes(std::integer_sequence<int, node...>)
    {
      std::array<Numbers, dim> result{};
      for (int d = 0; d < dim; ++d)
        result[d] = Numbers{(node ^ (1 << d))...};
      return result;
    }

    // Index of the monomial divided by the coordinate, or of a zero lane.
    template <int... k>
    static constexpr std::array<Numbers, dim>
    monomials_without(std::integer_sequence<int, k...>)
    {
      std::array<Numbers, dim> result{};
      for (int d = 0; d < dim; ++d)
        result[d] = Numbers{(k >> d & 1 ? k ^ (1 << d) : n_nodes + k)...};
      return result;
    }

    template <int... k>
    static constexpr std::array<Nodes, dim>
    unit_lanes(std::integer_sequence<int, k...>)
    {
      std::array<Nodes, dim> result{};
      for (int d = 0; d < dim; ++d)
        result[d] = Nodes{(k == 1 << d ? 1. : 0.)...};
      return result;
    }

    using AllNodes = std::make_integer_sequence<int, n_nodes>;

    static constexpr auto signs            = end_values(-1., 1., AllNodes());
    static constexpr auto lower_ends       = end_values(1., 0., AllNodes());
    static constexpr auto linear_monomials = unit_lanes(AllNodes());
    static constexpr auto without          = monomials_without(AllNodes());
    static constexpr auto opposites        = opposite_nodes(AllNodes());
  };
} // namespace limber

#endif
