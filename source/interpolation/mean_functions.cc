// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/mean_functions.h>

namespace limber
{
  template <int dim>
  template <int n>
  std::array<typename MeanFunctions<dim>::Number, n>
  MeanFunctions<dim>::take(const Block        &block,
                           const double *const nodes,
                           const unsigned int  slot) const
  {
    std::array<Number, n> result;
    set_zero(result);
    block.for_nodes([&](const int i, const std::uint32_t record)
                      __attribute__((always_inline)) {
                        const Number  N     = load<Number>(mean[i]);
                        const double *field = nodes + record + slot;
#pragma GCC unroll 8
                        for (int s = 0; s < n; ++s)
                          result[s] += N * field[s];
                      });
    return result;
  }



  template <int dim>
  template <class Window>
  void
  MeanFunctions<dim>::give(const Block                             &block,
                           double *const                            nodes,
                           const std::array<Number, Window::width> &given) const
  {
    const auto own = given; // local copy: stores to nodes cannot alias it
    block.for_nodes([&](const int i, const std::uint32_t record) __attribute__((
      always_inline)) {
      const Number                      N = load<Number>(mean[i]);
      std::array<Number, Window::width> sums;
#pragma GCC unroll 8
      for (unsigned int s = 0; s < Window::width; ++s)
        sums[s] = N * own[s];
      add_sums<Window::n_used>(sums, nodes + record + Window::start);
    });
  }



  template class MeanFunctions<2>;
  template class MeanFunctions<3>;

  template std::array<PointPack<2>, 2>
  MeanFunctions<2>::take<2>(const Block &, const double *, unsigned int) const;
  template std::array<PointPack<2>, 4>
  MeanFunctions<2>::take<4>(const Block &, const double *, unsigned int) const;
  template std::array<PointPack<3>, 3>
  MeanFunctions<3>::take<3>(const Block &, const double *, unsigned int) const;
  template std::array<PointPack<3>, 6>
  MeanFunctions<3>::take<6>(const Block &, const double *, unsigned int) const;

  template void
  MeanFunctions<2>::give<MotionWindow<2>>(
    const Block &,
    double *,
    const std::array<PointPack<2>, MotionWindow<2>::width> &) const;
  template void
  MeanFunctions<3>::give<MotionWindow<3>>(
    const Block &,
    double *,
    const std::array<PointPack<3>, MotionWindow<3>::width> &) const;
  template void
  MeanFunctions<2>::give<RemapWindow<2>>(
    const Block &,
    double *,
    const std::array<PointPack<2>, RemapWindow<2>::width> &) const;
  template void
  MeanFunctions<3>::give<RemapWindow<3>>(
    const Block &,
    double *,
    const std::array<PointPack<3>, RemapWindow<3>::width> &) const;
} // namespace limber
