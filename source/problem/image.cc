// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/image.h>
#include <limber/problem/read_parts.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;



  namespace
  {
    template <int dim>
    std::array<unsigned int, dim>
    index_of(std::size_t i, const std::array<unsigned int, dim> &n)
    {
      std::array<unsigned int, dim> index;
      for (unsigned int d = 0; d < dim; ++d)
        {
          index[d] = i % n[d];
          i /= n[d];
        }
      return index;
    }
  } // namespace



  template <int dim>
  ImageShape<dim>::ImageShape(const Voxels<dim>             &voxels,
                              const Point<dim>              &lower,
                              const std::array<double, dim> &edge,
                              const std::string             &checksum)
    : FromFile(checksum)
    , n(voxels.n)
    , filled(voxels.filled)
    , lower(lower)
    , edge(edge)
    , volume(std::count(filled.begin(), filled.end(), true))
  {
    std::array<unsigned int, dim> first = n, last{};
    for (std::size_t i = 0; i < filled.size(); ++i)
      if (filled[i])
        {
          const auto index = index_of<dim>(i, n);
          for (unsigned int d = 0; d < dim; ++d)
            {
              first[d] = std::min(first[d], index[d]);
              last[d]  = std::max(last[d], index[d] + 1);
            }
        }
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.first[d]  = lower[d] + first[d] * edge[d];
        box.second[d] = lower[d] + last[d] * edge[d];
        volume *= edge[d];
      }
  }



  template <int dim>
  bool
  ImageShape<dim>::contains(const Point<dim> &point) const
  {
    std::size_t i = 0;
    for (int d = dim - 1; d >= 0; --d)
      {
        if (point[d] < box.first[d] || point[d] > box.second[d])
          return false;
        i = i * n[d] +
            std::size_t(
              std::clamp((point[d] - lower[d]) / edge[d], 0., n[d] - 1.));
      }
    return filled[i];
  }



  template <int dim>
  Corners<dim>
  ImageShape<dim>::bounding_box() const
  {
    return box;
  }



  template <int dim>
  std::optional<double>
  ImageShape<dim>::exact_volume() const
  {
    return volume;
  }



  template <int dim>
  void
  ImageShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare(
      "File",
      "",
      admissible::text("path of an image", "slice.pgm"),
      "Image in the format PNG or PGM (only in two dimensions), "
      "or raw numbers, along x first, then y, then z, from "
      "the lower corner. Relative to the folder of the "
      "scene.");
    parameters.declare("Values",
                       "128, 255",
                       admissible::numbers(2, "128, 255"),
                       "Least and largest value of what is filled, both "
                       "included, no unit. Other bodies may take other values "
                       "of the same file.");
    parameters.declare("Lower corner",
                       for_each_direction(dim, "0"),
                       admissible::numbers(dim, for_each_direction(dim, "0")),
                       "Where the image begins, its lower left corner, m.");
    parameters.declare("Pixel edge",
                       "0.01",
                       admissible::text("a number greater than 0, or " +
                                          std::to_string(dim),
                                        "0.01"),
                       "Edge of a pixel or voxel, m; for all directions or for "
                       "each.");
    parameters.declare(
      "Size",
      "",
      admissible::positive_integers(dim,
                                    false,
                                    dim == 2 ? "640, 480" : "100, 100, 80")
        .or_empty(),
      "Of raw numbers: how many there are in each direction. Empty: PNG or "
      "PGM.");
    parameters.declare("Number type",
                       "uint8",
                       admissible::one_of(raw_types()),
                       "Of raw numbers: their type.");
    parameters.declare("Byte order",
                       "little",
                       admissible::one_of({"little", "big"}),
                       "Of raw numbers: which byte of a number comes first, "
                       "its lowest (little) or its highest one.");
    parameters.declare("Header bytes",
                       "0",
                       admissible::non_negative_integer("352"),
                       "Of raw numbers: bytes in front of them, which are left "
                       "out.");
  }



  namespace
  {
    template <int dim>
    Voxels<dim>
    read_voxels(const Section &details, const InputFile &file)
    {
      const auto  interval = details.numbers("Values");
      Voxels<dim> voxels;
      voxels.lower = interval[0];
      voxels.upper = interval[1];
      if (!details.is_empty("Size"))
        {
          RawFormat<dim> format;
          const auto     n = details.numbers("Size");
          std::copy(n.begin(), n.end(), format.n.begin());
          format.type      = details.text("Number type");
          format.big_first = details.text("Byte order") == "big";
          format.header    = details.number("Header bytes");
          read_raw<dim>(file, format, voxels);
        }
      else if constexpr (dim == 2)
        is_png(file) ? read_png(file, voxels) : read_pgm(file, voxels);
      else
        throw InputError("The voxels of " + file.name() +
                         " have no size: " + details.where("Size") +
                         " is empty. In three dimensions the file holds raw "
                         "numbers. Say how many there are in each direction, "
                         "for instance '100, 100, 80'.");
      if (std::find(voxels.filled.begin(), voxels.filled.end(), true) ==
          voxels.filled.end())
        throw InputError("The image " + file.name() + " has no value from " +
                         brief(interval[0]) + " to " + brief(interval[1]) +
                         " (" + details.where("Values") + "), only from " +
                         brief(voxels.least) + " to " + brief(voxels.largest) +
                         ". Give an interval that holds some of its values.");
      return voxels;
    }



    template <int dim>
    std::array<double, dim>
    read_edges(const Section &details)
    {
      const std::string   entry = "Pixel edge";
      std::vector<double> edges;
      bool                good = true;
      for (const std::string &part : split(details.required_text(entry), ','))
        {
          const auto number = to_number(part);
          good              = good && number && *number > 0;
          edges.push_back(number.value_or(0));
        }
      if (!good || (edges.size() != 1 && edges.size() != dim))
        throw InputError("The edge " + in_quotes(details.text(entry)) + " in " +
                         details.where(entry) +
                         " is not one positive number or " +
                         std::to_string(dim) +
                         " of them. Usually a digit is mistyped. Write 0.01, "
                         "for instance.");
      std::array<double, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = edges[edges.size() == 1 ? 0 : d];
      return result;
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  ImageShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Section  &details = scene.details;
    const InputFile file =
      read_input_file(details.required_text("File"), details.where("File"));
    const auto edges = read_edges<dim>(details);
    return std::make_shared<ImageShape<dim>>(read_voxels<dim>(details, file),
                                             read_point<dim>(details,
                                                             "Lower corner"),
                                             edges,
                                             file.checksum());
  }



  template class ImageShape<2>;
  template class ImageShape<3>;
} // namespace limber
