// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** The contact law that a word stands for. */
    struct ContactKind
    {
      ContactLaw law;
      bool       rubs = false; // needs a friction coefficient
    };



    const Words<ContactKind> &
    contact_words()
    {
      static const Words<ContactKind> words = {
        {"stick",
         ContactKind{ContactLaw::stick},
         "they share the velocities of nodes, as bodies in no pair do"},
        {"slip",
         ContactKind{ContactLaw::separate},
         "they press on each other, slide and part"},
        {"friction",
         ContactKind{ContactLaw::separate, true},
         "the same with Coulomb friction"}};
      return words;
    }
  } // namespace



  const Words<std::string> &
  contact_law_words()
  {
    static const Words<std::string> words = without_values(contact_words());
    return words;
  }



  void
  declare_contact(Parameters &parameters, const std::vector<std::string> &pairs)
  {
    parameters.enter_subsection("Contact");
    parameters.declare_list("Pairs",
                            "",
                            "Pair ",
                            "Names of pairs of bodies that touch in a way of "
                            "their own; each has a section 'Pair NAME' within "
                            "'Contact'. All other bodies stick together where "
                            "they share nodes.");
    for (const std::string &name : pairs)
      {
        parameters.enter_subsection("Pair " + name);
        parameters.declare("Bodies",
                           "",
                           admissible::names("block, floor"),
                           "Names of two bodies, or of one that touches all "
                           "others so.");
        declare_word(parameters,
                     "Law",
                     "slip",
                     contact_words(),
                     "What they do where they touch.");
        parameters.declare(
          "Friction coefficient",
          "",
          admissible::non_negative_number("0.3").or_empty(),
          "Coulomb's coefficient mu, no unit, for 'friction'.");
        parameters.only_with("Friction coefficient",
                             {"friction"},
                             "Law",
                             parameters.present_section());
        parameters.leave_subsection();
      }
    parameters.leave_subsection();
  }



  namespace
  {
    template <int dim>
    unsigned int
    body_number(const Section      &section,
                const std::string  &name,
                const Problem<dim> &problem)
    {
      std::vector<std::string> known;
      for (const Body<dim> &body : problem.bodies)
        known.push_back(body.name);
      check_name("body", name, known, section.where("Bodies"));
      return std::find(known.begin(), known.end(), name) - known.begin();
    }



    /** The pairs of a section: several if it names one body only. */
    template <int dim>
    std::vector<ContactPair>
    read_pairs(const Section      &section,
               const std::string  &name,
               const Problem<dim> &problem)
    {
      const auto bodies = section.list("Bodies");
      if (bodies.size() != 1 &&
          (bodies.size() != 2 || bodies.front() == bodies.back()))
        throw InputError(
          "A pair needs two different bodies in " + section.where("Bodies") +
          ". A body does not touch itself. Write 'set Bodies = block, "
          "floor', with names of the list 'Bodies', or one name for all "
          "pairs of that body.");
      const ContactKind kind = read_word(section, "Law", contact_words());
      ContactPair       pair;
      pair.name      = name;
      pair.law       = kind.law;
      pair.bodies[0] = body_number(section, bodies[0], problem);
      if (kind.rubs)
        {
          if (section.is_empty("Friction coefficient"))
            throw InputError("The law 'friction' in " + section.where("Law") +
                             " lacks its 'Friction coefficient'. Write 'set "
                             "Friction coefficient = 0.3' beside it, or 'set "
                             "Law = slip' for bodies without friction.");
          pair.friction = section.number("Friction coefficient");
        }
      std::vector<ContactPair> result;
      for (unsigned int other = 0; other < problem.bodies.size(); ++other)
        if (bodies.size() == 1 ?
              other != pair.bodies[0] :
              other == body_number(section, bodies[1], problem))
          {
            pair.bodies[1] = other;
            result.push_back(pair);
          }
      return result;
    }



    bool
    are_the_same(const ContactPair &one, const ContactPair &other)
    {
      return std::is_permutation(one.bodies.begin(),
                                 one.bodies.end(),
                                 other.bodies.begin());
    }



    /**
     * Bodies that may separate from another one get velocity fields of their
     * own, all others share the first (multi-field contact).
     */
    template <int dim>
    void
    choose_fields(Problem<dim> &problem)
    {
      std::vector<bool> parts(problem.bodies.size(), false);
      for (const ContactPair &pair : problem.contacts)
        if (pair.law == ContactLaw::separate)
          for (const unsigned int body : pair.bodies)
            parts[body] = true;
      unsigned int next =
        std::find(parts.begin(), parts.end(), false) != parts.end() ? 1 : 0;
      for (unsigned int b = 0; b < parts.size(); ++b)
        if (parts[b])
          problem.bodies[b].nodal_field = next++;
    }



    [[noreturn]] void
    refuse(const Section     &section,
           const std::string &entry,
           const std::string &remedy)
    {
      throw InputError("Bodies that touch do not go with " +
                       in_quotes(section.text(entry)) + " in " +
                       section.where(entry) +
                       " yet. Usually a pair was added to a scene that had "
                       "none. Set " +
                       remedy + ", or leave 'Contact/Pairs' empty.");
    }



    template <int dim>
    void
    check_method(const Section &root, const Problem<dim> &problem)
    {
      const Section method = root.subsection("Method");
      if (problem.method.integration != TimeIntegration::explicit_steps)
        refuse(method, "Time integration", "'Time integration = explicit'");
      // two colliding balls would gain half of their energy
      if (problem.method.transfer == Transfer::apic)
        refuse(method, "Transfer", "'Transfer = aflip' or 'flip'");
    }



    /**
     * Notes two solids that are apart at the start and in no pair: nobody may
     * have meant them to stick together where they meet.
     */
    template <int dim>
    void
    look_at_bodies_in_no_pair(Problem<dim> &problem)
    {
      if (!problem.contacts.empty())
        return;
      for (const Body<dim> &first : problem.bodies)
        for (const Body<dim> &second : problem.bodies)
          {
            if (&first == &second)
              break;
            const Corners<dim> a = first.shape->bounding_box(),
                               b = second.shape->bounding_box();
            double gap           = 0; // in cells
            for (unsigned int d = 0; d < dim; ++d)
              gap = std::max(gap,
                             std::max(a.first[d] - b.second[d],
                                      b.first[d] - a.second[d]) /
                               problem.grid.edge(d));
            if (gap > 1e-6 && !first.is_liquid && !second.is_liquid)
              return problem.notes.push_back(
                "Bodies " + in_quotes(second.name) + " and " +
                in_quotes(first.name) +
                (gap < 2 ?
                   " are " + brief(gap) +
                     " cells apart and in no pair of 'Contact': nearer than "
                     "about two they share nodes, and stick together. " :
                   " are apart and in no pair of 'Contact': should they meet, "
                   "they stick together, from about two cells apart. ") +
                "'Contact/Pairs' makes them bounce, slide and part.");
          }
    }



    template <int dim>
    bool
    any_solids_part(const Problem<dim> &problem)
    {
      return std::any_of(problem.contacts.begin(),
                         problem.contacts.end(),
                         [&](const ContactPair &pair) {
                           return pair.law == ContactLaw::separate &&
                                  !problem.bodies[pair.bodies[0]].is_liquid &&
                                  !problem.bodies[pair.bodies[1]].is_liquid;
                         });
    }



    /** What goes wrong where solids touch at nodes (doc/theory/contact.md). */
    std::string
    trouble_at_nodes(const KernelKind kernel)
    {
      return has_domains(kernel) ?
               "round bodies touch over too wide a patch, with three quarters "
               "of the pressure." :
             kernel == KernelKind::ddmp ?
               "the stress in the middle of the contact of round bodies is up "
               "to two thirds too high." :
               "what rolls may lose a fifth of its momentum, and what is "
               "pressed creeps.";
    }
  } // namespace



  template <int dim>
  void
  read_contact(const Section &root, Problem<dim> &problem)
  {
    const Section section = root.subsection("Contact");
    for (const std::string &name : section.list("Pairs"))
      {
        const Section own = section.subsection("Pair " + name);
        for (const ContactPair &pair : read_pairs(own, name, problem))
          {
            for (const ContactPair &other : problem.contacts)
              if (are_the_same(pair, other))
                throw InputError("The pairs " + in_quotes(other.name) +
                                 " and " + in_quotes(name) + " in " +
                                 own.where("Bodies") +
                                 " have the same bodies. Usually a section was "
                                 "copied. Remove one of them from the list "
                                 "'Pairs'.");
            problem.contacts.push_back(pair);
          }
      }
    choose_fields(problem);
    look_at_bodies_in_no_pair(problem);
    if (std::all_of(problem.bodies.begin(),
                    problem.bodies.end(),
                    [](const auto &body) { return body.nodal_field == 0; }))
      return;
    check_method(root, problem);
    if (!is_spline(problem.grid.kernel) && any_solids_part(problem))
      problem.notes.push_back(
        "Solids touch at nodes, as functions are linear: " +
        trouble_at_nodes(problem.grid.kernel) + " " +
        (problem.grid.against_splines.empty() ?
           std::string("'Method/Kernel = quadratic' errs by 1 to 3 %.") :
           "Splines would be better, but " + problem.grid.against_splines +
             "."));
  }



  template void
  read_contact<2>(const Section &, Problem<2> &);
  template void
  read_contact<3>(const Section &, Problem<3> &);
} // namespace limber
