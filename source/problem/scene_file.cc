// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/read_problem.h>

#include <algorithm>
#include <filesystem>

namespace limber
{
  namespace
  {
    /**
     * Names become sections of the scene and of --set, columns of tables and
     * fields of pictures. Refuses letters that one of these cannot hold.
     */
    void
    check_name_form(const std::string &name,
                    const std::string &list,
                    const std::string &origin)
    {
      constexpr std::size_t longest = 60; // letters
      const auto            bad =
        std::find_if(name.begin(), name.end(), [](const char letter) {
          return is_control(letter) ||
                 std::string("/\\#[]").find(letter) != std::string::npos;
        });
      bool is_text = true;
      for (std::size_t i = 0, n = 0; i < name.size() && is_text; i += n)
        is_text = (n = utf8_length(name, i)) > 0;
      if (bad == name.end() && name.size() <= longest && is_text)
        return;
      throw InputError("The name " + in_quotes(name) + " in the list " +
                       in_quotes(list) + " of " + printable(origin) +
                       (bad != name.end() ?
                          " holds " + in_quotes(std::string(1, *bad)) :
                        is_text ? " is longer than 60 letters" :
                                  " is not UTF-8") +
                       ". Names head sections, columns and fields. Write "
                       "letters, digits, blanks and signs like '-', '_' or "
                       "'&' only.");
    }



    /** Finds the names in a scene before anything is declared. */
    class NameReader
    {
    public:
      NameReader(const Scan &scan, const std::vector<std::string> &overrides)
        : scan(scan)
        , overrides(overrides)
      {}

      /** The names in a list; each must have its section beside it. */
      std::vector<std::string>
      names(const SectionPath &section,
            const std::string &list,
            const std::string &prefix) const
      {
        const auto names =
          split(scanned_value(scan, overrides, section, list, ""), ',');
        for (auto name = names.begin(); name != names.end(); ++name)
          {
            if (std::find(names.begin(), name, *name) != name)
              throw InputError(
                "The name " + in_quotes(*name) + " stands twice in the list " +
                in_quotes(list) + " of " + printable(scan.origin) +
                ". Usually a line was copied. Remove one or "
                "call it " +
                in_quotes(*name + " 2") + ", with a section of its own.");
            check_name_form(*name, list, scan.origin);
            check_section(section, list, prefix + *name);
          }
        return names;
      }

      unsigned int
      dimension() const
      {
        const std::string text =
          scanned_value(scan, overrides, {}, "Dimension", "2");
        if (text != "2" && text != "3")
          throw InputError("The value " + in_quotes(text) +
                           " of entry 'Dimension' in " +
                           printable(scan.origin) +
                           " is not admissible. Plane strain has 2 dimensions, "
                           "space has 3. Write 'set Dimension = 2'.");
        return text == "2" ? 2 : 3;
      }

    private:
      void
      check_section(const SectionPath &around,
                    const std::string &list,
                    const std::string &name) const
      {
        SectionPath path = around;
        path.push_back(name);
        // An empty name is refused later, by the range of the list.
        if (name.back() == ' ' || scan.has_section(path) || is_set(path))
          return;

        std::vector<std::string> present;
        for (const ScannedSection &section : scan.sections)
          if (section.path.size() == path.size())
            present.push_back(section.path.back());
        const auto meant = nearest(name, present);
        throw InputError(
          "There is no section " + in_quotes(to_text(path)) + " in " +
          printable(scan.origin) + ", but the list " + in_quotes(list) +
          " has its name. Usually one of them is misspelt. " +
          (meant ?
             "Did you mean " + in_quotes(*meant) + "?" :
             "Write 'subsection " + printable(name) + "', entries, 'end'."));
      }

      /** Whether the command line changes an entry of the section. */
      bool
      is_set(const SectionPath &path) const
      {
        const std::string start = to_text(path) + "/";
        return std::any_of(overrides.begin(),
                           overrides.end(),
                           [&](const std::string &text) {
                             return text.compare(0, start.size(), start) == 0;
                           });
      }

      const Scan                     &scan;
      const std::vector<std::string> &overrides;
    };



    SceneNames
    read_names(const NameReader &reader)
    {
      SceneNames result;
      result.bodies      = reader.names({}, "Bodies", "Body ");
      result.refinements = reader.names({"Grid"}, "Refine", "Refine ");
      result.face_loads  = reader.names({"Loads"}, "Face loads", "Face load ");
      result.contacts    = reader.names({"Contact"}, "Pairs", "Pair ");
      result.obstacles   = reader.names({}, "Obstacles", "Obstacle ");
      result.observables = reader.names({}, "Observables", "Observable ");
      result.checks      = reader.names({}, "Checks", "Check ");
      for (const std::string &body : result.bodies)
        result.shapes[body] =
          reader.names({"Body " + body, "Union"}, "Shapes", "Shape ");
      for (const std::string &obstacle : result.obstacles)
        result.obstacle_shapes[obstacle] =
          reader.names({"Obstacle " + obstacle, "Union"}, "Shapes", "Shape ");
      return result;
    }



