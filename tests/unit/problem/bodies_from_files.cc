// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/points/seeding.h>
#include <limber/points/shape_volume.h>
#include <limber/problem/file_shapes.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <png.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/triangles.h"

/** @file Scenes whose bodies come from images, point lists and other files. */

using namespace limber;
using dealii::Point;
using dealii::numbers::PI;

namespace
{
  /** A folder with a file, and scenes beside it. */
  class FolderWithFile
  {
  public:
    explicit FolderWithFile(const std::string &bytes)
      : folder(std::filesystem::temp_directory_path() /
               ("limber_files_" + std::to_string(getpid())))
    {
      std::filesystem::create_directories(folder);
      write(bytes);
    }

    ~FolderWithFile()
    {
      std::filesystem::remove_all(folder);
    }

    void
    write(const std::string &bytes) const
    {
      std::ofstream(folder / "data", std::ios::binary) << bytes;
    }

    /** One body of the shape, in the unit square or cube. */
    SceneFile
    scene(const std::string              &shape,
          const std::string              &entries,
          const unsigned int              dim     = 2,
          const std::vector<std::string> &changes = {}) const
    {
      const bool space = dim == 3;
      return SceneFile(
        ParameterText{"set Dimension = " + std::to_string(dim) +
                        "\nset Bodies = part\nsubsection Body part\n"
                        "set Shape = " +
                        shape + "\nsubsection " + section(shape) +
                        "\nset File = data\n" + entries +
                        "\nend\nsubsection Linear elastic\nset Density = 2\n"
                        "set Young's modulus = 1\nset Poisson's ratio = 0.3\n"
                        "end\nend\nsubsection Grid\nset Upper corner = " +
                        (space ? "1, 1, 1" : "1, 1") + "\nset Cells = " +
                        (space ? "10, 10, 10" : "10, 10") + "\nend\n",
                      FileFormat::prm,
                      (folder / "scene.prm").string()},
        changes);
    }

    const std::filesystem::path folder;

  private:
    static std::string
    section(const std::string &shape)
    {
      if (shape == "stl")
        return "STL";
      std::string result = shape;
      result[0]          = std::toupper(result[0]);
      return result;
    }
  };



  template <int dim>
  Problem<dim>
  read(const std::string              &bytes,
       const std::string              &shape,
       const std::string              &entries,
       const std::vector<std::string> &changes = {})
  {
    return read_problem<dim>(
      FolderWithFile(bytes).scene(shape, entries, dim, changes));
  }



