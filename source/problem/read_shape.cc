// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/file_shapes.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

namespace limber
{
  namespace
  {
    constexpr const char *union_word = "union";



    /** Call function(pointer) with a null pointer to each shape in turn. */
    template <class Function, class... OneShape>
    void
    for_each_shape(const std::tuple<OneShape...> *, const Function &function)
    {
      (function(static_cast<const OneShape *>(nullptr)), ...);
    }

    template <int dim, class Function>
    void
    for_each_shape(const Function &function)
    {
      for_each_shape(static_cast<const ShapeList<dim> *>(nullptr), function);
      for_each_shape(static_cast<const FileShapeList<dim> *>(nullptr),
                     function);
    }



    /** Shapes that may be a part of a union: those of the list. */
    Words<std::string>
    simple_shape_words()
    {
      Words<std::string> words;
      for_each_shape<2>([&](const auto *shape) {
        words.push_back({shape->word, shape->word, shape->text});
      });
      return words;
    }



    template <int dim>
    void
    declare_simple_shapes(Parameters &parameters)
    {
      for_each_shape<dim>([&](const auto *shape) {
        parameters.enter_subsection(shape->section);
        shape->declare(parameters);
        parameters.leave_subsection();
      });
    }



    void
    declare_simple_shapes(Parameters &parameters, const unsigned int dim)
    {
      if (dim == 2)
        declare_simple_shapes<2>(parameters);
      else
        declare_simple_shapes<3>(parameters);
    }
  } // namespace



  const Words<std::string> &
  shape_words()
  {
    static const Words<std::string> words = []() {
      auto result = simple_shape_words();
      result.push_back(
        {union_word, union_word, "all that is in one of several"});
      return result;
    }();
    return words;
  }



  void
  declare_shape(Parameters &parameters)
  {
    declare_word(parameters,
                 "Shape",
                 "box",
                 shape_words(),
                 "The region that is filled with points at the start; the "
                 "section of the same name holds the measures.");
  }



  void
  declare_shape_sections(Parameters                     &parameters,
                         const unsigned int              dim,
                         const std::vector<std::string> &union_parts)
  {
    declare_simple_shapes(parameters, dim);
    parameters.enter_subsection("Union");
    parameters.declare_list("Shapes",
                            "",
                            "Shape ",
                            "Names of the parts; each has a section 'Shape "
                            "NAME' within 'Union'.");
    for (const std::string &name : union_parts)
      {
        parameters.enter_subsection("Shape " + name);
        declare_word(parameters,
                     "Shape",
                     "box",
                     simple_shape_words(),
                     "The kind of this part.");
        declare_simple_shapes(parameters, dim);
        parameters.leave_subsection();
      }
    parameters.leave_subsection();
  }



  template <int dim>
  Corners<dim>
  read_corners(const Section &section, const Corners<dim> &default_box)
  {
    Corners<dim> box = default_box;
    if (!section.is_empty("Lower corner"))
      box.first = read_point<dim>(section, "Lower corner");
    if (!section.is_empty("Upper corner"))
      box.second = read_point<dim>(section, "Upper corner");
    for (unsigned int d = 0; d < dim; ++d)
      if (box.second[d] <= box.first[d])
        throw InputError("The box ends at " + to_text(box.second) +
                         ", not beyond its lower corner " + to_text(box.first) +
                         ", in " + section.where("Upper corner") +
                         ". Usually the corners are swapped. Increase every "
                         "component, for instance by 1.");
    return box;
  }



  namespace
  {
    template <int dim>
    std::shared_ptr<const Shape<dim>>
    read_union(const Section      &details,
               const Constants    &constants,
               const Corners<dim> &grid)
    {
      details.required_text("Shapes");
      std::vector<std::shared_ptr<const Shape<dim>>> parts;
      std::vector<std::string>                       checksums;
      for (const std::string &name : details.list("Shapes"))
        {
          parts.push_back(
            read_shape(details.subsection("Shape " + name), constants, grid));
          if (const auto *file =
                dynamic_cast<const FromFile *>(parts.back().get()))
            checksums.push_back(file->checksum);
        }
      if (checksums.empty())
        return std::make_shared<UnionShape<dim>>(parts);
      return std::make_shared<UnionFromFiles<dim>>(parts,
                                                   join(checksums, "; "));
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  read_shape(const Section      &section,
             const Constants    &constants,
             const Corners<dim> &grid)
  {
    const std::string word = read_word(section, "Shape", shape_words());
    if (word == union_word)
      return read_union(section.subsection("Union"), constants, grid);
    std::shared_ptr<const Shape<dim>> result;
    for_each_shape<dim>([&](const auto *shape) {
      if (word == shape->word)
        result = shape->read(
          {section, section.subsection(shape->section), constants, grid});
    });
    return result;
  }



  template std::shared_ptr<const Shape<2>>
  read_shape<2>(const Section &, const Constants &, const Corners<2> &);
  template std::shared_ptr<const Shape<3>>
  read_shape<3>(const Section &, const Constants &, const Corners<3> &);
  template Corners<2>
  read_corners<2>(const Section &, const Corners<2> &);
  template Corners<3>
  read_corners<3>(const Section &, const Corners<3> &);
} // namespace limber
