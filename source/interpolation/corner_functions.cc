// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/corner_functions.h>

namespace limber
{
  // A corner beyond a side of the grid counts in it.
  template <int dim>
  template <class Place>
  __attribute__((always_inline)) inline void
  CornerFunctions<dim>::set_factors(const Block &block, const Place &place)
  {
    for (int d = 0; d < dim; ++d)
      {
        const int  last  = block.n[d] - 1;
        const auto apply = [&](const auto &work) __attribute__((always_inline))
        {
          const bool clamped = block.reaches_beyond[d];
          const auto end     = broadcast<Number>(last);
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            {
              Number x = place(c, d);
              if (rarely(clamped))
                x = smaller(positive_part(x), end);
              work(x, factors[c][d]);
            }
        };
        if (last == 1)
          apply([](const Number &x, Lanes *const to)
                  __attribute__((always_inline)) {
                    store(1. - x, to[0]);
                    store(x, to[1]);
                  });
        else if (usually(last == 2))
          apply([](const Number &x, Lanes *const to)
                  __attribute__((always_inline)) {
                    const Number lower = positive_part(1. - x),
                                 upper = positive_part(x - 1.);
                    store(lower, to[0]);
                    store((1. - lower) - upper, to[1]);
                    store(upper, to[2]);
                  });
        else
          apply([](const Number &x, Lanes *const to)
                  __attribute__((always_inline)) {
                    store(positive_part(1. - x), to[0]);
                    store(positive_part(smaller(x, 2. - x)), to[1]);
                    store(positive_part(smaller(x - 1., 3. - x)), to[2]);
                    store(positive_part(x - 2.), to[3]);
                  });
      }
  }



  template <int dim>
  void
  CornerFunctions<dim>::set(const Block                    &block,
                            const Vector                   &xi,
                            const SmallMatrix<dim, Number> &edges)
  {
    set_factors(
      block, [&](const int c, const int d) __attribute__((always_inline)) {
        Number x = xi[d] + block.cell_begin[d];
#pragma GCC unroll 3
        for (int k = 0; k < dim; ++k)
          x += DomainShape<dim>::sign(c, k) * edges[d][k];
        return x;
      });
    for (int c = 0; c < n_corners; ++c)
      {
        constexpr double share = 1. / n_corners;
        store(broadcast<Number>(share), shares[c]);
        for (int k = 0; k < dim; ++k)
          store(broadcast<Number>(DomainShape<dim>::sign(c, k) * share),
                along[k][c]);
      }
  }



  template <int dim>
  void
  CornerFunctions<dim>::set(const Block                   &block,
                            const Vector                  &xi,
                            const Hexahedron<dim, Number> &shape)
  {
    set_factors(
      block, [&](const int c, const int d) __attribute__((always_inline)) {
        return (xi[d] + block.cell_begin[d]) + shape.offsets[c][d];
      });
    for (int c = 0; c < n_corners; ++c)
      {
        store(shape.shares[c], shares[c]);
        for (int k = 0; k < dim; ++k)
          store(shape.along[k][c], along[k][c]);
      }
  }



  template <int dim>
  void
  CornerFunctions<dim>::find_means(const Block &block)
  {
    for (int k = 0; k < block.n[2]; ++k)
      for (int j = 0; j < block.n[1]; ++j)
        {
          Number row[n_corners];
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            {
              row[c] = load<Number>(shares[c]) * load<Number>(factors[c][1][j]);
              if constexpr (dim == 3)
                row[c] *= load<Number>(factors[c][2][k]);
            }
          const int first = block.row_begin(j, k);
          for (int i = 0; i < block.n[0]; ++i)
            {
              Number even = row[0] * load<Number>(factors[0][0][i]),
                     odd  = row[1] * load<Number>(factors[1][0][i]);
#pragma GCC unroll 4
              for (int c = 2; c < n_corners; c += 2)
                {
                  even += row[c] * load<Number>(factors[c][0][i]);
                  odd += row[c + 1] * load<Number>(factors[c + 1][0][i]);
                }
              store(even + odd, this->mean[first + i]);
            }
        }
  }



