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
    /** Shapes that may be a part of a union. */
    Words<ShapeKind>
    simple_shape_words()
    {
      Words<ShapeKind> words = shape_words();
      words.pop_back();
      return words;
    }



    Admissible
    point_entry(const unsigned int dim, const std::string &number)
    {
      return admissible::numbers(dim, for_each_direction(dim, number));
    }



    void
    declare_box(Parameters &parameters, const unsigned int dim)
    {
      parameters.enter_subsection("Box");
      parameters.declare("Lower corner",
                         for_each_direction(dim, "0"),
                         point_entry(dim, "0"),
                         "Corner with the smallest coordinates, m.");
      parameters.declare("Upper corner",
                         for_each_direction(dim, "1"),
                         point_entry(dim, "1"),
                         "The opposite corner, m.");
      parameters.leave_subsection();
    }



    void
    declare_ball(Parameters &parameters, const unsigned int dim)
    {
      parameters.enter_subsection("Ball");
      parameters.declare("Centre",
                         for_each_direction(dim, "0.5"),
                         point_entry(dim, "0.5"),
                         "Centre of the ball, m.");
      parameters.declare("Radius",
                         "0.25",
                         admissible::positive_number("0.25"),
                         "Radius R, m.");
      parameters.leave_subsection();
    }



    void
    declare_cylinder(Parameters &parameters, const unsigned int dim)
    {
      parameters.enter_subsection("Cylinder");
      parameters.declare("Axis",
                         "z",
                         admissible::one_of({"x", "y", "z"}),
                         "Direction of the axis.");
      parameters.declare("Centre",
                         for_each_direction(dim, "0.5"),
                         point_entry(dim, "0.5"),
                         "A point of the axis, m.");
      parameters.declare("Radius",
                         "0.25",
                         admissible::positive_number("0.25"),
                         "Radius R, m.");
      parameters.declare("Lower end",
                         "0",
                         admissible::number("0"),
                         "Coordinate along the axis where it begins, m.");
      parameters.declare("Upper end",
                         "1",
                         admissible::number("1"),
                         "Coordinate along the axis where it ends, m.");
      parameters.leave_subsection();
    }



    void
    declare_formula(Parameters &parameters, const unsigned int dim)
    {
      const std::string variables = dim == 2 ? "x, y" : "x, y, z";
      parameters.enter_subsection("Formula");
      parameters.declare("Inside",
                         "",
                         admissible::text("formula of " + variables +
                                            ", or empty",
                                          "1 - x^2 - y^2"),
                         "The shape is where this is positive.");
      for (const std::string corner : {"Lower corner", "Upper corner"})
        parameters.declare(corner,
                           "",
                           point_entry(dim, "0").or_empty(),
                           "Corner of a box around the shape, m; empty: that "
                           "of the grid.");
      parameters.leave_subsection();
    }



    /** "0, 0; 1, 0; 1, 1; 0, 1" */
    void
    declare_block(Parameters &parameters, const unsigned int dim)
    {
      const std::string square[] = {"0, 0", "1, 0", "1, 1", "0, 1"};
      const Admissible  corner   = point_entry(dim, "0");
      const std::size_t n        = 1 << dim;

      std::vector<std::string> unit;
      for (unsigned int i = 0; i < n; ++i)
        unit.push_back(square[i % 4] + (dim == 2 ? "" : i < 4 ? ", 0" : ", 1"));
      parameters.enter_subsection("Block");
      parameters.declare(
        "Corners",
        join(unit, "; "),
        Admissible(
          [=](const std::string &value) {
            const auto parts = split(value, ';');
            return parts.size() == n &&
                   std::all_of(parts.begin(),
                               parts.end(),
                               [&](const std::string &part) {
                                 return corner.match(part);
                               });
          },
          std::to_string(n) + " points of " + std::to_string(dim) +
            " numbers, separated by ';'",
          join(unit, "; ")),
        dim == 2 ?
          "Corners, m, counterclockwise. Face 'bottom' joins the first two, "
          "'right' the next, then 'top' and 'left'." :
          "Corners, m: those of face 'back', counterclockwise as seen from "
          "'front', then those of 'front' that are opposite to them. 'bottom' "
          "joins the first two, 'right' the next, then 'top' and 'left'.");
      parameters.leave_subsection();
    }



    void
    declare_simple_shapes(Parameters &parameters, const unsigned int dim)
    {
      declare_box(parameters, dim);
      declare_ball(parameters, dim);
      declare_cylinder(parameters, dim);
      declare_formula(parameters, dim);
      declare_block(parameters, dim);
    }
  } // namespace



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



  namespace
  {
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
                           ", not beyond its lower corner " +
                           to_text(box.first) + ", in " +
                           section.where("Upper corner") +
                           ". Usually the corners are swapped. Increase every "
                           "component, for instance by 1.");
      return box;
    }



    template <int dim>
    std::shared_ptr<const Shape<dim>>
    read_cylinder(const Section &shape, const Section &details)
    {
      if (dim == 2)
        throw InputError("A cylinder is asked for in " + shape.where("Shape") +
                         ", but the scene has two dimensions. Usually a disc "
                         "is meant. Write 'set Shape = ball' with its centre "
                         "and radius, or 'Dimension = 3'.");
      const double lower = details.number("Lower end");
      const double upper = details.number("Upper end");
      if (upper <= lower)
        throw InputError("The cylinder ends at " + to_text(upper) +
                         ", not beyond its beginning at " + to_text(lower) +
                         ", in " + details.where("Upper end") +
                         ". Usually the ends are swapped. Give " +
                         to_text(lower + 1) + ", for instance.");
      const unsigned int axis = details.text("Axis").front() - 'x';
      return std::make_shared<CylinderShape<dim>>(axis,
                                                  read_point<dim>(details,
                                                                  "Centre"),
                                                  details.number("Radius"),
                                                  lower,
                                                  upper);
    }



    template <int dim>
    std::shared_ptr<const Shape<dim>>
    read_block(const Section &details)
    {
      const auto texts = split(details.text("Corners"), ';');
      typename BlockShape<dim>::Vertices vertices;
      for (unsigned int i = 0; i < vertices.size(); ++i)
        // deal.II counts vertices along the axes, not around.
        for (unsigned int d = 0; d < dim; ++d)
          vertices[i % 4 < 2 ? i : i ^ 1][d] =
            to_number(split(texts[i], ',')[d]).value();

      const auto shape = std::make_shared<BlockShape<dim>>(vertices);
      for (unsigned int i = 0; i < vertices.size(); ++i)
        if (dealii::determinant(shape->jacobian(
              dealii::GeometryInfo<dim>::unit_cell_vertex(i))) <= 0)
          throw InputError("The block in " + details.where("Corners") +
                           " folds over at its corner " + to_text(vertices[i]) +
                           ". Usually the corners are in another order. Give "
                           "them counterclockwise, and none that points "
                           "inward.");
      return shape;
    }



    template <int dim>
    std::shared_ptr<const Shape<dim>>
    read_union(const Section      &details,
               const Constants    &constants,
               const Corners<dim> &grid)
    {
      details.required_text("Shapes");
      std::vector<std::shared_ptr<const Shape<dim>>> parts;
      for (const std::string &name : details.list("Shapes"))
        parts.push_back(
          read_shape(details.subsection("Shape " + name), constants, grid));
      return std::make_shared<UnionShape<dim>>(parts);
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  read_shape(const Section      &section,
             const Constants    &constants,
             const Corners<dim> &grid)
  {
    switch (read_word(section, "Shape", shape_words()))
      {
        case ShapeKind::box:
          {
            const auto box = read_corners(section.subsection("Box"), grid);
            return std::make_shared<BoxShape<dim>>(box.first, box.second);
          }
        case ShapeKind::ball:
          {
            const Section details = section.subsection("Ball");
            return std::make_shared<BallShape<dim>>(read_point<dim>(details,
                                                                    "Centre"),
                                                    details.number("Radius"));
          }
        case ShapeKind::cylinder:
          return read_cylinder<dim>(section, section.subsection("Cylinder"));
        case ShapeKind::formula:
          {
            const Section      details = section.subsection("Formula");
            const Corners<dim> box     = read_corners(details, grid);
            return std::make_shared<FormulaShape<dim>>(
              read_formula(details, "Inside", 1, constants, box), box);
          }
        case ShapeKind::block:
          return read_block<dim>(section.subsection("Block"));
        case ShapeKind::union_of_shapes:
          return read_union(section.subsection("Union"), constants, grid);
      }
    return nullptr; // every word of the list has its case above
  }



  template std::shared_ptr<const Shape<2>>
  read_shape<2>(const Section &, const Constants &, const Corners<2> &);
  template std::shared_ptr<const Shape<3>>
  read_shape<3>(const Section &, const Constants &, const Corners<3> &);
} // namespace limber
