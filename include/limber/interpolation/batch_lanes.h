// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_batch_lanes_h
#define limber_interpolation_batch_lanes_h

#include <limber/interpolation/linear.h>
#include <limber/points/cell_batch.h>

namespace limber
{
  /** Packs of points are as wide as a cell has nodes. */
  template <int dim>
  using PointPack = Pack<(1 << dim)>;



  /**
   * A few points of a batch as lanes of a pack. The last pack of a batch may
   * reach beyond it. The lanes there repeat the first point, so that nothing
   * can be computed in them that could not be computed in the others; what is
   * stored there is what was there before.
   */
  template <int dim>
  class BatchLanes
  {
  public:
    using Number = PointPack<dim>;

    BatchLanes(const CellBatch &batch, const std::size_t first)
      : first(first)
      , n(batch.end - first < std::size_t(width) ? int(batch.end - first) :
                                                   width)
      , active(first_lanes<Number>(n))
    {}

    Number
    load(const double *const array) const
    {
      const Number values = limber::load<Number>(array + first);
      return n == width ? values :
                          (active ? values : broadcast<Number>(array[first]));
    }

    void
    store(const Number &values, double *const array) const
    {
      if (n == width)
        limber::store(values, array + first);
      else
        limber::store(active ? values : limber::load<Number>(array + first),
                      array + first);
    }

    /** The values of the points of the batch, zero in the other lanes. */
    Number
    only_active(const Number &values) const
    {
      return active ? values : Number{};
    }

    /** Natural coordinates of the points in their cell. */
    std::array<Number, dim>
    natural(const PointView<dim> &points, const CellGeometry<dim> &cell) const
    {
      std::array<Number, dim> xi;
      for (int d = 0; d < dim; ++d)
        xi[d] =
          (load(points.position[d]) - cell.origin[d]) * cell.inverse_edge[d];
      return xi;
    }

    static constexpr int width = 1 << dim;

    const std::size_t first; // point in the first lane
    const int         n;     // how many lanes hold points of the batch

  private:
    const decltype(first_lanes<Number>(0)) active;
  };



  /**
   * Monomial coefficients of some components of the nodal records of a cell:
   * @p n_components slots from @p first on.
   */
  template <int dim, unsigned int first, unsigned int n_components>
  class NodalCoefficients
  {
  public:
    NodalCoefficients(const CellGeometry<dim> &cell, const double *const nodes)
    {
      std::array<Lanes, 1 << dim> a;
      for (int i = 0; i < 1 << dim; ++i)
        a[i] = load<Lanes>(nodes + cell.node[i] + start);
      Linear<dim>::to_monomials(a);
      for (int i = 0; i < 1 << dim; ++i)
        store(a[i], coefficients[i]);
    }

    /** Coefficients of one component, counted from the first slot. */
    auto
    component(const unsigned int c) const
    {
      return
        [this, c](const int k) { return coefficients[k][c + first - start]; };
    }

  private:
    static constexpr unsigned int width =
      n_components <= 2 ? 2 : (n_components <= 4 ? 4 : 8);
    // Lanes beyond the wanted slots must not reach beyond the record.
    static constexpr unsigned int start =
      first + width <= NodeLayout<dim>::stride ?
        first :
        NodeLayout<dim>::stride - width;
    static_assert(first + n_components <= start + width);
    using Lanes = Pack<width>;

    double coefficients[1 << dim][width];
  };
} // namespace limber

#endif