  template <int dim>
  std::string
  said(const std::string              &bytes,
       const std::string              &shape,
       const std::string              &entries,
       const std::vector<std::string> &changes = {})
  {
    try
      {
        read<dim>(bytes, shape, entries, changes);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  void
  expect_said(const std::string              &message,
              const std::vector<std::string> &expected)
  {
    EXPECT_FALSE(message.empty()) << "The scene was accepted.";
    for (const std::string &fragment : expected)
      EXPECT_NE(message.find(fragment), std::string::npos)
        << "expected: " << fragment << "\nin: " << message;
    std::istringstream words(message);
    const auto n = std::distance(std::istream_iterator<std::string>(words),
                                 std::istream_iterator<std::string>());
    EXPECT_GE(n, 15) << message;
    EXPECT_LE(n, 40) << message;
  }



  /** A disc of 200 and one of 100 around its centre, on 0. */
  std::string
  image_of_discs(const unsigned int n, const bool text)
  {
    std::ostringstream image;
    image << (text ? "P2" : "P5") << "\n# two discs\n"
          << n << ' ' << n << "\n255\n";
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          const double r = std::hypot((i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5);
          const int    value = r < 0.2 ? 100 : r < 0.4 ? 200 : 0;
          if (text)
            image << value << (i + 1 < n ? ' ' : '\n');
          else
            image << char(value);
        }
    return image.str();
  }



  template <typename T>
  std::string
  raw_bytes(const std::vector<T> &values, const bool reversed)
  {
    std::string bytes;
    for (const T value : values)
      {
        std::string own(reinterpret_cast<const char *>(&value), sizeof(T));
        bytes += reversed ? std::string(own.rbegin(), own.rend()) : own;
      }
    return bytes;
  }



  /** The points of a body, and what they add up to. */
  template <int dim>
  struct Seeded
  {
    double                 mass = 0, volume = 0;
    std::size_t            n = 0;
    dealii::Tensor<1, dim> momentum;
    dealii::Tensor<1, dim> first; // moments of the mass about the origin
    dealii::Tensor<2, dim> second;

    explicit Seeded(const Problem<dim> &problem)
    {
      const BackgroundGrid<dim> grid(problem.grid, MPI_COMM_SELF);
      MaterialPoints<dim>       points(grid, PointLayout());
      const Body<dim>          &body = problem.bodies[0];
      seed<dim>(
        body, grid, [&](const Point<dim> &) { return body.density(); }, points);
      const PointView<dim> view = points.view();
      n                         = view.size;
      for (std::size_t p = 0; p < n; ++p)
        {
          mass += view.mass[p];
          for (int d = 0; d < dim; ++d)
            {
              momentum[d] += view.mass[p] * view.velocity[d][p];
              first[d] += view.mass[p] * view.position[d][p];
              for (int e = 0; e < dim; ++e)
                second[d][e] +=
                  view.mass[p] * view.position[d][p] * view.position[e][p];
            }
        }
      volume = mass / body.density();
    }
  };
} // namespace



// Two bodies name one file, with different values.
TEST(BodiesFromFiles, ImagesOfADiscAndARingAroundIt)
{
  for (const bool text : {true, false})
    {
      const std::string image = image_of_discs(200, text);
      const std::string edges = "set Pixel edge = 0.005\n";
      const auto        ring =
        read<2>(image, "image", edges + "set Values = 101, 255");
      const auto disc = read<2>(image, "image", edges + "set Values = 50, 100");
      const auto &outer = *ring.bodies[0].shape, &inner = *disc.bodies[0].shape;
      // pixels along the edge: half a pixel at most, and these cancel
      EXPECT_NEAR(*inner.exact_volume(), PI * 0.04, 1e-3 * PI * 0.04);
      EXPECT_NEAR(*outer.exact_volume(), PI * 0.12, 1e-3 * PI * 0.12);
      EXPECT_NEAR(counted_volume(outer), PI * 0.12, 2e-3 * PI * 0.12);
      EXPECT_TRUE(inner.contains(Point<2>(0.5, 0.6)));
      EXPECT_FALSE(outer.contains(Point<2>(0.5, 0.6)));
      EXPECT_TRUE(outer.contains(Point<2>(0.5, 0.8)));
      EXPECT_FALSE(outer.contains(Point<2>(0.1, 0.1)));
      EXPECT_LT(outer.bounding_box().first.distance(Point<2>(0.1, 0.1)), 1e-12);
    }
}



// The first row of an image is at the top.
TEST(BodiesFromFiles, ImagesStandUpright)
{
  const auto  problem = read<2>("P2 2 2 9\n9 0\n0 0\n",
                               "image",
                               "set Values = 9, 9\nset Pixel edge = 0.1, 0.2\n"
                                "set Lower corner = 0.3, 0.3");
  const auto &shape   = *problem.bodies[0].shape;
  EXPECT_TRUE(shape.contains(Point<2>(0.35, 0.6)));
  EXPECT_FALSE(shape.contains(Point<2>(0.45, 0.6)));
  EXPECT_FALSE(shape.contains(Point<2>(0.35, 0.4)));
  EXPECT_NEAR(*shape.exact_volume(), 0.02, 1e-15);
}



namespace
{
  /** A PNG file with rows of @p width pixels, the uppermost one first. */
  template <typename Channel>
  std::string
  png_of(const png_uint_32           format,
         const unsigned int          width,
         const std::vector<Channel> &channels)
  {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.format  = format;
    image.width   = width;
    image.height  = channels.size() / PNG_IMAGE_SAMPLE_CHANNELS(format) / width;
    png_alloc_size_t n = 0;
    png_image_write_to_memory(
      &image, nullptr, &n, 0, channels.data(), 0, nullptr);
    std::string bytes(n, ' ');
    EXPECT_TRUE(png_image_write_to_memory(
      &image, bytes.data(), &n, 0, channels.data(), 0, nullptr));
    bytes.resize(n);
    return bytes;
  }



  /** Whether pixels of a row with an edge of 0.1 m are filled: "#." */
  std::string
  filled_pixels(const std::string &image, const std::string &values)
  {
    const auto problem =
      read<2>(image, "image", "set Pixel edge = 0.1\nset Values = " + values);
    std::string result;
    for (unsigned int i = 0; i < 6; ++i)
      result +=
        problem.bodies[0].shape->contains(Point<2>(0.05 + 0.1 * i, 0.05)) ?
          '#' :
          '.';
    return result;
  }
} // namespace



TEST(BodiesFromFiles, PngImagesAreReadByLuminance)
{
  using Bytes = std::vector<png_byte>;
  const std::string grey =
    png_of(PNG_FORMAT_GRAY, 6, Bytes{0, 49, 50, 100, 101, 255});
  EXPECT_EQ(filled_pixels(grey, "50, 100"), "..##..");
  EXPECT_EQ(filled_pixels(grey, "0, 49"), "##....");

  // red, green, blue, white; black that nobody sees and black half seen
  const std::string colour =
    png_of(PNG_FORMAT_RGBA, 6, Bytes{255, 0, 0,   255, 0,   255, 0,   255,
                                     0,   0, 255, 255, 255, 255, 255, 255,
                                     0,   0, 0,   0,   0,   0,   0,   128});
  EXPECT_EQ(filled_pixels(colour, "54.2, 54.3"), "#.....");
  EXPECT_EQ(filled_pixels(colour, "182.3, 182.4"), ".#....");
  EXPECT_EQ(filled_pixels(colour, "18.4, 18.5"), "..#...");
  EXPECT_EQ(filled_pixels(colour, "254.9, 255.1"), "...##.");
  EXPECT_EQ(filled_pixels(colour, "126.9, 127.1"), ".....#");

  // 16 bits: the writer turns linear values into those of sRGB
  const std::string deep =
    png_of(PNG_FORMAT_LINEAR_Y, 2, std::vector<png_uint_16>{0, 65535});
  EXPECT_EQ(filled_pixels(deep, "65535, 65535"), ".#....");

  // the first row is at the top
  EXPECT_EQ(filled_pixels(png_of(PNG_FORMAT_GRAY, 2, Bytes{9, 0, 0, 9}),
                          "9, 9"),
            ".#....");
}



TEST(BodiesFromFiles, RawVoxelsOfEveryTypeAreRead)
{
  // 3 x 2 x 2 voxels; those of -5 to 7 are filled
  const std::vector<double> values = {0, 90, 0, 9, 9, 9, 9, 9, 9, 9, 9, 7};
  const auto                filled = [](const std::string &bytes,
                         const std::string &type,
                         const std::string &order) {
    return read<3>(std::string("head") + bytes,
                   "image",
                   "set Size = 3, 2, 2\nset Pixel edge = 0.1\n"
                                  "set Values = -5, 7\nset Header bytes = 4\n"
                                  "set Number type = " +
                     type + "\nset Byte order = " + order);
  };
  const auto expect = [](const Problem<3> &problem) {
    const auto &shape = *problem.bodies[0].shape;
    EXPECT_NEAR(*shape.exact_volume(), 3e-3, 1e-15);
    EXPECT_TRUE(shape.contains(Point<3>(0.05, 0.05, 0.05)));
    EXPECT_FALSE(shape.contains(Point<3>(0.15, 0.05, 0.05)));
    EXPECT_TRUE(shape.contains(Point<3>(0.25, 0.05, 0.05)));
    EXPECT_TRUE(shape.contains(Point<3>(0.25, 0.15, 0.15)));
    EXPECT_FALSE(shape.contains(Point<3>(0.05, 0.15, 0.15)));
  };
  for (const bool big : {false, true})
    {
      const std::string order = big ? "big" : "little";
      const auto        as    = [&](auto zero) {
        return raw_bytes(std::vector<decltype(zero)>(values.begin(),
                                                     values.end()),
                         big);
      };
      expect(filled(as(std::uint8_t(0)), "uint8", order));
      expect(filled(as(std::uint16_t(0)), "uint16", order));
      expect(filled(as(std::int16_t(0)), "int16", order));
      expect(filled(as(std::int32_t(0)), "int32", order));
      expect(filled(as(0.f), "float32", order));
      expect(filled(as(0.), "float64", order));
    }
}



TEST(BodiesFromFiles, ImagesSayWhatIsWrong)
{
  const std::string values = "set Values = 50, 60";
  expect_said(said<2>("P2 2 1 99\n10 20\n", "image", values),
              {"no value from 50 to 60", "10 to 20", "'data'"});
  expect_said(said<2>("P6 2 1 99\nabcdef", "image", values),
              {"P6", "colour", "convert"});
  expect_said(said<2>("\xff\xd8\xff....", "image", values),
              {"neither PNG nor PGM", "JPEG"});
  const std::string png =
    png_of(PNG_FORMAT_GRAY, 2, std::vector<png_byte>{10, 20});
  expect_said(said<2>(png, "image", values), {"no value from 50 to 60"});
  expect_said(said<2>(png.substr(0, png.size() - 20), "image", values),
              {"PNG", "libpng", "ends too early", "cut off"});
  std::string damaged = png;
  damaged[20] ^= 1; // of the width
  expect_said(said<2>(damaged, "image", values), {"libpng", "CRC"});
  expect_said(said<2>("P5 20 10 255\nabc", "image", values),
              {"20 x 10", "3 bytes", "cut off"});
  expect_said(said<2>("P2 2 2 99\n1 2 3", "image", values),
              {"ends before pixel 4"});
  expect_said(said<2>("P2 2 2 99\n1 2 3 400", "image", values),
              {"'400'", "pixel 4", "99"});
  expect_said(said<2>("P2 2 1 99\n50 60\n",
                      "image",
                      values + "\nset Pixel edge = 0.1, -1"),
              {"'0.1, -1'", "Pixel edge"});
  expect_said(said<3>("P2 2 1 99\n50 60\n", "image", values),
              {"no size", "three dimensions"});
  expect_said(said<3>("abcdefg", "image", values + "\nset Size = 2, 2, 2"),
              {"7 bytes", "2 x 2 x 2", "take 8"});
  const float nan = std::nanf("");
  expect_said(said<2>(raw_bytes<float>({1, nan}, false),
                      "image",
                      values + "\nset Size = 2, 1\nset Number type = float32"),
              {"not finite", "number 2"});
}



TEST(BodiesFromFiles, PointsOfAListHaveTheirPlacesSizesAndVelocities)
{
  // two layers of three, in millimetres
  std::ostringstream table;
  table << "# made by a script\nid, x, y, volume, velocity x, velocity y\n";
  for (unsigned int i = 0; i < 6; ++i)
    table << i << ", " << 100 * (i % 3) + 250 << ", " << 100 * (i / 3) + 250
          << ", 10000, " << i << ", 1\n";
  const auto  problem = read<2>(table.str(), "point list", "set Scale = 0.001");
  const auto &shape   = *problem.bodies[0].shape;
  EXPECT_NEAR(*shape.exact_volume(), 0.06, 1e-15);
  EXPECT_NEAR(counted_volume(shape), 0.02, 1e-3);  // in the box of the places
  EXPECT_TRUE(shape.contains(Point<2>(0.3, 0.3))); // between four
  EXPECT_FALSE(shape.contains(Point<2>(0.51, 0.3)));
  const Seeded<2> seeded(problem);
  EXPECT_EQ(seeded.n, 6u);
  EXPECT_NEAR(seeded.volume, 0.06, 1e-15);
  EXPECT_NEAR(seeded.momentum[0], 2 * 0.01 * 15, 1e-14);
  EXPECT_NEAR(seeded.momentum[1], 2 * 0.01 * 6, 1e-14);
  EXPECT_EQ(estimate_size(problem, Task::run, 1, 0).points[0], 6);

  // turned by a quarter, velocities with it
  const Seeded<2> turned(
    read<2>(table.str(),
            "point list",
            "set Scale = 0.001\nset Rotation = 90\nset Translation = 1, 0"));
  EXPECT_NEAR(turned.momentum[0], -2 * 0.01 * 6, 1e-14);
  EXPECT_NEAR(turned.momentum[1], 2 * 0.01 * 15, 1e-14);
}



TEST(BodiesFromFiles, PointsOfAListMayHaveMasses)
{
  const auto problem = read<3>("x\ty\tz\tmass\n.5\t.5\t.5\t.002\n.6\t.5\t.5\t"
                               ".004\n",
                               "point list",
                               "");
  EXPECT_NEAR(*problem.bodies[0].shape->exact_volume(), 0.003, 1e-15);
  const Seeded<3> seeded(problem);
  EXPECT_NEAR(seeded.mass, 0.006, 1e-15);
}



TEST(BodiesFromFiles, PointsOfAListComeFromHdf5AsWell)
{
  const auto path = std::filesystem::temp_directory_path() /
                    ("limber_list_" + std::to_string(getpid()) + ".h5");
  const auto write =
    [&](const std::map<std::string, std::vector<double>> &all) {
      const hid_t file =
        H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
      for (const auto &[name, values] : all)
        {
          const hsize_t size[] = {values.size()};
          const hid_t   space  = H5Screate_simple(1, size, nullptr);
          const hid_t   array  = H5Dcreate2(file,
                                         name.c_str(),
                                         H5T_NATIVE_DOUBLE,
                                         space,
                                         H5P_DEFAULT,
                                         H5P_DEFAULT,
                                         H5P_DEFAULT);
          H5Dwrite(array,
                   H5T_NATIVE_DOUBLE,
                   H5S_ALL,
                   H5S_ALL,
                   H5P_DEFAULT,
                   values.data());
          H5Dclose(array);
          H5Sclose(space);
        }
      H5Fclose(file);
      std::ifstream      stream(path, std::ios::binary);
      std::ostringstream bytes;
      bytes << stream.rdbuf();
      return bytes.str();
    };
  const std::string right = write({{"x", {0.25, 0.5}},
                                   {"y", {0.5, 0.5}},
                                   {"volume", {0.01, 0.02}},
                                   {"velocity x", {0, 3}},
                                   {"velocity y", {0, 4}},
                                   {"temperature", {1, 2, 3}}});
  const Seeded<2>   seeded(read<2>(right, "point list", ""));
  EXPECT_EQ(seeded.n, 2u);
  EXPECT_NEAR(seeded.momentum.norm(), 2 * 0.02 * 5, 1e-15);

  expect_said(said<2>(right.substr(0, 600), "point list", ""),
              {"cannot be read", "cut off"});
  expect_said(said<2>(write({{"x", {1, 2}}, {"y", {1}}, {"volume", {1, 2}}}),
                      "point list",
                      ""),
              {"1 numbers", "'y'"});
  expect_said(said<2>(write({{"x", {1, NAN}}, {"y", {1, 1}}}),
                      "point list",
                      ""),
              {"not finite", "'x'", "point 2"});
  std::filesystem::remove(path);
}



TEST(BodiesFromFiles, PointListsSayWhatIsWrong)
{
  const auto of = [](const std::string              &bytes,
                     const std::vector<std::string> &changes = {}) {
    return said<2>(bytes, "point list", "", changes);
  };
  const std::string right = "x, y, volume\n.5, .5, .01\n";
  EXPECT_EQ(of(right), "");
  expect_said(of("x, volume\n1, 2\n"), {"no column 'y'"});
  expect_said(of("x, y\n.1, .2\n"), {"'volume'", "'mass'", "neither"});
  expect_said(of("x, y, mass, volume\n.1, .2, 1, 1\n"), {"both"});
  expect_said(of("x, y, volume, velocity y\n.1, .2, 1, 1\n"),
              {"'velocity x'", "missing"});
  expect_said(of("x, y, volum\n.1, .2, 1\n"), {"'volum'", "'volume'?"});
  expect_said(of(".1, .2, 1\n.1, .2, 1\n"), {"names of its columns"});
  expect_said(of("x, y, volume\n.1, .2\n"), {"2 numbers", "line 2"});
  expect_said(of("x, y, volume\n.1, .2, .1\n.1, inf, .1\n"),
              {"'inf'", "'y'", "line 3"});
  expect_said(of("x, y, volume\n.1, .2, 0\n"), {"volume 0", "line 2"});
  expect_said(of("x, y, volume\n"), {"no point"});
  expect_said(of("x, y, volume\n.5, .5, .01\n.5, 1.5, .01\n"),
              {"line 3", "beyond the grid", "(0.5, 1.5)"});
  expect_said(of(right, {"Body part/Placement=cut"}), {"'cut'", "no effect"});
  expect_said(of(right, {"Grid/Levels=1"}), {"Levels"});
}



TEST(BodiesFromFiles, MeshesCoverWhatTheirElementsDo)
{
  const std::string plane    = "6 3 0 0 0\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n"
                               "5 4 0 0\n6 3 3 0\n1 1 quad 1 2 3 4\n"
                               "2 1 tri 2 5 3\n3 1 tri 3 5 6\n";
  const auto        read_inp = [](const std::string &text, const auto dim) {
    return read_mesh_text<decltype(dim)::value>(text, {"a.inp", "test", true});
  };
  const MeshShape<2> panel(read_inp(plane, std::integral_constant<int, 2>()),
                           "");
  // shoelace formula
  EXPECT_NEAR(*panel.exact_volume(), 4 + 2 + 2, 1e-14);
  EXPECT_TRUE(panel.contains(Point<2>(2.1, 1)));
  EXPECT_TRUE(panel.contains(Point<2>(3, 2)));
  EXPECT_FALSE(panel.contains(Point<2>(1, 2.5)));

  // a cube with a bent top, and a tetrahedron beside it
  const std::string solid =
    "9 2 0 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n"
    "7 1 1 2\n8 0 1 1\n9 2 0 0\n1 1 hex 1 2 3 4 5 6 7 8\n"
    "2 1 tet 2 9 3 6\n";
  const MeshShape<3> cube(read_inp(solid, std::integral_constant<int, 3>()),
                          "");
  ASSERT_TRUE(cube.exact_volume());
  EXPECT_NEAR(*cube.exact_volume(), 1 + 1. / 4 + 1. / 6, 1e-14);
  EXPECT_TRUE(cube.contains(Point<3>(0.9, 0.9, 1.7)));
  EXPECT_FALSE(cube.contains(Point<3>(0.2, 0.2, 1.15)));
  EXPECT_TRUE(cube.contains(Point<3>(1.2, 0.1, 0.1)));
  EXPECT_FALSE(cube.contains(Point<3>(1.7, 0.5, 0.5)));
  EXPECT_NEAR(counted_volume(cube),
              *cube.exact_volume(),
              1e-3 * *cube.exact_volume());
}



// Spreadsheets begin files with a byte order mark; and a mistyped first vertex
// is no name of columns.
TEST(BodiesFromFiles, NothingOfAPolygonIsLost)
{
  const auto area = [](const std::string &text) {
    const FolderWithFile file(text);
    return *read_problem<2>(file.scene("polygon", ""))
              .bodies[0]
              .shape->exact_volume();
  };
  const std::string square = "0 0\n1 0\n1 1\n0 1\n";
  EXPECT_NEAR(area(square), 1, 1e-14);
  EXPECT_NEAR(area("\xef\xbb\xbf" + square), 1, 1e-14);
  EXPECT_NEAR(area("\xef\xbb\xbfx y\n" + square), 1, 1e-14);
  try
    {
      area("0 O\n1 0\n1 1\n0 1\n");
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("'0, O'"), std::string::npos)
        << error.what();
    }
}



TEST(BodiesFromFiles, PathsStartFromTheFolderOfTheScene)
{
  const FolderWithFile file("0 0\n1 0\n0 1\n");
  const SceneFile      scene = file.scene("polygon", "");
  const std::string    path  = (file.folder / "data").string();
  EXPECT_EQ(scene.parameters()
              .root()
              .subsection("Body part")
              .subsection("Polygon")
              .text("File"),
            path);
  EXPECT_EQ(read_problem<2>(
              file.scene("polygon", "", 2, {"Reference/Mesh file = a.msh"}))
              .reference.mesh_file,
            (file.folder / "a.msh").string());
  // as the run folder has it, and changed from the command line
  std::ostringstream printed;
  scene.parameters().print(printed, PrintStyle::prm);
  const auto again = read_problem<2>(SceneFile(
    ParameterText{printed.str(), FileFormat::prm, "elsewhere/parameters.prm"}));
  EXPECT_NEAR(*again.bodies[0].shape->exact_volume(), 0.5, 1e-15);
  std::filesystem::rename(path, path + "2");
  EXPECT_NEAR(*read_problem<2>(
                 file.scene("polygon", "", 2, {"Body part/Polygon/File=data2"}))
                 .bodies[0]
                 .shape->exact_volume(),
              0.5,
              1e-15);
  try
    {
      read_problem<2>(scene);
      ADD_FAILURE() << "The file is not there.";
    }
  catch (const FileError &error)
    {
      expect_said(error.what(), {"data", "Polygon", "resumed", "folder"});
    }
}



// A resumed run may find the file elsewhere, but not another one.
TEST(BodiesFromFiles, OnlyTheContentOfAFileIsFixed)
{
  const FolderWithFile file("0 0\n1 0\n0 1\n");
  const auto before = read_problem<2>(file.scene("polygon", "")).fixed_entries;
  std::filesystem::rename(file.folder / "data", file.folder / "moved");
  const std::vector<std::string> moved = {"Body part/Polygon/File=moved"};
  EXPECT_EQ(read_problem<2>(file.scene("polygon", "", 2, moved)).fixed_entries,
            before);
  std::ofstream(file.folder / "moved") << "0 0\n1 0\n0 .9\n";
  EXPECT_NE(read_problem<2>(file.scene("polygon", "", 2, moved)).fixed_entries,
            before);
}



TEST(BodiesFromFiles, AreFilledToOneThousandthOfTheirVolume)
{
  const TestFacets facets = icosphere(3, 0.35, Point<3>(0.5, 0.5, 0.5));
  const Seeded<3>  ball(
    read<3>(binary_stl(facets), "stl", "", {"Body part/Placement=cut"}));
  EXPECT_NEAR(ball.volume, volume_within(facets), 1e-3 * volume_within(facets));

  const Seeded<2> plate(read<2>(".05 .03\n.93 .11\n.81 .97\n.13 .71\n\n"
                                ".3 .3\n.62 .33\n.5 .6\n",
                                "polygon",
                                "",
                                {"Body part/Placement=cut"}));
  const double    outer =
    0.5 * ((.05 * .11 - .93 * .03) + (.93 * .97 - .81 * .11) +
           (.81 * .71 - .13 * .97) + (.13 * .03 - .05 * .71));
  const double hole =
    0.5 * ((.3 * .33 - .62 * .3) + (.62 * .6 - .5 * .33) + (.5 * .3 - .3 * .6));
  EXPECT_NEAR(plate.volume, outer - hole, 1e-3 * (outer - hole));
}



// Second moments, of which inertia is made, within half a per cent of those of
// the facets; a point fills a cube of half a cell.
TEST(BodiesFromFiles, TurnAsTheirFacetsDo)
{
  const TestFacets facets = icosphere(3, 0.35, Point<3>(0.5, 0.5, 0.5));
  const Seeded<3>  ball(
    read<3>(binary_stl(facets), "stl", "", {"Body part/Placement=cut"}));
  const double         density = ball.mass / ball.volume, edge = 0.05;
  dealii::Tensor<1, 3> first;
  dealii::Tensor<2, 3> second;
  for (const auto &[a, b, c] : facets) // tetrahedra from the origin
    {
      const double volume = dealii::cross_product_3d(b, c) * a / 6;
      for (unsigned int d = 0; d < 3; ++d)
        {
          first[d] += volume / 4 * (a[d] + b[d] + c[d]);
          for (unsigned int e = 0; e < 3; ++e)
            second[d][e] += volume / 20 *
                            (a[d] * a[e] + b[d] * b[e] + c[d] * c[e] +
                             (a[d] + b[d] + c[d]) * (a[e] + b[e] + c[e]));
        }
    }
  const double whole = volume_within(facets);
  for (unsigned int d = 0; d < 3; ++d)
    for (unsigned int e = 0; e < 3; ++e)
      {
        const double exact = second[d][e] - first[d] * first[e] / whole;
        const double found =
          (ball.second[d][e] - ball.first[d] * ball.first[e] / ball.mass) /
            density +
          (d == e ? ball.volume * edge * edge / 12 : 0);
        EXPECT_NEAR(found, exact, 0.005 * 0.2 * 0.35 * 0.35 * whole);
      }
}
