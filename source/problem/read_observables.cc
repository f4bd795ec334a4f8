// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** Those of the kinds, the same in two and three dimensions. */
    std::vector<std::string>
    kind_words()
    {
      std::vector<std::string> words;
      for (const auto &kind : observable_kinds<2>())
        words.push_back(kind.word);
      return words;
    }



    /** x, -x, +x, ... and xx, xy, ... */
    std::vector<std::string>
    direction_words(const unsigned int dim)
    {
      const std::vector<std::string> axes =
        dim == 2 ? std::vector<std::string>{"x", "y"} :
                   std::vector<std::string>{"x", "y", "z"};
      std::vector<std::string> words;
      for (const std::string sign : {"", "+", "-"})
        for (const std::string &axis : axes)
          words.push_back(sign + axis);
      for (const std::string &first : axes)
        for (const std::string &second : axes)
          words.push_back(first + second);
      return words;
    }



    /** "0, 0; 1, 3": two opposite corners. */
    Admissible
    corners_entry(const unsigned int dim)
    {
      const Admissible corner = admissible::numbers(dim, "");
      return Admissible(
        [corner](const std::string &value) {
          const auto parts = split(value, ';');
          return parts.size() == 2 && corner.match(parts[0]) &&
                 corner.match(parts[1]);
        },
        "lower and upper corner of a box, " + corner.description() +
          " each, ';' between them",
        for_each_direction(dim, "0") + "; " + for_each_direction(dim, "1"));
    }



    void
    declare_observable(Parameters        &parameters,
                       const unsigned int dim,
                       const std::string &name)
    {
      parameters.enter_subsection("Observable " + name);
      parameters.declare("Type",
                         "",
                         admissible::one_of(kind_words()).or_empty(),
                         "What is observed in every step.");
      parameters.declare("Body",
                         "",
                         admissible::text("name of a body, or empty", "beam"),
                         "The body; empty: all bodies. One is needed where a "
                         "'Location' is given and there are several.");
      parameters.declare(
        "Location",
        "",
        admissible::numbers(dim, for_each_direction(dim, "1")).or_empty(),
        "The point nearest to this place at the start is "
        "followed, m.");
      parameters.declare("Direction",
                         "",
                         admissible::one_of(direction_words(dim)).or_empty(),
                         "Component, with two letters for stress; the sign "
                         "tells the extreme coordinates +x and -x apart and "
                         "otherwise turns the value around.");
      parameters.declare("Within",
                         "",
                         corners_entry(dim).or_empty(),
                         "The region of space that 'mean' values and 'mass "
                         "within' are taken of, m: of the points whose "
                         "centres are in it now; for extreme coordinate: only "
                         "those count.");
      parameters.declare("Share beyond",
                         "",
                         admissible::number_between(0, 1, "0.01").or_empty(),
                         "For extreme coordinate: the share of the mass that "
                         "lies beyond it, so that single points thrown ahead "
                         "do not count. Empty: none.");
      parameters.declare("Observable",
                         "",
                         admissible::text("name of an observable", "tip"),
                         "Of which observable: its frequency, from its zero "
                         "crossings, its mean over time, or its largest or "
                         "smallest value so far.");
      parameters.declare("From time",
                         "",
                         admissible::non_negative_number("0.5").or_empty(),
                         "For these: rows before it do not count, s.");
      parameters.declare("Side",
                         "",
                         admissible::one_of(side_names(dim)).or_empty(),
                         "For reaction force: the side of the grid.");
      parameters.declare("Obstacle",
                         "",
                         admissible::text("name of an obstacle, or empty",
                                          "pillar"),
                         "For obstacle force and obstacle moment: of which.");
      parameters.declare("Variable",
                         "",
                         admissible::one_of(names_of_variables()).or_empty(),
                         "For state variable: which of those that the "
                         "material of the body keeps.");
      parameters.leave_subsection();
    }
  } // namespace



  void
  declare_observables(Parameters                     &parameters,
                      const unsigned int              dim,
                      const std::vector<std::string> &names)
  {
    for (const std::string &name : names)
      declare_observable(parameters, dim, name);
  }



  namespace
  {
    /** Every entry that the kind needs is there, and no other. */
    template <int dim>
    void
    check_entries(const Section &section, const ObservableKind<dim> &kind)
    {
      const auto contains = [](const std::vector<std::string> &list,
                               const std::string              &entry) {
        return std::find(list.begin(), list.end(), entry) != list.end();
      };
      for (const std::string entry : {"Body",
                                      "Location",
                                      "Direction",
                                      "Within",
                                      "Share beyond",
                                      "Observable",
                                      "From time",
                                      "Side",
                                      "Obstacle",
                                      "Variable"})
        if (contains(kind.required, entry))
          section.required_text(entry);
        else if (!contains(kind.optional, entry) && !section.is_empty(entry))
          throw InputError("The value " + in_quotes(section.text(entry)) +
                           " in " + section.where(entry) +
                           " has no meaning for the type " +
                           in_quotes(kind.word) +
                           ". Usually it was copied along. Remove the entry or "
                           "choose another type.");
    }



    template <int dim>
    void
    read_observed_body(const Section      &section,
                       const Problem<dim> &problem,
                       Observable<dim>    &observable)
    {
      std::vector<std::string> known;
      for (const Body<dim> &body : problem.bodies)
        known.push_back(body.name);

      observable.body = section.text("Body");
      if (!observable.body.empty())
        check_name("body", observable.body, known, section.where("Body"));
      else if (!section.is_empty("Location"))
        {
          if (known.size() > 1)
            throw InputError(
              "No body is named in " + section.where("Body") +
              ", but the scene has several: " + join(known, ", ") +
              ". A place alone does not tell whose point is "
              "meant. Write 'set Body = " +
              known.front() + "', for instance.");
          observable.body = known.front();
        }
    }



    template <int dim>
    void
    read_location(const Section              &section,
                  const GridDescription<dim> &grid,
                  Observable<dim>            &observable)
    {
      if (section.is_empty("Location"))
        return;
      observable.location = read_point<dim>(section, "Location");
      const BoxShape<dim> box(grid.lower, grid.upper);
      if (!box.contains(observable.location))
        throw InputError("The place " + to_text(observable.location) + " in " +
                         section.where("Location") +
                         " is outside the grid. Usually a coordinate is "
                         "mistyped. Give one from " +
                         to_text(grid.lower) + " to " + to_text(grid.upper) +
                         ".");
    }



    template <int dim>
    void
    read_direction(const Section &section, Observable<dim> &observable)
    {
      if (section.is_empty("Direction"))
        return;

      // [sign] axis, or two axes for a component of the stress.
      std::string word    = section.text("Direction");
      observable.positive = word.front() != '-';
      if (word.front() == '-' || word.front() == '+')
        word.erase(0, 1);
      const unsigned int letters = observable.kind->letters_of_direction;
      if (word.size() != letters)
        throw InputError(
          "The direction " + in_quotes(section.text("Direction")) + " in " +
          section.where("Direction") + " does not fit the type " +
          in_quotes(section.text("Type")) +
          ". A stress needs two letters, all else one. Write " +
          (letters == 2 ? "'xx'" : "'x'") + ", for instance.");
      observable.axis        = word.front() - 'x';
      observable.second_axis = word.back() - 'x';
    }



    template <int dim>
    void
    read_within(const Section              &section,
                const GridDescription<dim> &grid,
                Observable<dim>            &observable)
    {
      if (section.is_empty("Within"))
        return;
      const auto   texts = split(section.text("Within"), ';');
      Corners<dim> box;
      for (unsigned int d = 0; d < dim; ++d)
        {
          box.first[d]  = to_number(split(texts[0], ',')[d]).value();
          box.second[d] = to_number(split(texts[1], ',')[d]).value();
        }
      for (unsigned int d = 0; d < dim; ++d)
        if (box.second[d] <= box.first[d])
          throw InputError("The box ends at " + to_text(box.second) +
                           ", not beyond its lower corner " +
                           to_text(box.first) + ", in " +
                           section.where("Within") +
                           ". Usually the corners are swapped. Give the lower "
                           "corner first, then the upper one.");
      for (unsigned int d = 0; d < dim; ++d)
        if (box.second[d] < grid.lower[d] || box.first[d] > grid.upper[d])
          throw InputError(
            "The box from " + to_text(box.first) + " to " +
            to_text(box.second) + " in " + section.where("Within") +
            " is outside the grid, where nothing can be. "
            "Usually a coordinate is mistyped. Give one that "
            "meets the grid, from " +
            to_text(grid.lower) + " to " + to_text(grid.upper) + ".");
      observable.within = box;
    }



    template <int dim>
    void
    read_variable(const Section      &section,
                  const Problem<dim> &problem,
                  Observable<dim>    &observable)
    {
      if (section.is_empty("Variable"))
        return;
      if (observable.body.empty())
        {
          if (problem.bodies.size() > 1)
            throw InputError("No body is named in " + section.where("Body") +
                             ", but the scene has several, and the name of a "
                             "variable belongs to the material of one. Write "
                             "'set Body = " +
                             problem.bodies.front().name + "', for instance.");
          observable.body = problem.bodies.front().name;
        }
      const auto body      = std::find_if(problem.bodies.begin(),
                                     problem.bodies.end(),
                                     [&](const Body<dim> &candidate) {
                                       return candidate.name == observable.body;
                                     });
      const auto variables = variables_of(body->law, body->material);
      while (observable.variable < variables.size() &&
             variables[observable.variable].name != section.text("Variable"))
        ++observable.variable;
      if (observable.variable == variables.size())
        throw InputError("The variable " + in_quotes(section.text("Variable")) +
                         " in " + section.where("Variable") +
                         " is none of the material " + in_quotes(body->law) +
                         " of body " + in_quotes(body->name) +
                         ". Usually the material was changed. Remove the "
                         "observable, or name another body.");
    }



    template <int dim>
    void
    read_observed_obstacle(const Section      &section,
                           const Problem<dim> &problem,
                           Observable<dim>    &observable)
    {
      if (section.is_empty("Obstacle"))
        return;
      if (problem.obstacles.empty())
        throw InputError("The obstacle " + in_quotes(section.text("Obstacle")) +
                         " in " + section.where("Obstacle") +
                         " is none, as the scene has no obstacles. Name them "
                         "in the list 'Obstacles'.");
      std::vector<std::string> known;
      for (const Obstacle<dim> &obstacle : problem.obstacles)
        known.push_back(obstacle.name);
      check_name("obstacle",
                 section.text("Obstacle"),
                 known,
                 section.where("Obstacle"));
      observable.obstacle =
        std::find(known.begin(), known.end(), section.text("Obstacle")) -
        known.begin();
    }



    template <int dim>
    Observable<dim>
    read_observable(const Section      &section,
                    const std::string  &name,
                    const Problem<dim> &problem)
    {
      Observable<dim> observable;
      observable.name = name;
      observable.kind = &observable_kind<dim>(section.required_text("Type"));
      check_entries(section, *observable.kind);
      read_observed_body(section, problem, observable);
      read_location(section, problem.grid, observable);
      read_direction(section, observable);
      read_within(section, problem.grid, observable);
      read_variable(section, problem, observable);
      read_observed_obstacle(section, problem, observable);
      observable.unit = observable.kind->unit;
      if (!section.is_empty("Share beyond"))
        observable.share_beyond = section.number("Share beyond");
      observable.observable = section.text("Observable");
      if (!section.is_empty("From time"))
        observable.from_time = section.number("From time");
      if (!section.is_empty("Side"))
        observable.side = side_index(section.text("Side"));
      return observable;
    }



    /**
     * A column over time (frequency, mean ...) is that of an observable that is
     * none itself, and has its unit. Notes where rows may be too rare to
     * resolve zero crossings: implicit steps are as long as the motion allows,
     * explicit ones a hundred times shorter.
     */
    template <int dim>
    void
    check_columns(const Section &root, Problem<dim> &problem)
    {
      const std::vector<std::string> names = root.list("Observables");
      for (Observable<dim> &observable : problem.observables)
        {
          if (observable.kind->looks_at != ObservedPart::column)
            continue;
          const std::string where =
            root.subsection("Observable " + observable.name)
              .where("Observable");
          check_name("observable", observable.observable, names, where);
          const auto of =
            std::find(names.begin(), names.end(), observable.observable) -
            names.begin();
          if (problem.observables[of].kind->looks_at == ObservedPart::column)
            throw InputError("The observable " + in_quotes(observable.name) +
                             ", a " + in_quotes(observable.kind->word) +
                             ", is taken of " +
                             in_quotes(observable.observable) +
                             ", itself taken of another one, in " + where +
                             ". Name one that the material has at each time, "
                             "for instance a displacement.");
          if (observable.unit.empty())
            observable.unit = problem.observables[of].unit;
          if (observable.kind->word != "frequency")
            continue;

          const unsigned int interval = problem.output.statistics_interval;
          if (problem.method.integration != TimeIntegration::explicit_steps &&
              interval > 1)
            problem.notes.push_back(
              "Observable " + in_quotes(observable.name) +
              " is taken from one row in " + std::to_string(interval) +
              " steps; implicit steps are long, and swings shorter than " +
              std::to_string(4 * interval) +
              " of them give a wrong frequency. Usually set "
              "'Output/Statistics interval = 1'.");
        }
    }
  } // namespace



  namespace
  {
    /** Notes where the point that will be followed is far from the place. */
    template <int dim>
    void
    look_at_location(const Observable<dim> &observable, Problem<dim> &problem)
    {
      for (const Body<dim> &body : problem.bodies)
        if (body.name == observable.body)
          {
            const Corners<dim> box  = body.shape->bounding_box();
            double             edge = 0, squares = 0;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double x      = observable.location[d],
                             beyond = std::max(
                               {0., box.first[d] - x, x - box.second[d]});
                squares += beyond * beyond;
                edge = std::max(edge, problem.grid.edge(d));
              }
            if (const double distance = std::sqrt(squares); distance > edge)
              problem.notes.push_back(
                "Observable " + in_quotes(observable.name) + ": " +
                to_text(observable.location) + " is " + brief(distance) +
                " m off body " + in_quotes(body.name) +
                "; its nearest point is followed.");
          }
    }
  } // namespace



  template <int dim>
  void
  read_observables(const Section &root, Problem<dim> &problem)
  {
    for (const std::string &name : root.list("Observables"))
      {
        const Section section = root.subsection("Observable " + name);
        problem.observables.push_back(read_observable(section, name, problem));
        if (!section.is_empty("Location"))
          look_at_location(problem.observables.back(), problem);
      }
    check_columns(root, problem);
  }



  template void
  read_observables<2>(const Section &, Problem<2> &);
  template void
  read_observables<3>(const Section &, Problem<3> &);
} // namespace limber
