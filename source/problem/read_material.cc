// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/law_parameter.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    void
    declare_density(Parameters &parameters)
    {
      parameters.declare("Density",
                         "1000",
                         admissible::positive_number("1000"),
                         law_parameters::density.text + std::string("."));
    }



    void
    declare_solid(Parameters        &parameters,
                  const std::string &section,
                  const std::string &file)
    {
      const LawParameter &nu = law_parameters::poisson_ratio;
      parameters.enter_subsection(section);
      declare_density(parameters);
      parameters.declare("Young's modulus",
                         "1e6",
                         admissible::positive_number("1e6"),
                         law_parameters::young_modulus.text +
                           std::string("; the law is in ") + file + ".");
      parameters.declare("Poisson's ratio",
                         "0.3",
                         admissible::number_between(nu.lowest,
                                                    nu.highest,
                                                    "0.3"),
                         nu.text + std::string("."));
      parameters.leave_subsection();
    }



    void
    declare_fluid(Parameters &parameters)
    {
      parameters.enter_subsection("Newtonian fluid");
      declare_density(parameters);
      parameters.declare("Bulk modulus",
                         "2e9",
                         admissible::positive_number("2e9").or_word("auto"),
                         "K, Pa; 'auto': the softest one that keeps the Mach "
                         "number below 0.1, K = rho_0 c^2 with c = 10 v, v = "
                         "sqrt(2 |g| H) + the largest initial speed, H the "
                         "extent of the body along gravity.");
      parameters.declare("Viscosity",
                         "0",
                         admissible::non_negative_number("1e-3"),
                         "mu, Pa s; deviatoric stress 2 mu dev(D), see "
                         "materials/newtonian_fluid.h.");
      parameters.declare("Tension cutoff",
                         "false",
                         admissible::flag(),
                         "Whether negative pressure is set to zero, so that "
                         "the fluid parts freely.");
      declare_word(parameters,
                   "Equation of state",
                   "linear",
                   equation_of_state_words(),
                   "Pressure p from the volume ratio J: K (1/J - 1) or K/gamma "
                   "(J^-gamma - 1).");
      parameters.declare("Tait exponent",
                         "7",
                         admissible::positive_number("7"),
                         "gamma, no unit, for 'tait'.");
      parameters.leave_subsection();
    }
  } // namespace



  void
  declare_material_sections(Parameters &parameters)
  {
    declare_solid(parameters, "Linear elastic", "materials/linear_elastic.h");
    declare_solid(parameters, "Neo hookean", "materials/neo_hookean.h");
    declare_fluid(parameters);
  }



  namespace
  {
    LinearElasticParameters
    read_solid(const Section &section)
    {
      LinearElasticParameters result;
      result.density       = section.number("Density");
      result.young_modulus = section.number("Young's modulus");
      result.poisson_ratio = section.number("Poisson's ratio");
      return result;
    }



    /** On a lattice inside the body; where the formula is undefined, skipped.
     */
    template <int dim>
    double
    largest_initial_speed(const Body<dim> &body)
    {
      if (body.initial_velocity.is_zero())
        return 0;
      const Corners<dim> box = body.shape->bounding_box();
      const unsigned int n   = dim == 2 ? 50 : 20;

      double largest = 0;
      for (unsigned int i = 0; i < std::pow(n, dim); ++i)
        {
          dealii::Point<dim> place;
          unsigned int       index = i;
          for (unsigned int d = 0; d < dim; ++d, index /= n)
            place[d] = box.first[d] +
                       (index % n + 0.5) / n * (box.second[d] - box.first[d]);
          if (body.shape->contains(place) &&
              body.initial_velocity.is_finite(place, 0.))
            largest =
              std::max(largest, body.initial_velocity.vector(place, 0.).norm());
        }
      return largest;
    }



    template <int dim>
    double
    largest_expected_speed(const Body<dim>              &body,
                           const dealii::Tensor<1, dim> &gravity)
    {
      // |g| H, also for gravity that is not along an axis.
      const Corners<dim> box  = body.shape->bounding_box();
      double             fall = 0;
      for (unsigned int d = 0; d < dim; ++d)
        fall += std::abs(gravity[d]) * (box.second[d] - box.first[d]);
      return std::sqrt(2 * fall) + largest_initial_speed(body);
    }



    /** K of the word 'auto'; says in the log what it is. */
    template <int dim>
    double
    automatic_bulk_modulus(const Section   &section,
                           const Body<dim> &body,
                           Problem<dim>    &problem)
    {
      const double speed = largest_expected_speed(body, problem.loads.gravity);
      if (speed <= 0)
        throw InputError("The bulk modulus 'auto' in " +
                         section.where("Bulk modulus") +
                         " needs a velocity to go by, but there is neither "
                         "gravity nor initial velocity. Give a number, for "
                         "instance 2e9.");

      const double sound   = 10 * speed;
      const double modulus = body.newtonian_fluid.density * sound * sound;
      problem.notes.push_back(
        "Body " + in_quotes(body.name) + ": bulk modulus 'auto' is " +
        brief(modulus) + " Pa, for velocities up to " + brief(speed) +
        " m/s and a speed of sound of " + brief(sound) + " m/s.");
      return modulus;
    }



    NewtonianFluidParameters
    read_fluid(const Section &section)
    {
      NewtonianFluidParameters result;
      result.density   = section.number("Density");
      result.viscosity = section.number("Viscosity");
      result.bulk_modulus =
        to_number(section.text("Bulk modulus")).value_or(-1);
      result.tension_cutoff = section.flag("Tension cutoff");
      result.tait =
        read_word(section, "Equation of state", equation_of_state_words()) ==
        EquationOfState::tait;
      result.tait_exponent = section.number("Tait exponent");
      return result;
    }
  } // namespace



  template <int dim>
  void
  read_material(const Section &section, Body<dim> &body, Problem<dim> &problem)
  {
    body.law            = read_word(section, "Material", law_words());
    body.linear_elastic = read_solid(section.subsection("Linear elastic"));
    body.neo_hookean    = read_solid(section.subsection("Neo hookean"));

    const Section fluid  = section.subsection("Newtonian fluid");
    body.newtonian_fluid = read_fluid(fluid);
    if (body.law == LawKind::newtonian_fluid &&
        body.newtonian_fluid.bulk_modulus < 0)
      body.newtonian_fluid.bulk_modulus =
        automatic_bulk_modulus(fluid, body, problem);
  }



  template void
  read_material<2>(const Section &, Body<2> &, Problem<2> &);
  template void
  read_material<3>(const Section &, Body<3> &, Problem<3> &);
} // namespace limber
