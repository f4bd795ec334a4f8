// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/exceptions.h>
#include <limber/base/parameter_scan.h>
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <utility>

namespace limber
{
  namespace
  {
    // Deeper than any scene; limits the recursion of the parser.
    constexpr std::size_t deepest = 16;



    std::string
    at_line(const std::size_t line, const std::string &origin)
    {
      return " (line " + std::to_string(line) + " of " + printable(origin) +
             ")";
    }



    [[noreturn]] void
    refuse_depth(const std::size_t line, const std::string &origin)
    {
      throw InputError("The sections are nested more than " +
                       std::to_string(deepest) + " deep" +
                       at_line(line, origin) +
                       ". Usually a closing 'end' or bracket is missing. Close "
                       "each section behind its entries; a scene needs 4 "
                       "levels at most.");
    }



    /** Characters that neither a text editor nor Python writes by itself. */
    void
    check_letters(const std::string &text, const std::string &origin)
    {
      std::size_t line = 1;
      for (const char letter : text)
        if (letter == '\n')
          ++line;
        else if (is_control(letter) && letter != '\t' && letter != '\r')
          throw InputError("There is the control character " +
                           in_quotes(std::string(1, letter)) +
                           at_line(line, origin) +
                           ". Usually the file is not a text or was damaged. "
                           "Remove the character; a scene holds letters, "
                           "blanks, tabs and line ends only.");
    }



    /** The prm language, line by line. */
    class PrmScanner
    {
    public:
      PrmScanner(const std::string &text, const std::string &origin)
        : input(text)
      {
        scan.origin = origin;
      }

      Scan
      run()
      {
        std::string statement;
        while (next_statement(statement))
          if (!statement.empty())
            take(statement);
        if (!path.empty())
          refuse("Section " + in_quotes(path.back()) + " is not closed",
                 "Usually an 'end' is missing. Write 'end' after the last "
                 "entry of this section.");
        return scan;
      }

    private:
      /** A line without its comment; a backslash at the end joins the next. */
      bool
      next_statement(std::string &statement)
      {
        statement.clear();
        std::string part;
        bool        continued = true;
        while (continued && std::getline(input, part))
          {
            ++line;
            part      = trimmed(part.substr(0, part.find('#')));
            continued = !part.empty() && part.back() == '\\';
            if (continued)
              part.pop_back();
            statement += part;
          }
        if (!input && statement.empty())
          return false;
        return true;
      }

      void
      take(const std::string &statement)
      {
        const std::string word =
          statement.substr(0, statement.find_first_of(" \t"));
        const std::string rest = trimmed(statement.substr(word.size()));
        if (word == "subsection" && !rest.empty())
          {
            if (path.size() == deepest)
              refuse_depth(line, scan.origin);
            path.push_back(rest);
            scan.sections.push_back({path, line});
          }
        else if (word == "end" && rest.empty())
          leave();
        else if (word == "set" && rest.find('=') != std::string::npos)
          {
            const auto equals = rest.find('=');
            scan.entries.push_back({path,
                                    trimmed(rest.substr(0, equals)),
                                    trimmed(rest.substr(equals + 1)),
                                    line});
          }
        else if (word == "include")
          refuse("The statement " + in_quotes(statement) + " is not supported",
                 "A scene is one file, so that it can be reproduced. Copy the "
                 "included lines to this place.");
        else
          refuse("The statement " + in_quotes(statement) + " is not understood",
                 "Usually 'set' or '=' is missing. Write 'set Name = value', "
                 "'subsection Name' or 'end'.");
      }

      void
      leave()
      {
        if (path.empty())
          refuse("There is an 'end' without a section",
                 "Usually a line 'subsection Name' was deleted or an 'end' "
                 "stands twice. Remove this 'end'.");
        path.pop_back();
      }

      [[noreturn]] void
      refuse(const std::string &what, const std::string &cause_and_remedy) const
      {
        throw InputError(what + at_line(line, scan.origin) + ". " +
                         cause_and_remedy);
      }

      std::istringstream input;
      Scan               scan;
      SectionPath        path;
      unsigned int       line = 0;
    };



    using Tree = boost::property_tree::ptree;

    /** JSON arrays have children without names. */
    bool
    is_array(const Tree &node)
    {
      return !node.empty() &&
             std::all_of(node.begin(), node.end(), [](const auto &child) {
               return child.first.empty();
             });
    }



    std::string
    comma_list(const Tree        &array,
               const std::string &name,
               const std::string &origin)
    {
      std::vector<std::string> values;
      for (const auto &child : array)
        {
          if (!child.second.empty())
            throw InputError("The array " + in_quotes(name) + " in " +
                             printable(origin) +
                             " holds an array or an object. Arrays stand for "
                             "lists of numbers or words. Write '[1, 2]', for "
                             "instance, and sections as objects with names.");
          values.push_back(child.second.data());
        }
      return join(values, ", ");
    }



