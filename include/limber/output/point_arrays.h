// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_point_arrays_h
#define limber_output_point_arrays_h

#include <limber/output/pictures.h>

#include <array>
#include <string>
#include <vector>

/**
 * @file Fields on disk, one array of doubles each, for other programs and for
 * comparison: "time", "initial place x", "displacement x", "velocity x",
 * "pressure", "stress xx", ... A material point keeps its initial place, so
 * two files are compared there. Points of a run and nodes of a finite element
 * reference have the same arrays.
 */
namespace limber
{
  /** What a file holds of one moment; per point, in any order. */
  template <int dim>
  struct PointArrays
  {
    double                              time = 0;               // s
    std::vector<dealii::Point<dim>>     place;                  // initial, m
    std::vector<dealii::Tensor<1, dim>> displacement, velocity; // m, m/s
    std::vector<double>                 pressure;               // Cauchy, Pa
    std::vector<std::array<double, 6>>  stress; // xx yy zz xy yz zx, Pa
    std::vector<double>                 mass;   // kg; of points only

    std::size_t
    size() const
    {
      return place.size();
    }
  };



  /** The arrays of all ranks; collective, throws FileError. */
  template <int dim>
  void
  write_point_arrays(const std::string      &path,
                     const PointArrays<dim> &own,
                     MPI_Comm                communicator);

  /** Throws FileError. For one rank. */
  template <int dim>
  PointArrays<dim>
  read_point_arrays(const std::string &path);

  /** Those of a picture with displacement, velocity, pressure, stress, mass. */
  template <int dim>
  PointArrays<dim>
  to_arrays(const Picture<0, dim> &picture, const double time);

  /**
   * Times (s) and paths of the files of a series in a run folder, "points" of
   * a run or "nodes" of a reference, ascending. Throws FileError.
   */
  std::vector<std::pair<double, std::string>>
  find_point_arrays(const std::string &folder, const std::string &series);
} // namespace limber

#endif
