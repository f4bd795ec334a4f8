// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/parameters.h>
#include <limber/base/text.h>

namespace limber
{
  Section::Section(const Parameters &parameters, const SectionPath &path)
    : parameters(&parameters)
    , path(path)
  {}



  Section
  Section::subsection(const std::string &name) const
  {
    SectionPath inner = path;
    inner.push_back(name);
    return Section(*parameters, inner);
  }



  Section
  Section::root() const
  {
    return parameters->root();
  }



  bool
  Section::has_entry(const std::string &entry) const
  {
    return parameters->find(path, entry) != nullptr;
  }



  bool
  Section::is_empty(const std::string &entry) const
  {
    return text(entry).empty();
  }



  std::string
  Section::text(const std::string &entry) const
  {
    return parameters->value(path, entry);
  }



  std::string
  Section::required_text(const std::string &entry) const
  {
    const std::string result = text(entry);
    if (result.empty())
      throw InputError("A value is missing in " + where(entry) +
                       ". It has no default, because only you can know it. "
                       "Give it, for instance 'set " +
                       entry + " = " +
                       parameters->find(path, entry)->admissible.example() +
                       "'.");
    return result;
  }



  double
  Section::number(const std::string &entry) const
  {
    return to_number(required_text(entry)).value();
  }



  bool
  Section::flag(const std::string &entry) const
  {
    return text(entry) == "true";
  }



  std::vector<std::string>
  Section::list(const std::string &entry) const
  {
    return split(text(entry), ',');
  }



  std::vector<double>
  Section::numbers(const std::string &entry) const
  {
    std::vector<double> result;
    for (const std::string &part : split(required_text(entry), ','))
      result.push_back(to_number(part).value());
    return result;
  }



  std::string
  Section::where(const std::string &entry) const
  {
    return parameters->where(path, entry);
  }
} // namespace limber