    void
    scan_object(const Tree &object, const SectionPath &path, Scan &scan)
    {
      for (const auto &[name, node] : object)
        if (node.empty() || is_array(node))
          scan.entries.push_back(
            {path,
             trimmed(name),
             trimmed(node.empty() ? node.data() :
                                    comma_list(node, name, scan.origin)),
             0});
        else
          {
            SectionPath inner = path;
            inner.push_back(trimmed(name));
            scan.sections.push_back({inner, 0});
            scan_object(node, inner, scan);
          }
    }



    /** Limits the nesting of a text before recursive functions parse it. */
    void
    check_depth_of_json(const std::string &text, const std::string &origin)
    {
      std::size_t depth = 0, line = 1;
      bool        in_string = false;
      for (std::size_t i = 0; i < text.size(); ++i)
        {
          const char letter = text[i];
          if (letter == '\n')
            ++line;
          if (in_string && letter == '\\')
            ++i;
          else if (letter == '"')
            in_string = !in_string;
          else if (!in_string && (letter == '{' || letter == '['))
            {
              // a list in the innermost section in the whole file's object
              if (++depth > deepest + 2)
                refuse_depth(line, origin);
            }
          else if (!in_string && (letter == '}' || letter == ']') && depth > 0)
            --depth;
        }
    }



    Scan
    scan_json(const std::string &text, const std::string &origin)
    {
      check_depth_of_json(text, origin);
      Tree               tree;
      std::istringstream input(text);
      try
        {
          boost::property_tree::read_json(input, tree);
        }
      catch (const boost::property_tree::json_parser_error &error)
        {
          throw InputError("The file is not valid JSON: " + error.message() +
                           at_line(error.line(), origin) +
                           ". Usually a comma or quotation mark is missing, or "
                           "a comma stands before a closing bracket. "
                           "Write '\"End time\": \"1\"', for instance.");
        }
      Scan scan;
      scan.origin = origin;
      scan_object(tree, {}, scan);
      return scan;
    }



    /** Whether it worked, and the text. */
    std::pair<bool, std::string>
    read_stream(const std::string &path)
    {
      std::ostringstream text;
      if (path == "--")
        {
          text << std::cin.rdbuf();
          return {true, text.str()};
        }
      std::ifstream file(path);
      text << file.rdbuf();
      // A folder opens, but nothing can be read from it.
      return {file.is_open() && !text.str().empty(), text.str()};
    }
  } // namespace



  std::string
  to_text(const SectionPath &path)
  {
    return join(path, "/");
  }



  std::optional<std::string>
  Scan::last_value(const SectionPath &section, const std::string &name) const
  {
    const auto found =
      std::find_if(entries.rbegin(), entries.rend(), [&](const auto &entry) {
        return entry.section == section && entry.name == name;
      });
    if (found == entries.rend())
      return std::nullopt;
    return found->value;
  }



  bool
  Scan::has_section(const SectionPath &path) const
  {
    return std::any_of(sections.begin(),
                       sections.end(),
                       [&](const ScannedSection &section) {
                         return section.path == path;
                       });
  }



  Scan
  scan_parameters(const std::string &text,
                  const FileFormat   format,
                  const std::string &origin)
  {
    check_letters(text, origin);
    return format == FileFormat::json ? scan_json(text, origin) :
                                        PrmScanner(text, origin).run();
  }



  ParameterText
  read_parameter_text(const std::string &path)
  {
    const bool is_json =
      path.size() >= 5 && path.compare(path.size() - 5, 5, ".json") == 0;
    ParameterText result;
    result.format = is_json ? FileFormat::json : FileFormat::prm;
    result.origin = path == "--" ? "standard input" : path;

    std::pair<bool, std::string> read;
    const bool parallel = dealii::Utilities::MPI::job_supports_mpi();
    if (!parallel ||
        dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      read = read_stream(path);
    if (parallel)
      {
        read.first =
          dealii::Utilities::MPI::max(int(read.first), MPI_COMM_WORLD);
        read.second = broadcast_text(read.second, MPI_COMM_WORLD);
      }

    if (std::filesystem::is_directory(path))
      throw InputError(
        in_quotes(path) + " on the command line is a folder. " +
        (std::filesystem::exists(path + "/parameters.prm") ?
           "Usually a word is missing. Draw this run with 'limber plot " +
             path + "', or go on with it: 'limber " + path +
             "/parameters.prm --resume'." :
           "Usually the name of the file is missing. Give a scene or a "
           "study, for instance prm/dam_break.prm."));
    if (!read.first)
      throw InputError("The file " + in_quotes(result.origin) +
                       " cannot be read. Usually the path is misspelt or "
                       "relative to another folder. Give an existing, "
                       "non-empty scene or study, for instance "
                       "prm/dam_break.prm.");
    result.text = std::move(read.second);
    return result;
  }
} // namespace limber
