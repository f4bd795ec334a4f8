// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/parameters.h>
#include <limber/base/text.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <set>

namespace limber
{
  namespace
  {
    std::string
    full_name(const SectionPath &section, const std::string &name)
    {
      return to_text(section) + (section.empty() ? "" : "/") + name;
    }



    std::string
    in_section(const SectionPath &section)
    {
      return section.empty() ? "at the top level" :
                               "in section " + in_quotes(to_text(section));
    }



    std::string
    place_of(const unsigned int line, const std::string &origin)
    {
      return line == 0 ?
               printable(origin) :
               "line " + std::to_string(line) + " of " + printable(origin);
    }



    /** The right-hand side, where @p text says 'full name = value'. */
    std::optional<std::string>
    assigned_value(const std::string &text, const std::string &full_name)
    {
      if (text.compare(0, full_name.size(), full_name) != 0)
        return std::nullopt;
      const std::string rest = trimmed(text.substr(full_name.size()));
      if (rest.empty() || rest.front() != '=')
        return std::nullopt;
      return trimmed(rest.substr(1));
    }



    /** 'section/name = value', cut at the given '='. */
    ScannedEntry
    assigned_entry(const std::string &text, const std::size_t equals)
    {
      ScannedEntry entry;
      entry.section = split(text.substr(0, equals), '/');
      entry.value   = trimmed(text.substr(equals + 1));
      if (!entry.section.empty())
        {
          entry.name = entry.section.back();
          entry.section.pop_back();
        }
      return entry;
    }



    /** What keeps a prm file from holding this value; empty: nothing. */
    std::string
    hindrance(const std::string &value)
    {
      if (value.find('#') != std::string::npos)
        return "'#', which begins a comment";
      if (!value.empty() && value.back() == '\\')
        return "a backslash at its end, which joins lines";
      for (std::size_t i = 0, n = 0; i < value.size(); i += n)
        {
          n = utf8_length(value, i);
          if (n == 0)
            return "a byte that is not UTF-8";
          if (is_control(value[i]) && value[i] != '\t')
            return "a control character";
        }
      return "";
    }



    /** Files of the run folder repeat the run, so they must hold its values. */
    void
    check_letters(const ScannedEntry &entry, const std::string &place)
    {
      const std::string found = hindrance(entry.value);
      if (!found.empty())
        throw InputError("The value " + in_quotes(entry.value) + " of entry " +
                         in_quotes(entry.name) + " " +
                         in_section(entry.section) + " (" + place + ") holds " +
                         found +
                         ". 'parameters.prm', which repeats a run, could not "
                         "hold it. Write it without, for instance with '_' or "
                         "'-' instead.");
    }



    /** Of a long list of choices the beginning, as messages must stay short. */
    std::string
    first_words(const std::string &text, const unsigned int most)
    {
      std::size_t end = 0;
      for (unsigned int word = 0; word < most && end != std::string::npos;
           ++word)
        end = text.find(' ', end + 1);
      return end == std::string::npos ? text : text.substr(0, end) + " ...";
    }



    /** Of the words of a field the entries whose texts speak of them. */
    std::vector<std::string>
    that_speak_of(const std::string                      &word,
                  const std::vector<const Declaration *> &declarations)
    {
      std::vector<std::string> result;
      for (const Declaration *const declaration : declarations)
        {
          std::string words = declaration->text;
          for (char &letter : words)
            if (std::strchr(",.;:()/'", letter) != nullptr)
              letter = ' ';
          if (!with_word(word, {words}).empty())
            result.push_back(declaration->name);
        }
      return result;
    }



    /** "'a', 'b' or 'c'" */
    std::string
    alternatives(const std::vector<std::string> &names)
    {
      std::string result;
      for (std::size_t i = 0; i < names.size(); ++i)
        result += (i == 0                ? "" :
                   i + 1 == names.size() ? " or " :
                                           ", ") +
                  in_quotes(names[i]);
      return result;
    }



    /** "Known there are a, b and c", unless these are too many to read. */
    std::string
    known_names(const std::vector<std::string> &names)
    {
      if (names.empty() || names.size() > 6)
        return "See all entries with 'limber --print-parameters prm'.";
      return "Known there: " + join(names, ", ") + ".";
    }
  } // namespace



  void
  Parameters::enter_subsection(const std::string &name)
  {
    handler.enter_subsection(name);
    present.push_back(name);
  }



