// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/farthest_place.h>
#include <limber/problem/obstacle.h>
#include <limber/problem/read_parts.h>
#include <limber/simulation/initial_state.h>

#include <cmath>

namespace limber
{
  namespace
  {
    /**
     * Lithostatic or hydrostatic stress s >= s_0 of a compressible material
     * under a head rho_0 g z, Pa: ds/dz = rho_0 g / J(s), by the classical
     * Runge-Kutta method. For a stiff liquid it is rho_0 g z; a soft one is
     * denser at the bottom and would otherwise oscillate from the start.
     */
    template <class VolumeRatio>
    double
    stress_under(const double head, const double s_0, const VolumeRatio &J_at)
    {
      constexpr unsigned int n_steps = 16;
      const double           step    = head / n_steps;
      const auto slope = [&](const double s) { return 1 / J_at(s); };
      double     s     = s_0;
      for (unsigned int i = 0; i < n_steps; ++i)
        {
          const double a = slope(s);
          const double b = slope(s + 0.5 * step * a);
          const double c = slope(s + 0.5 * step * b);
          const double d = slope(s + step * c);
          s += step / 6 * (a + 2 * b + 2 * c + d);
        }
      return s;
    }



    using Components = std::array<double, 6>; // xx, yy, zz, xy, yz, zx

    template <int dim>
    void
    set_stress(const Components &sigma, PointStart<dim> &start)
    {
      start.pressure    = -(sigma[0] + sigma[1] + sigma[2]) / 3;
      start.deviator[0] = sigma[0] + start.pressure;
      start.deviator[1] = sigma[1] + start.pressure;
      for (unsigned int k = 2; k < start.deviator.size(); ++k)
        start.deviator[k] = sigma[k + 1];
    }
  } // namespace



  template <int dim>
  InitialState<dim>::InitialState(const Problem<dim>      &problem,
                                  const Body<dim>         &body,
                                  const StressUpdate<dim> &law,
                                  const OfAllBodies       &of_all)
    : problem(problem)
    , body(body)
    , law(law)
    , of_all(of_all)
  {
    if (!is_in_equilibrium())
      return;
    up               = -problem.loads.gravity / problem.loads.gravity.norm();
    const auto place = farthest_place<dim>(*body.shape, up);
    if (!place)
      throw InputError(
        "The highest place of body " + in_quotes(body.name) +
        " is not found, below which 'Body " + body.name + "/Initial " +
        (body.hydrostatic ? "pressure" : "stress") +
        "' begins. Usually the body is very thin in its bounding box. Write "
        "a formula there, or give tighter corners of the shape.");
    highest = *place;
    stride  = problem.grid.finest_edge(0) / 2;
    for (unsigned int d = 1; d < dim; ++d)
      stride = std::min(stride, problem.grid.finest_edge(d) / 2);
  }



  template <int dim>
  bool
  InitialState<dim>::is_in_equilibrium() const
  {
    return body.hydrostatic ||
           (body.initial_stress && !body.initial_stress->lateral_ratio.empty());
  }



  template <int dim>
  std::optional<double>
  InitialState<dim>::stress_along_gravity(const dealii::Point<dim> &place) const
  {
    if (!body.is_liquid && !body.initial_stress)
      return std::nullopt;
    const PointStart<dim> start = at(place);
    if (body.is_liquid)
      return start.pressure;
    Components sigma{};
    for (unsigned int k = 0; k < start.deviator.size(); ++k)
      sigma[k < 2 ? k : k + 1] = start.deviator[k];
    sigma[2] = -sigma[0] - sigma[1];
    double s = start.pressure;
    for (unsigned int d = 0; d < dim; ++d)
      s -= up[d] * (sigma[d] * up[d] + 2 * sigma[3 + d] * up[(d + 1) % dim]);
    return s;
  }



  template <int dim>
  std::optional<double>
  InitialState<dim>::load_on(const dealii::Point<dim> &surface) const
  {
    const dealii::Point<dim> above = surface + 1e-6 * stride * up;
    if (!problem.grid.has_inside(above))
      return std::nullopt;
    for (const Obstacle<dim> &obstacle : problem.obstacles)
      if (ObstaclePlace<dim>(obstacle, 0).distance(above).value < 0)
        return std::nullopt;
    for (const auto &other : of_all)
      if (other.get() != this && other->body.shape->contains(above))
        return other->stress_along_gravity(above);
    return 0.;
  }



  template <int dim>
  const typename InitialState<dim>::Column &
  InitialState<dim>::column_above(const dealii::Point<dim> &place) const
  {
    const double               height = up * place;
    const auto                 across = place - height * up;
    std::array<long long, dim> key;
    for (unsigned int d = 0; d < dim; ++d)
      key[d] = std::llround(across[d] / (1e-6 * stride));

    std::vector<Column> &known = columns[key];
    for (const Column &column : known)
      if (column.lowest <= height && height <= column.top)
        return column;

    const dealii::Point<dim> end =
      place + way_out(*body.shape, place, up, stride) * up;
    Column column{height, up * end, up * end, 0};
    if (const auto load = load_on(end))
      column.load = *load;
    else
      {
        column.head = up * highest;
        column.load = load_on(highest).value_or(0);
      }
    known.push_back(column);
    return known.back();
  }