  template <int dim>
  void
  CornerFunctions<dim>::take_at_corners(const Block        &block,
                                        const double *const nodes,
                                        const unsigned int  slot,
                                        Corners            &values) const
  {
    // As many corners at a time as narrow registers can hold
    constexpr int some = 4;
    for (int begin = 0; begin < n_corners; begin += some)
      {
        const auto *const of = &factors[begin];
        Vector            sums[some];
#pragma GCC unroll 4
        for (int c = 0; c < some; ++c)
          set_zero(sums[c]);
        for (int k = 0; k < block.n[2]; ++k)
          for (int j = 0; j < block.n[1]; ++j)
            {
              Number row[some];
#pragma GCC unroll 4
              for (int c = 0; c < some; ++c)
                {
                  row[c] = load<Number>(of[c][1][j]);
                  if constexpr (dim == 3)
                    row[c] *= load<Number>(of[c][2][k]);
                }
              const std::uint32_t *const records =
                &block.records[block.row_begin(j, k)];
              for (int i = 0; i < block.n[0]; ++i)
                {
                  const double *const field = nodes + records[i] + slot;
#pragma GCC unroll 4
                  for (int c = 0; c < some; ++c)
                    {
                      const Number value = row[c] * load<Number>(of[c][0][i]);
#pragma GCC unroll 3
                      for (int d = 0; d < dim; ++d)
                        sums[c][d] += value * field[d];
                    }
                }
            }
#pragma GCC unroll 4
        for (int c = 0; c < some; ++c)
          values[begin + c] = sums[c];
      }
  }



  template <int dim>
  void
  CornerFunctions<dim>::combine(const Corners           &values,
                                Vector                  &value,
                                std::array<Vector, dim> &change) const
  {
    const auto sum = [&](const Lanes *const weights, const int d)
      __attribute__((always_inline))
    {
      Number result = load<Number>(weights[0]) * values[0][d];
#pragma GCC unroll 8
      for (int c = 1; c < n_corners; ++c)
        result += load<Number>(weights[c]) * values[c][d];
      return result;
    };
    for (int d = 0; d < dim; ++d)
      {
        value[d] = sum(shares, d);
        for (int k = 0; k < dim; ++k)
          change[k][d] = sum(along[k], d);
      }
  }



  template <int dim>
  template <class Window>
  void
  CornerFunctions<dim>::give_with_changes(
    const Block                             &block,
    double *const                            nodes,
    const std::array<Number, Window::width> &alike,
    const std::array<Vector, dim>           &differing) const
  {
    constexpr unsigned int force = Window::lane_of(NodeLayout<dim>::force);
    constexpr bool only_force    = std::is_same_v<Window, ForceWindow<dim>>;
    Corners        forces; // at corners
#pragma GCC unroll 8
    for (int c = 0; c < n_corners; ++c)
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          forces[c][d] = load<Number>(along[0][c]) * differing[0][d];
          for (int k = 1; k < dim; ++k)
            forces[c][d] += load<Number>(along[k][c]) * differing[k][d];
        }
    for (int k = 0; k < block.n[2]; ++k)
      for (int j = 0; j < block.n[1]; ++j)
        {
          Number row[n_corners];
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            {
              row[c] = load<Number>(factors[c][1][j]);
              if constexpr (dim == 3)
                row[c] *= load<Number>(factors[c][2][k]);
            }
          const std::uint32_t *const records =
            &block.records[block.row_begin(j, k)];
          for (int i = 0; i < block.n[0]; ++i)
            {
              std::array<Number, Window::width> sums;
              Number                            mean{};
              set_zero(sums);
#pragma GCC unroll 8
              for (int c = 0; c < n_corners; ++c)
                {
                  const Number value = row[c] * load<Number>(factors[c][0][i]);
                  if constexpr (!only_force)
                    mean += load<Number>(shares[c]) * value;
#pragma GCC unroll 3
                  for (int d = 0; d < dim; ++d)
                    sums[force + d] += value * forces[c][d];
                }
              if constexpr (!only_force)
#pragma GCC unroll 8
                for (unsigned int s = 0; s < Window::width; ++s)
                  if (s < force || s >= force + dim)
                    sums[s] = mean * alike[s];
              add_sums<Window::n_used>(sums,
                                       nodes + records[i] + Window::start);
            }
        }
  }



  template class CornerFunctions<2>;
  template class CornerFunctions<3>;

  template void
  CornerFunctions<2>::give_with_changes<MotionWindow<2>>(
    const Block &,
    double *,
    const std::array<Number, MotionWindow<2>::width> &,
    const std::array<Vector, 2> &) const;
  template void
  CornerFunctions<2>::give_with_changes<ForceWindow<2>>(
    const Block &,
    double *,
    const std::array<Number, ForceWindow<2>::width> &,
    const std::array<Vector, 2> &) const;
  template void
  CornerFunctions<3>::give_with_changes<MotionWindow<3>>(
    const Block &,
    double *,
    const std::array<Number, MotionWindow<3>::width> &,
    const std::array<Vector, 3> &) const;
  template void
  CornerFunctions<3>::give_with_changes<ForceWindow<3>>(
    const Block &,
    double *,
    const std::array<Number, ForceWindow<3>::width> &,
    const std::array<Vector, 3> &) const;
} // namespace limber
