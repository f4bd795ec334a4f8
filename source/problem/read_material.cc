// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/base/law_parameter.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/acceleration.h>
#include <limber/problem/point_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limber
{
  namespace
  {
    bool
    is_choice(const LawParameter &parameter)
    {
      return std::string(parameter.words).find('|') != std::string::npos;
    }



    Admissible
    admissible_values(const LawParameter &parameter)
    {
      const std::string words   = parameter.words;
      const std::string example = brief(parameter.standard);
      if (words == "false|true")
        return admissible::flag();
      if (is_choice(parameter))
        return admissible::one_of(split(words, '|'));

      const bool bounded = parameter.highest < 1e299;
      Admissible result =
        bounded ?
          (parameter.closed ? admissible::number_from_to(parameter.lowest,
                                                         parameter.highest,
                                                         example) :
                              admissible::number_between(parameter.lowest,
                                                         parameter.highest,
                                                         example)) :
        parameter.closed ? admissible::non_negative_number(example) :
                           admissible::positive_number(example);
      if (parameter.required)
        return result.or_empty();
      return words.empty() ? result : result.or_word(words);
    }
  } // namespace



  void
  declare_material_sections(Parameters &parameters)
  {
    for (const LawDescription &law : describe_laws())
      {
        parameters.enter_subsection(law.section());
        for (const LawParameter &parameter : law.parameters)
          parameters.declare(parameter.name,
                             parameter.required ?
                               std::string() :
                             is_choice(parameter) ?
                               split(parameter.words,
                                     '|')[std::size_t(parameter.standard)] :
                               brief(parameter.standard),
                             admissible_values(parameter),
                             parameter.text + std::string("."));
        parameters.leave_subsection();
      }
  }



  namespace
  {
    /**
     * Sampled on a lattice inside the body; places where the formula is
     * undefined are skipped.
     */
    template <int dim>
    double
    largest_initial_speed(const Body<dim> &body)
    {
      double of_list = 0;
      if (const auto *list =
            dynamic_cast<const PointListShape<dim> *>(body.shape.get()))
        for (const auto &point : list->points)
          of_list = std::max(of_list, point.velocity.norm());
      if (body.initial_velocity.is_zero())
        return of_list;
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
      return largest + of_list;
    }



    /** Of the moving sides, sampled on a lattice of each up to the end time. */
    template <int dim>
    double
    largest_side_speed(const Problem<dim> &problem)
    {
      constexpr unsigned int n_times = 200; // as a formula may be periodic
      double                 largest = 0;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if (const Formula<dim> &velocity = problem.sides[side].velocity;
            !velocity.empty())
          for (const auto &place : places_in_side(side, problem.grid))
            for (unsigned int k = 0; k <= n_times; ++k)
              if (const double t = problem.end_time * k / n_times;
                  velocity.is_finite(place, t))
                largest = std::max(largest, velocity.vector(place, t).norm());
      return largest;
    }



    template <int dim>
    double
    largest_expected_speed(const Body<dim> &body, const Problem<dim> &problem)
    {
      // |g| H, also for gravity that is not along an axis.
      const auto         acceleration = largest_acceleration(problem, body);
      const Corners<dim> box          = body.shape->bounding_box();
      double             fall         = 0;
      for (unsigned int d = 0; d < dim; ++d)
        fall += acceleration[d] * (box.second[d] - box.first[d]);
      return std::max(std::sqrt(2 * fall) + largest_initial_speed(body),
                      largest_side_speed(problem));
    }



    /** Bulk modulus of the word 'auto'; says in the log what it is. */
    template <int dim>
    double
    automatic_bulk_modulus(const Section   &section,
                           const Body<dim> &body,
                           Problem<dim>    &problem)
    {
      const double speed = largest_expected_speed(body, problem);
      if (speed <= 0)
        throw InputError(
          "The bulk modulus 'auto' in " + section.where("Bulk modulus") +
          " needs a velocity to go by, but there is neither gravity, body "
          "force, initial velocity nor a side that moves. Give a number, for "
          "instance 2e9.");

      const double sound   = 10 * speed;
      const double inertia = body.density() * sound * sound;
      // A side that drags what is viscous presses it as well, next to an edge
      // by mu v / h. Free fall says nothing of the velocity of such a liquid.
      double smallest_edge = problem.grid.edge(0);
      for (unsigned int d = 1; d < dim; ++d)
        smallest_edge = std::min(smallest_edge, problem.grid.edge(d));
      const double viscosity =
        section.has_entry("Viscosity") ? section.number("Viscosity") : 0;
      const double drag =
        100 * viscosity *
        std::max(largest_initial_speed(body), largest_side_speed(problem)) /
        smallest_edge;
      const double modulus = std::max(inertia, drag);
      problem.notes.push_back(
        "Body " + in_quotes(body.name) + ": bulk modulus 'auto' is " +
        brief(modulus) + " Pa, for velocities up to " + brief(speed) + " m/s " +
        (drag > inertia ? "and viscous pressures of a hundredth of that." :
                          "and a speed of sound of " + brief(sound) + " m/s."));
      return modulus;
    }



    /** A number, or of a word its position among the choices. */
    double
    read_value(const Section &section, const LawParameter &parameter)
    {
      const std::string text = section.text(parameter.name);
      if (!is_choice(parameter))
        return section.number(parameter.name);
      if (parameter.words == std::string("false|true"))
        return section.flag(parameter.name);
      const auto words = split(parameter.words, '|');
      return std::find(words.begin(), words.end(), text) - words.begin();
    }
    /** Value of a named entry of a law, if the law has it. */
    std::optional<double>
    value_of(const std::string         &entry,
             const LawDescription      &law,
             const std::vector<double> &material)
    {
      for (std::size_t k = 0; k < law.parameters.size(); ++k)
        if (law.parameters[k].name == entry)
          return material[k];
      return {};
    }



    // Cohesive soil is often meant to bear some tension; without tensile
    // strength it sheds points.
    template <int dim>
    void
    note_lack_of_tension(const LawDescription &law,
                         const Body<dim>      &body,
                         Problem<dim>         &problem)
    {
      const auto cohesion = value_of("Cohesion", law, body.material),
                 tension  = value_of("Tensile strength", law, body.material),
                 angle    = value_of("Friction angle", law, body.material);
      if (!cohesion || !tension || *cohesion == 0 || *tension > 0)
        return;
      const double apex =
        *cohesion / std::tan(*angle * dealii::numbers::PI / 180);
      problem.notes.push_back(
        "Body " + in_quotes(body.name) +
        " has cohesion but bears no tension: it comes apart where it is "
        "pulled, and may bear less under a footing. 'Tensile strength' gives "
        "it some" +
        (*angle > 0 ? ", at most " + brief(apex) + " Pa, c cot(phi)." : "."));
    }
  } // namespace



  namespace
  {
    /** Notes a strength fitted to plane strain in three dimensions, where soil
     * is mostly compressed along one axis: it is weaker there, by the slope
     * m = sqrt(3) sin(phi) of q over p. */
    template <int dim>
    void
    note_fit_to_plane_strain(const LawDescription &law,
                             const Section        &own,
                             const Body<dim>      &body,
                             Problem<dim>         &problem)
    {
      if (dim == 2 || law.name != "drucker prager" ||
          own.text("Fit") != "plane strain")
        return;
      const double phi = own.number("Friction angle"),
                   m = std::sqrt(3) * std::sin(phi * dealii::numbers::PI / 180),
                   angle =
                     std::asin(3 * m / (6 + m)) * 180 / dealii::numbers::PI;
      if (phi > 0)
        problem.notes.push_back(
          "Body " + in_quotes(body.name) + ": fitted to plane strain, " +
          brief(phi) + " degrees of friction are " +
          brief(std::round(10 * angle) / 10) +
          " in triaxial compression. Usually 'Drucker prager/Fit = triaxial "
          "compression' is meant in three dimensions.");
    }
  } // namespace



  template <int dim>
  void
  read_material(const Section &section, Body<dim> &body, Problem<dim> &problem)
  {
    const LawDescription law = read_word(section, "Material", law_words());
    const Section        own = section.subsection(law.section());
    body.law                 = law.name;
    body.material.clear();
    for (const LawParameter &parameter : law.parameters)
      body.material.push_back(own.text(parameter.name) == "auto" ?
                                automatic_bulk_modulus(own, body, problem) :
                                read_value(own, parameter));
    if (const std::string objection = objection_to(law.name, body.material);
        !objection.empty())
      throw InputError("In the section " + in_quotes(law.section()) +
                       " of body " + in_quotes(body.name) + " " + objection +
                       ".");
    note_lack_of_tension(law, body, problem);
    note_fit_to_plane_strain(law, own, body, problem);
  }



  template void
  read_material<2>(const Section &, Body<2> &, Problem<2> &);
  template void
  read_material<3>(const Section &, Body<3> &, Problem<3> &);
} // namespace limber
