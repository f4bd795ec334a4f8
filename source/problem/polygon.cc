// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/axis_ends.h>
#include <limber/problem/polygon.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;



  namespace
  {
    /** Reads closed loops of vertices, with the line of each vertex. */
    class LoopReader
    {
    public:
      LoopReader(const InputFile &file, const FilePlacement<2> &placement)
        : file(file)
        , placement(placement)
        , lines(file.bytes)
      {}

      ClosedPolygon
      read()
      {
        std::string_view line;
        while (lines.next(line))
          {
            const std::size_t remark = line.find('#');
            const auto        words  = words_of(line.substr(0, remark));
            if (!words.empty())
              add_vertex(words);
            else if (remark == std::string_view::npos)
              finish_loop();
          }
        finish_loop();
        if (edges.empty())
          throw InputError("The file " + file.name() +
                           " holds no vertex. Usually another file is meant. "
                           "Write a vertex into each line, two numbers with a "
                           "comma between them, and a blank line between "
                           "loops.");
        const ClosedPolygon result(edges);
        check(result);
        return result;
      }

    private:
      [[noreturn]] void
      refuse(const std::string &what,
             const std::size_t  line,
             const std::string &remedy) const
      {
        throw InputError(what + " in line " + std::to_string(line) +
                         " of the polygon " + file.name() + ". " + remedy);
      }

      void
      add_vertex(const std::vector<std::string_view> &words)
      {
        Point<2>   vertex;
        const bool first  = loop.empty() && edges.empty();
        bool       is_one = words.size() == 2;
        for (unsigned int d = 0; is_one && d < 2; ++d)
          is_one = is_number(words[d], vertex[d]);
        if (is_one)
          {
            const Point<2> place = placement(vertex);
            if (loop.empty() || loop.back().place != place)
              loop.push_back({place, lines.number});
            return;
          }
        double number;
        if (first && !has_header && words.size() == 2 &&
            !is_number(words[0], number) && !is_number(words[1], number))
          {
            has_header = true;
            return;
          }
        if (words.size() != 2)
          refuse("Instead of a vertex there " +
                   std::string(words.size() == 1 ? "is " : "are ") +
                   counted(words.size(), "word"),
                 lines.number,
                 "Usually the file has other columns. Write two numbers, x "
                 "and y, and nothing else.");
        refuse("The vertex " +
                 in_quotes(std::string(words[0]) + ", " +
                           std::string(words[1])) +
                 " is not of finite numbers",
               lines.number,
               "Usually a cell of a table was empty or divided by zero. Write "
               "two numbers, x and y.");
      }

      void
      finish_loop()
      {
        if (loop.empty())
          return;
        if (loop.size() > 1 && loop.front().place == loop.back().place)
          loop.pop_back();
        if (loop.size() < 3)
          refuse("A loop of " + std::to_string(loop.size()) +
                   (loop.size() == 1 ? " vertex" : " vertices") + " ends",
                 lines.number,
                 "Usually a blank line, which ends a loop, stands where none "
                 "should. Remove it, or give three vertices at least.");
        double area = 0, size = 0;
        for (std::size_t i = 1; i + 1 < loop.size(); ++i)
          {
            const auto a = loop[i].place - loop[0].place,
                       b = loop[i + 1].place - loop[0].place;
            area += std::abs(a[0] * b[1] - a[1] * b[0]);
            size = std::max({size, a.norm_square(), b.norm_square()});
          }
        if (!(area > 1e-12 * size)) // collinear
          refuse("A loop without area ends",
                 lines.number,
                 "Usually a column was copied twice. Write x and y of each "
                 "vertex.");
        for (std::size_t i = 0; i < loop.size(); ++i)
          {
            edges.push_back(
              {{loop[i].place, loop[(i + 1) % loop.size()].place}});
            lines_of_edges.push_back(loop[i].line);
          }
        loop.clear();
      }

      void
      check(const ClosedPolygon &polygon) const
      {
        if (const auto crossed = polygon.crossed_edges())
          {
            const std::size_t other = lines_of_edges[crossed->second];
            refuse("The edge from " + to_text(edges[crossed->first][0]) +
                     " to " + to_text(edges[crossed->first][1]) +
                     " meets the edge that begins in line " +
                     std::to_string(other) + ". The first begins",
                   lines_of_edges[crossed->first],
                   "Usually vertices are in a wrong order. Let edges not "
                   "cross.");
          }
      }

      struct Vertex
      {
        Point<2>    place;
        std::size_t line;
      };

      const InputFile                 &file;
      const FilePlacement<2>          &placement;
      TextLines                        lines;
      bool                             has_header = false;
      std::vector<Vertex>              loop;
      std::vector<ClosedPolygon::Edge> edges;
      std::vector<std::size_t>         lines_of_edges;
    };
  } // namespace



  ClosedPolygon
  read_polygon_text(const InputFile &file, const FilePlacement<2> &placement)
  {
    return LoopReader(file, placement).read();
  }



  template <int dim>
  PolygonShape<dim>::PolygonShape(const ClosedPolygon &polygon,
                                  const std::string   &checksum,
                                  const unsigned int   axis,
                                  const double         lower,
                                  const double         upper)
    : FromFile(checksum)
    , polygon(polygon)
    , axis(axis)
    , lower(lower)
    , upper(upper)
  {}



  template <int dim>
  bool
  PolygonShape<dim>::contains(const Point<dim> &point) const
  {
    if constexpr (dim == 2)
      return polygon.contains(point);
    else
      {
        const unsigned int first = axis == 0 ? 1 : 0, second = 3 - axis - first;
        return lower <= point[axis] && point[axis] <= upper &&
               polygon.contains(Point<2>(point[first], point[second]));
      }
  }



  template <int dim>
  Corners<dim>
  PolygonShape<dim>::bounding_box() const
  {
    const Corners<2> &plane = polygon.bounding_box();
    Corners<dim>      box;
    for (unsigned int d = 0, k = 0; d < dim; ++d)
      {
        box.first[d]  = d == axis ? lower : plane.first[k];
        box.second[d] = d == axis ? upper : plane.second[k];
        k += d == axis ? 0 : 1;
      }
    return box;
  }



  template <int dim>
  std::optional<double>
  PolygonShape<dim>::exact_volume() const
  {
    return polygon.area() * (dim == 2 ? 1 : upper - lower);
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  PolygonShape<dim>::signed_distance(const Point<dim> &point) const
  {
    const unsigned int first = axis < dim && axis == 0 ? 1 : 0;
    const unsigned int other = axis < dim && axis <= 1 ? 2 : 1;
    const auto in_plane = polygon.signed_distance({point[first], point[other]});
    SignedDistance<dim> result;
    result.value         = in_plane.value;
    result.normal[first] = in_plane.normal[0];
    result.normal[other] = in_plane.normal[1];
    return axis == dim ?
             result :
             distance_from_common_part(
               result, distance_from_slab(point, axis, lower, upper));
  }


  template <int dim>
  void
  PolygonShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("File",
                       "",
                       admissible::text("path of a text file", "outline.csv"),
                       "Text with a vertex in each line, two numbers, and a "
                       "blank line between loops; loops within a loop are "
                       "holes. Relative to the folder of the scene.");
    declare_file_placement<2>(parameters);
    if (dim == 2)
      return;
    parameters.declare("Axis",
                       "z",
                       admissible::one_of({"x", "y", "z"}),
                       "Direction along which the polygon is extruded; the "
                       "file has the other two coordinates, in the order of "
                       "x, y, z.");
    declare_axis_ends(parameters);
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  PolygonShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Section  &details = scene.details;
    const InputFile file =
      read_input_file(details.required_text("File"), details.where("File"));
    const ClosedPolygon polygon =
      read_polygon_text(file, read_file_placement<2>(details));
    if (dim == 2)
      return std::make_shared<PolygonShape<dim>>(polygon, file.checksum());
    const auto [lower, upper] = read_axis_ends(details, "extruded polygon");
    return std::make_shared<PolygonShape<dim>>(polygon,
                                               file.checksum(),
                                               details.text("Axis").front() -
                                                 'x',
                                               lower,
                                               upper);
  }



  template class PolygonShape<2>;
  template class PolygonShape<3>;
} // namespace limber
