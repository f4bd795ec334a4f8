// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/stl.h>

#include <cmath>
#include <cstring>

namespace limber
{
  using dealii::Point;

  namespace
  {
    using Corners3 = std::array<Point<3>, 3>;



    /** Facets of a file, and how messages call them. */
    struct StlFacets
    {
      std::vector<Corners3>    corners;
      std::vector<std::size_t> lines; // of ASCII files: where each begins

      /** "Facet 12 (line 84)" */
      std::string
      name(const std::size_t facet) const
      {
        return "Facet " + std::to_string(facet + 1) +
               (lines.empty() ? "" :
                                " (line " + std::to_string(lines[facet]) + ")");
      }
    };



    [[noreturn]] void
    refuse_stl(const InputFile   &file,
               const std::string &what,
               const std::string &remedy)
    {
      throw InputError(what + " of the STL file " + file.name() + " " + remedy);
    }



    constexpr std::size_t header = 84, facet_size = 50; // bytes

    std::uint32_t
    number_at(const InputFile &file, const std::size_t byte)
    {
      const auto *b =
        reinterpret_cast<const unsigned char *>(file.bytes.data()) + byte;
      return b[0] | b[1] << 8 | b[2] << 16 | std::uint32_t(b[3]) << 24;
    }



    StlFacets
    read_binary(const InputFile &file)
    {
      StlFacets         result;
      const std::size_t n = number_at(file, header - 4);
      result.corners.resize(n);
      for (std::size_t f = 0; f < n; ++f)
        for (unsigned int i = 0; i < 9; ++i)
          {
            const std::uint32_t bits =
              number_at(file, header + f * facet_size + 12 + 4 * i);
            float value;
            std::memcpy(&value, &bits, sizeof(value));
            if (!std::isfinite(value))
              refuse_stl(file,
                         result.name(f),
                         "has a coordinate that is not finite. Usually the CAD "
                         "program failed there. Repair the part, or export it "
                         "anew.");
            result.corners[f][i / 3][i % 3] = value;
          }
      return result;
    }



    /** Takes the words of an ASCII file in their fixed order. */
    class AsciiReader
    {
    public:
      explicit AsciiReader(const InputFile &file)
        : file(file)
        , lines(file.bytes)
      {}

      StlFacets
      read()
      {
        while (next_line())
          {
            if (begins_with("solid") || begins_with("endsolid"))
              continue;
            expect("facet");
            const std::size_t line = lines.number;
            next_of_facet("outer");
            Corners3 corners;
            for (Point<3> &corner : corners)
              {
                next_of_facet("vertex");
                corner = read_corner();
              }
            next_of_facet("endloop");
            next_of_facet("endfacet");
            result.corners.push_back(corners);
            result.lines.push_back(line);
          }
        return result;
      }

    private:
      /** The next one with words in it. */
      bool
      next_line()
      {
        std::string_view line;
        while (lines.next(line))
          if (words = words_of(line, ""); !words.empty())
            return true;
        return false;
      }

      /** Some programs write them in capitals. */
      bool
      begins_with(const std::string &word) const
      {
        return lower_case(std::string(words[0])) == word;
      }

      void
      next_of_facet(const std::string &word)
      {
        if (!next_line())
          throw InputError("The STL file " + file.name() +
                           " ends within facet " +
                           std::to_string(result.corners.size() + 1) +
                           ", before " + in_quotes(word) +
                           ". Usually it was cut off while it was copied. "
                           "Export it anew.");
        expect(word);
      }

      void
      expect(const std::string &word) const
      {
        if (!begins_with(word))
          throw InputError("Line " + std::to_string(lines.number) +
                           " of the STL file " + file.name() + " begins with " +
                           in_quotes(std::string(words[0])) + " instead of " +
                           in_quotes(word) +
                           ". Usually the file was edited, or has facets of "
                           "four corners. Export triangles.");
      }

      Point<3>
      read_corner() const
      {
        Point<3> corner;
        bool     finite = words.size() == 4;
        for (unsigned int d = 0; finite && d < 3; ++d)
          finite = is_number(words[d + 1], corner[d]);
        if (!finite)
          throw InputError("Line " + std::to_string(lines.number) +
                           " of the STL file " + file.name() +
                           " has no three finite coordinates behind 'vertex'. "
                           "Usually the CAD program failed there. Repair the "
                           "part, or export it anew.");
        return corner;
      }

      const InputFile              &file;
      TextLines                     lines;
      std::vector<std::string_view> words;
      StlFacets                     result;
    };



    StlFacets
    read_facets(const InputFile &file)
    {
      const std::string &bytes = file.bytes;
      if (bytes.size() >= header &&
          bytes.size() ==
            header + std::size_t(number_at(file, header - 4)) * facet_size)
        return read_binary(file);
      const std::size_t first   = bytes.find_first_not_of(" \t\r\n");
      const bool        is_text = bytes.find('\0') == std::string::npos;
      if (first != std::string::npos && is_text &&
          lower_case(bytes.substr(first, 5)) == "solid")
        return AsciiReader(file).read();
      throw InputError(
        "The file " + file.name() + " is no STL: it is no text that begins " +
        "with 'solid', and its " + std::to_string(bytes.size()) +
        " bytes are not those of " +
        (bytes.size() >= header ?
           std::to_string(number_at(file, header - 4)) + " binary facets" :
           "any binary facets") +
        ". Usually it was cut off or has another format. Export it as STL.");
    }



