// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/problem/file_placement.h>
#include <limber/problem/read_parts.h>

#include <cmath>

namespace limber
{
  namespace
  {
    /** Rotation in the plane of the axes a and b, from a to b, by degrees. */
    template <int dim>
    dealii::Tensor<2, dim>
    turn(const unsigned int a, const unsigned int b, const double degrees)
    {
      // exact for quarters of a turn, so that sides stay along the axes
      const double angle    = degrees * dealii::numbers::PI / 180;
      const bool   quarters = std::fmod(degrees, 90.) == 0;
      const double c = quarters ? std::round(std::cos(angle)) : std::cos(angle);
      const double s = quarters ? std::round(std::sin(angle)) : std::sin(angle);
      dealii::Tensor<2, dim> result = dealii::unit_symmetric_tensor<dim>();
      result[a][a] = result[b][b] = c;
      result[b][a]                = s;
      result[a][b]                = -s;
      return result;
    }
  } // namespace



  template <int dim>
  void
  declare_file_placement(Parameters &parameters)
  {
    parameters.declare("Scale",
                       "1",
                       admissible::positive_number("0.001"),
                       "Factor on the places in the file, no unit; 0.001 for "
                       "millimetres.");
    parameters.declare("Rotation",
                       dim == 2 ? "0" : "0, 0, 0",
                       dim == 2 ? admissible::number("90") :
                                  admissible::numbers(3, "90, 0, 0"),
                       dim == 2 ?
                         "Angle about the origin of the file after scaling, "
                         "degrees, anticlockwise." :
                         "Angles about the axes x, y and z through the origin "
                         "of the file, one after the other, after scaling, "
                         "degrees.");
    parameters.declare("Translation",
                       for_each_direction(dim, "0"),
                       admissible::numbers(dim, for_each_direction(dim, "0.5")),
                       "Shift after scaling and rotation, m.");
  }



  template <int dim>
  FilePlacement<dim>
  read_file_placement(const Section &section)
  {
    const std::vector<double> angles = section.numbers("Rotation");
    FilePlacement<dim>        result;
    result.scale = section.number("Scale");
    result.shift = read_point<dim>(section, "Translation");
    if (dim == 2)
      result.rotation = turn<dim>(0, 1, angles[0]);
    else
      for (unsigned int axis = 0; axis < 3; ++axis)
        result.rotation =
          turn<dim>((axis + 1) % dim, (axis + 2) % dim, angles[axis]) *
          result.rotation;
    return result;
  }



  template void
  declare_file_placement<2>(Parameters &);
  template void
  declare_file_placement<3>(Parameters &);
  template FilePlacement<2>
  read_file_placement<2>(const Section &);
  template FilePlacement<3>
  read_file_placement<3>(const Section &);
} // namespace limber
