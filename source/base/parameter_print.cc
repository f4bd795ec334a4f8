// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/parameters.h>
#include <limber/base/text.h>

#include <ostream>
#include <set>

namespace limber
{
  namespace
  {
    /** Nested objects, written while one walks through the sections. */
    class JsonWriter
    {
    public:
      explicit JsonWriter(std::ostream &out)
        : out(out)
      {
        out << '{';
      }

      void
      move_to(const SectionPath &target)
      {
        std::size_t common = 0;
        while (common < path.size() && common < target.size() &&
               path[common] == target[common])
          ++common;
        while (path.size() > common)
          close();
        while (path.size() < target.size())
          {
            new_line();
            out << json_quoted(target[path.size()]) << ": {";
            first = true;
            path.push_back(target[path.size()]);
          }
      }

      void
      entry(const std::string &name, const std::string &value)
      {
        new_line();
        out << json_quoted(name) << ": " << json_quoted(value);
      }

      void
      finish()
      {
        move_to({});
        out << "\n}\n";
      }

    private:
      void
      new_line()
      {
        out << (first ? "\n" : ",\n") << std::string(2 * path.size() + 2, ' ');
        first = false;
      }

      void
      close()
      {
        path.pop_back();
        out << '\n' << std::string(2 * path.size() + 2, ' ') << '}';
        first = false;
      }

      std::ostream &out;
      SectionPath   path;
      bool          first = true;
    };



    /** In a cell of a Markdown table the bar would end the cell. */
    std::string
    table_cell(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        result += c == '|' ? std::string("\\|") : std::string(1, c);
      return result;
    }
  } // namespace



  void
  Parameters::print(std::ostream &out, const PrintStyle style) const
  {
    using dealii::ParameterHandler;
    switch (style)
      {
        case PrintStyle::prm:
          handler.print_parameters(out,
                                   ParameterHandler::OutputStyle(
                                     ParameterHandler::PRM |
                                     ParameterHandler::KeepDeclarationOrder));
          break;
        case PrintStyle::json:
          print_json(out);
          break;
        case PrintStyle::markdown:
          print_markdown(out);
          break;
      }
  }



  void
  Parameters::print_json(std::ostream &out) const
  {
    // deal.II's own JSON cuts names at dots. Sections must not come twice in
    // an object, so each is written as a whole where it first occurs.
    JsonWriter            writer(out);
    std::set<SectionPath> done;
    for (const Declaration &start : declarations)
      if (done.insert(start.section).second)
        {
          writer.move_to(start.section);
          for (const Declaration &declaration : declarations)
            if (declaration.section == start.section)
              writer.entry(declaration.name,
                           value(declaration.section, declaration.name));
        }
    writer.finish();
  }



  void
  Parameters::print_markdown(std::ostream &out) const
  {
    std::set<SectionPath> done;
    for (const Declaration &start : declarations)
      if (done.insert(start.section).second)
        {
          out << (done.size() == 1 ? "" : "\n") << "## "
              << (start.section.empty() ? "Top level" : to_text(start.section))
              << "\n\n| entry | default | range | meaning |\n"
              << "| --- | --- | --- | --- |\n";
          for (const Declaration &declaration : declarations)
            if (declaration.section == start.section)
              out << "| " << table_cell(declaration.name) << " | "
                  << table_cell(declaration.default_value) << " | "
                  << table_cell(declaration.admissible.description()) << " | "
                  << table_cell(declaration.text) << " |\n";
        }
  }
} // namespace limber
