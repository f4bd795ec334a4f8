// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/parameters.h>
#include <limber/base/text.h>

#include <algorithm>
#include <cctype>

namespace limber
{
  /**
   * @file Entries that a word beside them leaves without effect: the modulus
   * of 'Neo hookean' where 'Material' is 'j2'. Where the word was not even
   * given it was forgotten, and the scene is another one than its author
   * believes.
   */

  const Declaration *
  Parameters::what_chooses(const SectionPath &section, std::string &word) const
  {
    if (section.empty())
      return nullptr;
    const SectionPath around(section.begin(), section.end() - 1);
    word = section.back();
    std::transform(word.begin(), word.end(), word.begin(), [](const char c) {
      return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    const auto found =
      std::find_if(declarations.begin(),
                   declarations.end(),
                   [&](const Declaration &declaration) {
                     return declaration.section == around &&
                            declaration.admissible.is_choice() &&
                            declaration.admissible.match(word);
                   });
    return found == declarations.end() ? nullptr : &*found;
  }



  void
  Parameters::only_with(const std::string              &entry,
                        const std::vector<std::string> &words,
                        const std::string              &chooser,
                        const SectionPath              &section)
  {
    conditions.push_back({present, entry, section, chooser, words});
  }



  SectionPath
  Parameters::present_section() const
  {
    return present;
  }



  void
  Parameters::check_use()
  {
    const auto is_given = [&](const Declaration &declaration) {
      return places.count(to_text(declaration.section) +
                          (declaration.section.empty() ? "" : "/") +
                          declaration.name) > 0;
    };
    const auto judge = [&](const Declaration              &entry,
                           const std::string              &what,
                           const Declaration              &chooser,
                           const std::vector<std::string> &words) {
      const std::string chosen = value(chooser.section, chooser.name);
      if (std::find(words.begin(), words.end(), chosen) != words.end() ||
          !is_given(entry))
        return;
      if (!is_given(chooser))
        {
          std::string place = where(entry.section, entry.name);
          place[0]          = static_cast<char>(
            std::toupper(static_cast<unsigned char>(place[0])));
          throw InputError(
            place + ", has no effect: " + in_quotes(chooser.name) + " is " +
            in_quotes(chosen) +
            " where nothing else is said. Usually it was forgotten. Write "
            "'set " +
            chooser.name + " = " + words.front() + "'" +
            (chooser.section.empty() ?
               "" :
               " in section " + in_quotes(to_text(chooser.section))) +
            ".");
        }
      if (value(entry.section, entry.name) == entry.default_value)
        return; // as in a scene that gives all entries
      const std::string note = what + " has no effect, as " +
                               in_quotes(chooser.name) + " is " +
                               in_quotes(chosen) + ".";
      if (std::find(notes.begin(), notes.end(), note) == notes.end())
        notes.push_back(note);
    };

    for (const Declaration &entry : declarations)
      {
        std::string word;
        if (const Declaration *const chooser =
              what_chooses(entry.section, word))
          judge(entry,
                "Section " + in_quotes(to_text(entry.section)),
                *chooser,
                {word});
      }
    for (const Condition &condition : conditions)
      if (const Declaration &entry = *find(condition.section, condition.entry);
          !value(entry.section, entry.name).empty())
        judge(entry,
              in_quotes(entry.name) + " of section " +
                in_quotes(to_text(entry.section)),
              *find(condition.chooser_section, condition.chooser),
              condition.words);
  }
} // namespace limber