  template <int dim>
  PointStart<dim>
  InitialState<dim>::at(const dealii::Point<dim> &place) const
  {
    PointStart<dim> start;
    set_variables(place, start);
    if (body.initial_pressure)
      start.pressure = body.initial_pressure->value(place, 0);
    else if (body.hydrostatic)
      {
        const Column &column = column_above(place);
        start.pressure       = stress_under(weight_above(place, column),
                                      column.load,
                                      [&](const double p) {
                                        PointStart<dim> deeper;
                                        deeper.pressure = p;
                                        return law.volume_ratio_at(deeper);
                                      });
      }
    else if (body.initial_stress && !body.initial_stress->lateral_ratio.empty())
      set_geostatic(place, start);
    else if (body.initial_stress)
      set_components(place, start);
    if (!std::isfinite(start.pressure) ||
        !std::isfinite(squared_norm<dim, double>(start.deviator)))
      throw InputError("The initial stress of body " + in_quotes(body.name) +
                       " at " + to_text(place) +
                       " is not finite. Usually a formula divides by zero or "
                       "takes a root there. Correct 'Body " +
                       body.name + "/Initial " +
                       (body.initial_stress ? "stress'." : "pressure'."));
    return start;
  }



  template <int dim>
  void
  InitialState<dim>::refuse(const dealii::Point<dim> &place) const
  {
    const PointStart<dim> start = at(place);
    throw InputError(
      "The initial stress of body " + in_quotes(body.name) + " at " +
      to_text(place) + ", p = " + brief(start.pressure) + " Pa, q = " +
      brief(std::sqrt(1.5 * squared_norm<dim, double>(start.deviator))) +
      " Pa, is outside the yield surface. Usually K0 is too small for the "
      "strength, or clay has a 'Preconsolidation pressure' below its pressure. "
      "Correct 'Body " +
      body.name + "/Initial stress' or the material.");
  }



  template <int dim>
  void
  InitialState<dim>::set_variables(const dealii::Point<dim> &place,
                                   PointStart<dim>          &start) const
  {
    if (body.initial_state.empty())
      return;
    const auto variables = variables_of(body.law, body.material);
    for (const auto &[k, formula] : body.initial_state)
      {
        const StateVariable &variable = variables[k];
        const double         value    = formula.value(place, 0);
        if (!(value >= variable.lowest))
          throw InputError(
            "The variable " + in_quotes(variable.name) + " of body " +
            in_quotes(body.name) + " is " + brief(value) + " at the place " +
            to_text(place) + " by 'Body " + body.name +
            "/Initial state', where it is at least " + brief(variable.lowest) +
            ". Usually a formula has the wrong sign. Correct it there.");
        start.variables[k] = value;
      }
  }



  template <int dim>
  void
  InitialState<dim>::set_components(const dealii::Point<dim> &place,
                                    PointStart<dim>          &start) const
  {
    Components sigma{};
    for (unsigned int k = 0; k < sigma.size(); ++k)
      if (const auto &formula = body.initial_stress->components[k];
          !formula.empty())
        sigma[k] = formula.value(place, 0);
    set_stress(sigma, start);
  }



  // Geostatic stress: along gravity the weight above, across it K0 times that.
  template <int dim>
  void
  InitialState<dim>::set_geostatic(const dealii::Point<dim> &place,
                                   PointStart<dim>          &start) const
  {
    const InitialStress<dim> &stress     = *body.initial_stress;
    const double              K0         = stress.lateral_ratio.value(place, 0);
    const Column             &column     = column_above(place);
    const double              overburden = stress.overburden.empty() ?
                                             column.load :
                                             stress.overburden.value(place, 0);
    if (!(K0 >= 0) || !(overburden >= 0))
      throw InputError("In 'Body " + body.name + "/Initial stress' K0 is " +
                       brief(K0) + " and the overburden " + brief(overburden) +
                       " Pa at " + to_text(place) +
                       ", where neither may be negative. Usually a formula "
                       "has the wrong sign. Correct it there.");
    const auto   gravity   = problem.loads.gravity;
    const double g         = gravity.norm();
    const auto   put_under = [&](const double s) {
      Components sigma{{-K0 * s, -K0 * s, -K0 * s, 0, 0, 0}};
      const auto n = [&](const unsigned int d) {
        return d < dim ? gravity[d] / g : 0;
      };
      for (unsigned int d = 0; d < 3; ++d)
        {
          sigma[d] -= (1 - K0) * s * n(d) * n(d);
          sigma[3 + d] = -(1 - K0) * s * n(d) * n((d + 1) % 3);
        }
      set_stress(sigma, start);
    };
    put_under(
      stress_under(weight_above(place, column), overburden, [&](double s) {
        put_under(s);
        return law.volume_ratio_at(start);
      }));
  }



  template <int dim>
  double
  InitialState<dim>::weight_above(const dealii::Point<dim> &place,
                                  const Column             &column) const
  {
    return body.density() * problem.loads.gravity.norm() *
           (column.head - up * place);
  }



  template class InitialState<2>;
  template class InitialState<3>;
} // namespace limber