  void
  Parameters::leave_subsection()
  {
    handler.leave_subsection();
    present.pop_back();
  }



  void
  Parameters::declare(const std::string &name,
                      const std::string &default_value,
                      const Admissible  &admissible,
                      const std::string &text)
  {
    handler.declare_entry(name,
                          default_value,
                          admissible,
                          text + " Range: " + admissible.description() + ".");
    declarations.push_back({present, name, default_value, admissible, text});
  }



  void
  Parameters::renamed(const std::string &former, const std::string &now)
  {
    successors[full_name(present, former)] = now;
  }



  void
  Parameters::declare_list(const std::string &list,
                           const std::string &default_value,
                           const std::string &prefix,
                           const std::string &text)
  {
    declare(list, default_value, admissible::names("first, second"), text);
    lists.push_back({present, list, prefix});
  }



  void
  Parameters::read(const Scan &scan, const std::vector<std::string> &overrides)
  {
    for (const ScannedSection &section : scan.sections)
      if (!is_declared(section.path))
        refuse_section(section.path, place_of(section.line, scan.origin));

    std::set<std::string> seen;
    for (const ScannedEntry &entry : scan.entries)
      {
        const std::string  place = place_of(entry.line, scan.origin);
        const Declaration *found = find(entry.section, entry.name);
        if (found == nullptr)
          refuse_entry(entry, place);
        set(*found, entry, place);
        if (!seen.insert(full_name(entry.section, entry.name)).second)
          notes.push_back("Entry " + in_quotes(entry.name) + " " +
                          in_section(entry.section) +
                          " is given more than once; " +
                          in_quotes(entry.value) + " counts (" + place + ").");
      }

    for (const std::string &override_text : overrides)
      read_override(override_text);
    check_use();
  }



  void
  Parameters::read_override(const std::string &override_text)
  {
    // Names may contain '=', so the declared ones decide where the value
    // begins.
    for (const Declaration &declaration : declarations)
      if (const auto value =
            assigned_value(override_text,
                           full_name(declaration.section, declaration.name)))
        return set(declaration,
                   {declaration.section, declaration.name, *value, 0},
                   "--set");

    if (override_text.find('=') == std::string::npos)
      throw InputError("The override " + in_quotes(override_text) +
                       " of --set on the command line has no '='. Usually "
                       "quotation marks are missing around it. Write --set "
                       "\"Method/Courant number=0.3\", for instance.");

    // Unknown; the '=' that was meant is rather one behind a known section.
    auto equals = override_text.find('=');
    for (auto next = equals; next != std::string::npos;
         next      = override_text.find('=', next + 1))
      {
             const ScannedEntry entry = assigned_entry(override_text, next);
             if (!entry.section.empty() && is_declared(entry.section))
          equals = next;
      }
    const ScannedEntry entry = assigned_entry(override_text, equals);
    if (is_declared(entry.section))
      refuse_entry(entry, "--set");
    refuse_section(entry.section, "--set");
  }



  namespace
  {
    /** The end of a message: the word that was meant, or cause and example. */
    std::string
    suggestion(const Declaration &declaration, const std::string &value)
    {
      const Admissible &admissible = declaration.admissible;
      const std::string shown      = first_words(admissible.description(), 20);
      const bool        is_cut     = shown != admissible.description();
      const std::string write = "Write " + shown, stop = is_cut ? "" : ".";
      if (const auto meant = admissible.meant(value))
        return write + stop + " Did you mean " + in_quotes(*meant) + "?";
      const std::string example = admissible.match(declaration.default_value) &&
                                      !declaration.default_value.empty() &&
                                      admissible.is_choice() ?
                                    declaration.default_value :
                                    admissible.example();
      // a long list of choices is an example of itself
      if (admissible.is_choice() &&
          first_words(shown, 14) != admissible.description())
        return "Usually a word is mistyped. " + write + stop;
      return "Usually a digit, sign or word is mistyped. " + write +
             ", for instance " + in_quotes(first_words(example, 8)) + ".";
    }
  } // namespace



