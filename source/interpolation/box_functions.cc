// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/box_functions.h>

namespace limber
{
  template <int dim>
  void
  BoxFunctions<dim>::set(const Block  &block,
                         const Vector &xi,
                         const Vector &half)
  {
    for (int d = 0; d < dim; ++d)
      {
        // relative to the two cells that the box sees
        const Number at    = xi[d] + (block.cell_begin[d] - block.start[d]);
        const Number lower = at - half[d], upper = at + half[d];
        const Number share = 0.5 / half[d];
        const Number below = positive_part(1. - lower),
                     rest  = positive_part(1. - upper),
                     above = positive_part(upper - 1.),
                     start = positive_part(lower - 1.);
        const Number first = 0.5 * (rest - below), last = 0.5 * (above - start);
        const Number least    = (below + rest) * (share * -first),
                     most     = (above + start) * (share * last);
        const auto is_first   = block.start[d] == 0.;
        const auto to_factors = [&](Row & factors, const Number(&own)[3])
          __attribute__((always_inline))
        {
          store(is_first ? own[0] : Number{}, factors[0]);
          store(is_first ? own[1] : own[0], factors[1]);
          store(is_first ? own[2] : own[1], factors[2]);
          store(is_first ? Number{} : own[2], factors[3]);
        };
        to_factors(changes[d], {first, -(first + last), last});
        to_factors(means[d], {least, positive_part(1. - least - most), most});
      }
  }



  template <int dim>
  void
  BoxFunctions<dim>::find_means(const Block &block)
  {
    for (int k = 0; k < block.n[2]; ++k)
      for (int j = 0; j < block.n[1]; ++j)
        {
          Number row = load<Number>(means[1][j]);
          if constexpr (dim == 3)
            row *= load<Number>(means[2][k]);
          const int first = block.row_begin(j, k);
          for (int i = 0; i < block.n[0]; ++i)
            store(row * load<Number>(means[0][i]), this->mean[first + i]);
        }
  }



  // Sum factorisation: sums over rows, planes and the block.
  template <int dim>
  void
  BoxFunctions<dim>::take_with_changes(const Block             &block,
                                       const double *const      nodes,
                                       const unsigned int       slot,
                                       Vector                  &value,
                                       std::array<Vector, dim> &change) const
  {
    Vector                  u;
    std::array<Vector, dim> du;
    set_zero(u);
    set_zero(du);
    for (int k = 0; k < block.n[2]; ++k)
      {
        Vector plane, along_x, along_y;
        set_zero(plane);
        set_zero(along_x);
        set_zero(along_y);
        for (int j = 0; j < block.n[1]; ++j)
          {
            Vector row, slope;
            set_zero(row);
            set_zero(slope);
            const std::uint32_t *const records =
              &block.records[block.row_begin(j, k)];
            for (int i = 0; i < block.n[0]; ++i)
              {
                const double *const field = nodes + records[i] + slot;
                const Number        mean  = load<Number>(means[0][i]),
                             rise         = load<Number>(changes[0][i]);
#pragma GCC unroll 3
                for (int d = 0; d < dim; ++d)
                  {
                    row[d] += mean * field[d];
                    slope[d] += rise * field[d];
                  }
              }
            const Number mean = load<Number>(means[1][j]),
                         rise = load<Number>(changes[1][j]);
#pragma GCC unroll 3
            for (int d = 0; d < dim; ++d)
              {
                plane[d] += mean * row[d];
                along_x[d] += mean * slope[d];
                along_y[d] += rise * row[d];
              }
          }
        if constexpr (dim == 2)
          {
            u  = plane;
            du = {{along_x, along_y}};
          }
        else
          {
            const Number mean = load<Number>(means[2][k]),
                         rise = load<Number>(changes[2][k]);
#pragma GCC unroll 3
            for (int d = 0; d < dim; ++d)
              {
                u[d] += mean * plane[d];
                du[0][d] += mean * along_x[d];
                du[1][d] += mean * along_y[d];
                du[2][d] += rise * plane[d];
              }
          }
      }
    value  = u;
    change = du;
  }



  template <int dim>
  template <class Window>
  void
  BoxFunctions<dim>::give_with_changes(
    const Block                             &block,
    double *const                            nodes,
    const std::array<Number, Window::width> &alike,
    const std::array<Vector, dim>           &along) const
  {
    using Slots                  = std::array<Number, Window::width>;
    constexpr unsigned int force = Window::lane_of(NodeLayout<dim>::force);
    constexpr bool only_force    = std::is_same_v<Window, ForceWindow<dim>>;
    const auto     is_force      = [](const unsigned int s) {
      return s >= force && s < force + dim;
    };
    for (int k = 0; k < block.n[2]; ++k)
      {
        // Of the plane: the factor of N_i in it, then those of its changes
        // along the axes of the plane
        Slots  plane;
        Vector along_x = along[0], along_y = along[1];
        set_zero(plane);
        if constexpr (!only_force)
          plane = alike;
        if constexpr (dim == 3)
          {
            const Number mean = load<Number>(means[2][k]),
                         rise = load<Number>(changes[2][k]);
            for (unsigned int s = 0; s < Window::width; ++s)
              if (!is_force(s))
                plane[s] *= mean;
            for (int d = 0; d < dim; ++d)
              {
                plane[force + d] = rise * along[2][d];
                along_x[d] *= mean;
                along_y[d] *= mean;
              }
          }
        for (int j = 0; j < block.n[1]; ++j)
          {
            const Number mean = load<Number>(means[1][j]),
                         rise = load<Number>(changes[1][j]);
            Slots  row;
            Vector slope;
            for (unsigned int s = 0; s < Window::width; ++s)
              row[s] = mean * plane[s];
            for (int d = 0; d < dim; ++d)
              {
                row[force + d] += rise * along_y[d];
                slope[d] = mean * along_x[d];
              }
            const std::uint32_t *const records =
              &block.records[block.row_begin(j, k)];
            for (int i = 0; i < block.n[0]; ++i)
              {
                const Number mean_i = load<Number>(means[0][i]),
                             rise_i = load<Number>(changes[0][i]);
                Slots sums;
                for (unsigned int s = 0; s < Window::width; ++s)
                  sums[s] = mean_i * row[s];
                for (int d = 0; d < dim; ++d)
                  sums[force + d] += rise_i * slope[d];
                add_sums<Window::n_used>(sums,
                                         nodes + records[i] + Window::start);
              }
          }
      }
  }



  template class BoxFunctions<2>;
  template class BoxFunctions<3>;

  template void
  BoxFunctions<2>::give_with_changes<MotionWindow<2>>(
    const Block &,
    double *,
    const std::array<Number, MotionWindow<2>::width> &,
    const std::array<Vector, 2> &) const;
  template void
  BoxFunctions<2>::give_with_changes<ForceWindow<2>>(
    const Block &,
    double *,
    const std::array<Number, ForceWindow<2>::width> &,
    const std::array<Vector, 2> &) const;
  template void
  BoxFunctions<3>::give_with_changes<MotionWindow<3>>(
    const Block &,
    double *,
    const std::array<Number, MotionWindow<3>::width> &,
    const std::array<Vector, 3> &) const;
  template void
  BoxFunctions<3>::give_with_changes<ForceWindow<3>>(
    const Block &,
    double *,
    const std::array<Number, ForceWindow<3>::width> &,
    const std::array<Vector, 3> &) const;
} // namespace limber
