// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_image_h
#define limber_problem_image_h

#include <limber/base/input_file.h>
#include <limber/problem/from_file.h>
#include <limber/problem/shape.h>

#include <algorithm>
#include <array>
#include <vector>

namespace limber
{
  /**
   * Which pixels or voxels of a lattice have a value in an interval, both ends
   * included: along x first, then y, then z.
   */
  template <int dim>
  struct Voxels
  {
    double                        lower = 0, upper = 0; // of the interval
    std::array<unsigned int, dim> n{};
    std::vector<bool>             filled;
    double                        least = 0, largest = 0; // of all values

    /** Once the size is known. */
    void
    start(const std::array<unsigned int, dim> &size);

    void
    set(const std::size_t i, const double value)
    {
      filled[i] = lower <= value && value <= upper;
      least     = std::min(least, value);
      largest   = std::max(largest, value);
    }
  };



  /**
   * A grey image in the format PGM, as text (P2) or bytes (P5, one or two of
   * them each): its first row is at the top, that of the voxels at the bottom.
   * Throws InputError with what is wrong: other formats, a count that the file
   * does not hold, values beyond the largest one.
   */
  void
  read_pgm(const InputFile &file, Voxels<2> &voxels);



  /** Whether a file begins as a PNG does. */
  bool
  is_png(const InputFile &file);

  /**
   * An image in the format PNG, its first row at the top: the luminance of its
   * colours, as if it lay upon white, from 0 to 255, or to 65535 where the file
   * has 16 bits. Throws InputError where libpng cannot read it, or if it has
   * more than 1e8 pixels.
   */
  void
  read_png(const InputFile &file, Voxels<2> &voxels);



  /** What the bytes of a file without a header mean. */
  template <int dim>
  struct RawFormat
  {
    std::array<unsigned int, dim> n{};
    std::string                   type;       // "uint8", "uint16", ...
    bool                          big_first;  // order of bytes in a number
    std::size_t                   header = 0; // bytes to leave out
  };

  /** The words for a type of numbers. */
  std::vector<std::string>
  raw_types();

  /** Throws InputError unless the file has as many bytes as that takes. */
  template <int dim>
  void
  read_raw(const InputFile      &file,
           const RawFormat<dim> &format,
           Voxels<dim>          &voxels);



  /**
   * The pixels or voxels of an image whose values lie in an interval, both ends
   * included. Several bodies may take different values of one file.
   */
  template <int dim>
  class ImageShape : public Shape<dim>, public FromFile
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "image", *section = "Image";
    static constexpr const char *text =
      "pixels or voxels of a file with values in an interval";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    /**
     * @p lower corner and @p edge of a voxel in m; one at least is filled.
     */
    ImageShape(const Voxels<dim>             &voxels,
               const dealii::Point<dim>      &lower,
               const std::array<double, dim> &edge,
               const std::string             &checksum);

    bool
    contains(const dealii::Point<dim> &point) const override;

    /** Around the filled voxels. */
    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    const std::array<unsigned int, dim> n;
    const std::vector<bool>             filled;
    const dealii::Point<dim>            lower;
    const std::array<double, dim>       edge;
    Corners<dim>                        box;
    double                              volume;
  };
} // namespace limber

#endif