    double
    size_of(const std::vector<Corners3> &facets)
    {
      Corners<3> box(facets[0][0], facets[0][0]);
      for (const Corners3 &corners : facets)
        for (const Point<3> &corner : corners)
          for (unsigned int d = 0; d < 3; ++d)
            {
              box.first[d]  = std::min(box.first[d], corner[d]);
              box.second[d] = std::max(box.second[d], corner[d]);
            }
      return box.first.distance(box.second);
    }



    void
    refuse_flat_facets(const InputFile    &file,
                       const StlFacets    &facets,
                       const TriangleMesh &mesh)
    {
      for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
          const auto &[a, b, c] = mesh.facets[f];
          const auto  &corners  = mesh.corners;
          const double longest =
            std::max({corners[a].distance_square(corners[b]),
                      corners[b].distance_square(corners[c]),
                      corners[c].distance_square(corners[a])});
          if (a == b || b == c || c == a ||
              mesh.normal(f).norm() <= 1e-12 * longest)
            refuse_stl(
              file,
              facets.name(f),
              "at " + to_text(facets.corners[f][0]) +
                " has no area. Usually the part was exported too "
                "coarsely. Export it more finely, or remove the facet in "
                "a mesh program, closing the gap.");
        }
    }



    void
    refuse_faults(const InputFile    &file,
                  const StlFacets    &facets,
                  const TriangleMesh &mesh)
    {
      const auto fault = find_fault(mesh);
      if (!fault)
        return;
      const auto brief_place = [](const Point<3> &place) {
        return "(" + brief(place[0]) + ", " + brief(place[1]) + ", " +
               brief(place[2]) + ")";
      };
      const std::string edge =
        brief_place(fault->edge[0]) + " to " + brief_place(fault->edge[1]);
      const std::string all =
        fault->n_edges == 1 ?
          "" :
          ", one of " + std::to_string(fault->n_edges) + " such edges";
      if (fault->kind == SurfaceFault::Kind::open)
        refuse_stl(
          file,
          facets.name(fault->facet),
          "has an open edge, " + edge + all +
            ". Usually a hole was left. Close it in the CAD program, or "
            "in MeshLab.");
      refuse_stl(file,
                 facets.name(fault->facet) + " or facet " +
                   std::to_string(fault->other_facet + 1),
                 "is flipped: both run alike along " + edge + all +
                   ". Orient all alike, for instance in MeshLab.");
    }
  } // namespace



  TriangleMesh
  read_stl_text(const InputFile &file, const FilePlacement<3> &placement)
  {
    const StlFacets facets = read_facets(file);
    if (facets.corners.empty())
      throw InputError("The STL file " + file.name() +
                       " holds no facet. Usually nothing was selected when it "
                       "was exported. Select the part and export it anew.");
    constexpr double same_corner = 1e-6;
    const double     size        = size_of(facets.corners);
    if (!(size > 0))
      refuse_stl(file,
                 facets.name(0),
                 "and all others have their corners in one place. Usually the "
                 "unit of the export was too large. Export the part in "
                 "millimetres.");
    TriangleMesh mesh = welded(facets.corners, same_corner * size);
    refuse_flat_facets(file, facets, mesh);
    refuse_faults(file, facets, mesh);
    drop_repeated_facets(mesh);
    for (Point<3> &corner : mesh.corners)
      corner = placement(corner);
    return mesh;
  }



  template <int dim>
  StlShape<dim>::StlShape(const ClosedSurface &surface,
                          const std::string   &checksum)
    : FromFile(checksum)
    , surface(surface)
  {}



  template <int dim>
  bool
  StlShape<dim>::contains(const Point<dim> &point) const
  {
    if constexpr (dim == 3)
      return surface.contains(point);
    else
      return false;
  }



  template <int dim>
  Corners<dim>
  StlShape<dim>::bounding_box() const
  {
    Corners<dim> box;
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.first[d]  = surface.bounding_box().first[d];
        box.second[d] = surface.bounding_box().second[d];
      }
    return box;
  }



  template <int dim>
  std::optional<double>
  StlShape<dim>::exact_volume() const
  {
    return surface.volume();
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  StlShape<dim>::signed_distance([[maybe_unused]] const Point<dim> &point) const
  {
    if constexpr (dim == 3)
      return surface.signed_distance(point);
    else
      return std::nullopt;
  }



  template <int dim>
  void
  StlShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("File",
                       "",
                       admissible::text("path of an STL file", "bracket.stl"),
                       "Closed surface of triangles, binary or ASCII. Relative "
                       "to the folder of the scene.");
    declare_file_placement<3>(parameters);
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  StlShape<dim>::read(const ShapeSections<dim> &scene)
  {
    if (dim == 2)
      throw InputError("A surface of triangles is asked for in " +
                       scene.owner.where("Shape") +
                       ", but the scene has two dimensions. Write 'set Shape = "
                       "polygon' with a file of vertices, or 'Dimension = 3'.");
    const Section  &details = scene.details;
    const InputFile file =
      read_input_file(details.required_text("File"), details.where("File"));
    const ClosedSurface surface(
      read_stl_text(file, read_file_placement<3>(details)));
    return std::make_shared<StlShape<dim>>(surface, file.checksum());
  }



  template class StlShape<2>;
  template class StlShape<3>;
} // namespace limber
