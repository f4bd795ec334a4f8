// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_make_sweep_h
#define limber_stress_make_sweep_h

#include <limber/materials/law_list.h>
#include <limber/stress/initial_frame_sweep.h>
#include <limber/stress/law_sweep.h>
#include <limber/stress/spline_sweep.h>

#include <memory>
#include <stdexcept>

/** @file The sweeps of a law, for each basis. */
namespace limber
{
  template <class Basis, class Law>
  std::unique_ptr<const StressUpdate<Basis::dim>>
  make_sweep(const Law &law, const StrainProjection &projection)
  {
    const auto with = [&](const auto kind) {
      using Sweep = LawSweep<Basis, Law, decltype(kind)::value>;
      return std::unique_ptr<const StressUpdate<Basis::dim>>(
        std::make_unique<Sweep>(law, projection));
    };
    using P = Projection;
    switch (projection.kind)
      {
        case P::automatic:
          throw std::logic_error("no projection chosen");
        case P::none:
          return with(std::integral_constant<P, P::none>());
        case P::cell:
          return with(std::integral_constant<P, P::cell>());
        case P::node:
          return with(std::integral_constant<P, P::node>());
        default:
          break;
      }
    if constexpr (Law::has_deviator)
      switch (projection.kind)
        {
          case P::cell_shear:
            return with(std::integral_constant<P, P::cell_shear>());
          case P::cell_full:
            return with(std::integral_constant<P, P::cell_full>());
          case P::hybrid:
            return with(std::integral_constant<P, P::hybrid>());
          case P::assumed_strain:
            return with(std::integral_constant<P, P::assumed_strain>());
          default:
            break;
        }
    throw std::logic_error("no such projection");
  }



  /** Those of splines, of any law. */
  template <class Basis, class Law>
  std::unique_ptr<const StressUpdate<Basis::dim>>
  make_spline_sweep(const Law &law, const StrainProjection &projection)
  {
    return std::make_unique<SplineSweep<Basis, Law>>(law, projection);
  }



  /** Those in the frame of the initial configuration, of elastic laws. */
  template <class Basis, class Law>
  std::unique_ptr<const StressUpdate<Basis::dim>>
  make_initial_frame_sweep(const Law                               &law,
                           [[maybe_unused]] const StrainProjection &projection)
  {
    const auto with = [&](const auto kind) {
      using Sweep = InitialFrameSweep<Basis, Law, decltype(kind)::value>;
      return std::unique_ptr<const StressUpdate<Basis::dim>>(
        std::make_unique<Sweep>(law, projection));
    };
    using P = Projection;
    if constexpr (Law::is_elastic)
      switch (projection.kind)
        {
          case P::none:
            return with(std::integral_constant<P, P::none>());
          case P::cell:
            return with(std::integral_constant<P, P::cell>());
          case P::assumed_strain:
            if constexpr (Basis::n_nodes == 1 << Basis::dim)
              return with(std::integral_constant<P, P::assumed_strain>());
            break;
          default:
            break;
        }
    throw std::logic_error("law or projection without an initial frame");
  }



  /** All with splines, of any law, each in a translation unit of its own. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_quadratic_sweep(const AnyLaw           &law,
                       const StrainProjection &projection,
                       Frame                   frame);
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_cubic_sweep(const AnyLaw           &law,
                   const StrainProjection &projection,
                   Frame                   frame);

  /** The same for points with convected domains. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_convected_sweep(const AnyLaw &law, const StrainProjection &projection);

  /** The same with gradients that partly come from the nodes. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_dual_domain_sweep(const AnyLaw &law, const StrainProjection &projection);
} // namespace limber

#endif