  void
  Parameters::set(const Declaration  &declaration,
                  const ScannedEntry &entry,
                  const std::string  &place)
  {
    check_letters(entry, place);
    if (const std::string now = declaration.admissible.successor(entry.value);
        !now.empty())
      throw InputError("The value " + in_quotes(entry.value) + " of entry " +
                       in_quotes(entry.name) + " " + in_section(entry.section) +
                       " (" + place + ") is called " + in_quotes(now) +
                       " now. Usually the scene was written for a former "
                       "version. Write '" +
                       entry.name + " = " + now + "'.");
    if (!declaration.admissible.match(entry.value))
      throw InputError(
        "The value " + in_quotes(first_words(entry.value, 6)) + " of entry " +
        in_quotes(entry.name) + " " + in_section(entry.section) + " (" + place +
        ") is not admissible. " + suggestion(declaration, entry.value));

    for (const std::string &name : entry.section)
      handler.enter_subsection(name);
    handler.set(entry.name, entry.value);
    for (std::size_t i = 0; i < entry.section.size(); ++i)
      handler.leave_subsection();
    places[full_name(entry.section, entry.name)] = place;
  }



  void
  Parameters::refuse_section(const SectionPath &path,
                             const std::string &place) const
  {
    // The outermost unknown one is what the user got wrong.
    SectionPath outer = path;
    while (!outer.empty() &&
           !is_declared(SectionPath(outer.begin(), outer.end() - 1)))
      outer.pop_back();
    const std::string name = outer.back();
    outer.pop_back();

    const std::string start = "Section " + in_quotes(name) + " " +
                              in_section(outer) + " (" + place + ") ";
    for (const NameList &list : lists)
      if (list.section == outer &&
          name.compare(0, list.prefix.size(), list.prefix) == 0)
        {
          std::vector<std::string> known;
          for (const Declaration &declaration : declarations)
            if (declaration.section.size() > outer.size() &&
                std::equal(outer.begin(),
                           outer.end(),
                           declaration.section.begin()) &&
                declaration.section[outer.size()].compare(0,
                                                          list.prefix.size(),
                                                          list.prefix) == 0)
              known.push_back(declaration.section[outer.size()]);
          const auto meant = nearest(name, known);
          throw InputError(
            start + "belongs to no name in the list " + in_quotes(list.entry) +
            (meant ? ". Did you mean " + in_quotes(*meant) +
                       "? Otherwise write 'set " :
                     ". Usually it was forgotten there. Write 'set ") +
            list.entry + " = " +
            printable(trimmed(name.substr(list.prefix.size()))) +
            "', after any other names.");
        }

    std::vector<std::string> siblings;
    std::string              elsewhere;
    for (const Declaration &declaration : declarations)
      for (std::size_t i = 0; i < declaration.section.size(); ++i)
        {
          const std::string &candidate = declaration.section[i];
          const SectionPath  around(declaration.section.begin(),
                                   declaration.section.begin() + i);
          if (around == outer)
            siblings.push_back(candidate);
          else if (candidate == name && elsewhere.empty())
            elsewhere = in_section(around);
        }
    siblings.erase(std::unique(siblings.begin(), siblings.end()),
                   siblings.end());
    const auto meant = nearest(name, siblings);
    throw InputError(
      start + "is not known. Usually the name is misspelt or an 'end' is " +
      "missing or misplaced. " +
      (elsewhere.empty() ? "" : "It exists " + elsewhere + ". ") +
      (meant ? "Did you mean " + in_quotes(*meant) + "?" :
               known_names(siblings)));
  }