    /**
     * Paths of files are relative to the folder of the scene. Absolute ones
     * mean the same in the run folder, where the entries are kept.
     */
    std::string
    path_from(const std::string &folder, const std::string &path)
    {
      namespace fs = std::filesystem;
      return path.empty() ? path :
                            fs::absolute(fs::path(folder) / path)
                              .lexically_normal()
                              .string();
    }



    /** Entries that are paths, in whatever section. */
    bool
    is_path(const std::string &entry)
    {
      return entry == "File" || entry == "Mesh file";
    }



    void
    make_paths_absolute(const std::string        &folder,
                        Scan                     &scan,
                        std::vector<std::string> &overrides)
    {
      for (ScannedEntry &entry : scan.entries)
        if (is_path(entry.name))
          entry.value = path_from(folder, entry.value);
      for (std::string &text : overrides) // Section/Name=value
        {
          const std::size_t equals = text.find('=');
          const std::size_t name   = text.rfind('/', equals);
          if (equals != std::string::npos && name < equals &&
              is_path(trimmed(text.substr(name + 1, equals - name - 1))))
            text = text.substr(0, equals + 1) +
                   path_from(folder, trimmed(text.substr(equals + 1)));
        }
    }



    void
    declare_top_level(Parameters &parameters)
    {
      parameters.declare("Dimension",
                         "2",
                         admissible::one_of({"2", "3"}),
                         "Two dimensions mean plane strain and unit "
                         "thickness.");
      parameters.declare("End time",
                         "1",
                         admissible::positive_number("1"),
                         "Time at which the run ends, s; it begins at 0.");
      parameters.declare("End step",
                         "0",
                         admissible::non_negative_integer("1000"),
                         "Number of steps after which the run ends if the time "
                         "has not come; 0: the time alone counts.");
      parameters.declare("Memory limit",
                         "auto",
                         admissible::positive_number("16").or_word("auto"),
                         "Memory that all ranks may take together, GB; a scene "
                         "that is estimated to need more is refused before it "
                         "is built. 'auto' is what the machine has.");
      declare_constants(parameters);
      parameters.declare_list("Bodies",
                              "",
                              "Body ",
                              "Names of the bodies; each has a section 'Body "
                              "NAME'.");
      parameters.declare_list("Observables",
                              "",
                              "Observable ",
                              "Names of columns added to the statistics; each "
                              "has a section 'Observable NAME'.");
      parameters.declare_list("Checks",
                              "",
                              "Check ",
                              "Names of comparisons with a reference; each has "
                              "a section 'Check NAME'.");
    }



    void
    declare_scene(Parameters        &parameters,
                  const unsigned int dim,
                  const SceneNames  &names)
    {
      declare_top_level(parameters);
      declare_bodies(parameters, dim, names);
      declare_grid(parameters, dim, names.refinements);
      declare_boundaries(parameters, dim);
      declare_loads(parameters, dim, names.face_loads);
      declare_contact(parameters, names.contacts);
      declare_obstacles(parameters, dim, names);
      declare_method(parameters);
      declare_output(parameters);
      declare_checkpoint(parameters);
      declare_reference(parameters, dim);
      declare_exact_solution(parameters, dim);
      declare_observables(parameters, dim, names.observables);
      declare_checks(parameters, names.checks);
    }
  } // namespace



  SceneFile::SceneFile(const std::string              &path,
                       const std::vector<std::string> &overrides)
    : SceneFile(read_parameter_text(path), overrides)
  {}



  SceneFile::SceneFile(const ParameterText            &text,
                       const std::vector<std::string> &given_overrides)
    : input(text)
  {
    Scan scan = scan_parameters(text.text, text.format, text.origin);
    if (scan.last_value({}, "Scene") && scan.last_value({}, "Methods"))
      throw InputError(in_quotes(text.origin) +
                       " is a study and no scene. Usually a word is missing. "
                       "Write 'limber study " +
                       text.origin + "'.");
    std::vector<std::string> overrides = given_overrides;
    make_paths_absolute(
      std::filesystem::path(text.origin).parent_path().string(),
      scan,
      overrides);
    const NameReader reader(scan, overrides);
    declare_scene(values, reader.dimension(), read_names(reader));
    values.read(scan, overrides);

    notes = values.warnings();
  }



  unsigned int
  SceneFile::dimension() const
  {
    return values.root().text("Dimension") == "2" ? 2 : 3;
  }



  const std::string &
  SceneFile::original_text() const
  {
    return input.text;
  }



  std::string
  SceneFile::original_name() const
  {
    return input.format == FileFormat::json ? "original.json" : "original.prm";
  }



  const Parameters &
  SceneFile::parameters() const
  {
    return values;
  }



  const std::vector<std::string> &
  SceneFile::warnings() const
  {
    return notes;
  }
} // namespace limber
