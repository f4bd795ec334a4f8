// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

namespace limber
{
  template <int dim>
  void
  check_initial_frame(const Section   &section,
                      const Section   &root,
                      const Body<dim> &body)
  {
    const auto refuse = [&](const std::string &cause,
                            const std::string &remedy) {
      throw InputError("The frame 'initial' in " + section.where("Frame") +
                       " " + cause + ". Set 'Frame = current'" + remedy + ".");
    };

    if (!read_word(section, "Material", law_words()).is_elastic)
      refuse("needs a stress that follows from the deformation alone, which "
             "the material " +
               in_quotes(section.text("Material")) + " does not have",
             ", or an elastic material, for instance 'neo hookean'");
    if (body.treatment != Projection::none &&
        body.treatment != Projection::cell &&
        body.treatment != Projection::assumed_strain)
      refuse("has no locking treatment " +
               in_quotes(section.text("Locking treatment")),
             ", or 'Locking treatment = assumed strain', 'cell' or 'none'");
    if (body.hourglass_control > 0)
      refuse("leaves no motion of a cell without resistance, so that "
             "'Hourglass control' has nothing to do",
             ", or 'Hourglass control = 0'");
    if (body.chequerboard_control > 0)
      refuse("has no chequerboard control", ", or 'Chequerboard control = 0'");
    if (body.history != HistoryTreatment::keep ||
        body.deviatoric_history != HistoryTreatment::keep)
      refuse("has no histories that could scatter: the stress follows from "
             "the deformation",
             ", or 'History = keep' and 'Deviatoric history = keep'");
    if (read_word(root.subsection("Method"),
                  "Stress update",
                  stress_update_words()) == StressUpdateOrder::first)
      refuse("does not go with 'Method/Stress update = first'",
             ", or 'Stress update = last, remapped'");
    if (root.list("Bodies").size() > 1)
      refuse("is for a scene of one body: it would not notice that it meets "
             "another one",
             "");
  }



  template void
  check_initial_frame(const Section &, const Section &, const Body<2> &);
  template void
  check_initial_frame(const Section &, const Section &, const Body<3> &);
} // namespace limber