  void
  Parameters::refuse_entry(const ScannedEntry &entry,
                           const std::string  &place) const
  {
    const auto now = successors.find(full_name(entry.section, entry.name));
    if (now != successors.end())
      throw InputError("Entry " + in_quotes(entry.name) + " " +
                       in_section(entry.section) + " (" + place +
                       ") is called " + in_quotes(now->second) +
                       " now. Usually the scene was written for a former "
                       "version. Write '" +
                       now->second + "'.");

    // What says that a section is not in use: "'Material' is 'j2'." of 'Linear
    // elastic'; empty where it is, or nothing chooses it.
    const auto what_chooses_another = [&](const SectionPath &section) {
      std::string       word;
      const auto *const chooser = what_chooses(section, word);
      if (chooser == nullptr)
        return std::string();
      const std::string chosen = value(chooser->section, chooser->name);
      return chosen == word ?
               std::string() :
               in_quotes(chooser->name) + " is " + in_quotes(chosen) + ".";
    };

    // Sections that a word beside them has not chosen, as 'Linear elastic'
    // where the material is another one, are no place to move an entry to; but
    // those within the section that it stands in tell what was meant.
    const auto is_within = [&](const SectionPath &section) {
      return section.size() > entry.section.size() &&
             std::equal(entry.section.begin(),
                        entry.section.end(),
                        section.begin());
    };
    std::vector<std::string>         siblings, elsewhere;
    std::vector<const Declaration *> beside;
    std::string                      not_chosen;
    bool                             is_here = false;
    for (const Declaration &declaration : declarations)
      if (declaration.section == entry.section)
        {
          siblings.push_back(declaration.name);
          beside.push_back(&declaration);
        }
      else if (declaration.name == entry.name)
        {
          const std::string but = what_chooses_another(declaration.section);
          if (but.empty())
            elsewhere.push_back(in_section(declaration.section));
          else if (not_chosen.empty() ||
                   (!is_here && is_within(declaration.section)))
            {
              is_here    = is_within(declaration.section);
              not_chosen = "It belongs to " +
                           in_quotes(is_here ? declaration.section.back() :
                                               to_text(declaration.section)) +
                           ", but " + but;
            }
        }
    if (is_here)
      elsewhere.clear();

    constexpr std::size_t    many    = 4; // too many to be meant
    const auto               meant   = nearest(entry.name, siblings);
    std::vector<std::string> perhaps = with_word(entry.name, siblings);
    if (perhaps.empty() && elsewhere.empty())
      perhaps = that_speak_of(entry.name, beside);
    if (meant)
      perhaps = {*meant};
    else if (perhaps.size() >= many)
      perhaps.clear();
    const std::string exists =
      elsewhere.empty() || (!meant && !perhaps.empty()) ?
        "" :
        "It exists " + elsewhere.front() +
          (elsewhere.size() > 1 ? ", for instance. " : ". ");
    throw InputError(
      "Entry " + in_quotes(entry.name) + " " + in_section(entry.section) +
      " (" + place + ") is not known. Usually it is misspelt or in the wrong " +
      "section. " + exists +
      (!perhaps.empty()      ? "Did you mean " + alternatives(perhaps) + "?" :
       elsewhere.size() == 1 ? "Move it there." :
       elsewhere.size() > 1  ? "Write it where it is meant." :
       !not_chosen.empty()   ? not_chosen :
                               known_names(siblings)));
  }



  const Declaration *
  Parameters::find(const SectionPath &section, const std::string &name) const
  {
    const auto found = std::find_if(declarations.begin(),
                                    declarations.end(),
                                    [&](const Declaration &declaration) {
                                      return declaration.section == section &&
                                             declaration.name == name;
                                    });
    return found == declarations.end() ? nullptr : &*found;
  }



  bool
  Parameters::is_declared(const SectionPath &section) const
  {
    return std::any_of(declarations.begin(),
                       declarations.end(),
                       [&](const Declaration &declaration) {
                         const SectionPath &other = declaration.section;
                         return other.size() >= section.size() &&
                                std::equal(section.begin(),
                                           section.end(),
                                           other.begin());
                       });
  }



  std::string
  Parameters::value(const SectionPath &section, const std::string &name) const
  {
    return trimmed(section.empty() ? handler.get(name) :
                                     handler.get(section, name));
  }



  std::vector<std::pair<std::string, std::string>>
  Parameters::entries() const
  {
    std::vector<std::pair<std::string, std::string>> result;
    for (const Declaration &declaration : declarations)
      result.emplace_back(full_name(declaration.section, declaration.name),
                          value(declaration.section, declaration.name));
    return result;
  }



  std::string
  Parameters::where(const SectionPath &section, const std::string &name) const
  {
    const auto place = places.find(full_name(section, name));
    return (section.empty() ? "" :
                              "section " + in_quotes(to_text(section)) + ", ") +
           "entry " + in_quotes(name) +
           (place == places.end() ? "" : " (" + place->second + ")");
  }



  Section
  Parameters::root() const
  {
    return Section(*this, {});
  }



  const std::vector<std::string> &
  Parameters::warnings() const
  {
    return notes;
  }



  std::string
  scanned_value(const Scan                     &scan,
                const std::vector<std::string> &overrides,
                const SectionPath              &section,
                const std::string              &name,
                const std::string              &default_value)
  {
    std::string result = scan.last_value(section, name).value_or(default_value);
    for (const std::string &override_text : overrides)
      if (const auto value =
            assigned_value(override_text, full_name(section, name)))
        result = *value;
    return result;
  }
} // namespace limber
