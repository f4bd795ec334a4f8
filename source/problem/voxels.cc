// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/image.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace limber
{
  namespace
  {
    [[noreturn]] void
    refuse_image(const InputFile   &file,
                 const std::string &what,
                 const std::string &remedy)
    {
      throw InputError("The image " + file.name() + " " + what + ". " + remedy);
    }



    void
    check_kind(const InputFile &file)
    {
      const std::string start = file.bytes.substr(0, 2);
      if (start == "P2" || start == "P5")
        return;
      const bool netpbm =
        start.size() == 2 && start[0] == 'P' && std::isdigit(start[1]);
      refuse_image(
        file,
        netpbm ? "is of the kind " + start +
                   ", which is black and white or in colour" :
                 "is neither PNG nor PGM, which begins with P2 or P5",
        "Usually it has another format, such as JPEG. Convert it, for "
        "instance with 'convert a.jpg a.png'; raw files need 'Size'.");
    }



    /** The integers of a PGM file, with comments between them. */
    class PgmNumbers
    {
    public:
      PgmNumbers(const InputFile &file, const std::size_t begin)
        : file(file)
        , next(begin)
      {}

      /** A number from 0 to @p most. */
      unsigned int
      read(const std::string &what, const unsigned int most)
      {
        const std::string &bytes = file.bytes;
        for (; next < bytes.size() &&
               (std::isspace(static_cast<unsigned char>(bytes[next])) ||
                bytes[next] == '#');
             ++next)
          if (bytes[next] == '#')
            next = std::min(bytes.find('\n', next), bytes.size() - 1);
        if (next >= bytes.size())
          refuse_image(
            file,
            "ends before " + what,
            "Usually it was cut off while it was copied. Write it anew.");
        unsigned long     value = 0;
        const std::size_t begin = next;
        for (; next < bytes.size() &&
               std::isdigit(static_cast<unsigned char>(bytes[next])) &&
               value <= most;
             ++next)
          value = 10 * value + (bytes[next] - '0');
        if (next == begin || value > most)
          refuse_image(
            file,
            "has " +
              in_quotes(bytes.substr(
                begin,
                std::min<std::size_t>(bytes.find_first_of(" \n\t\r", begin),
                                      begin + 10) -
                  begin)) +
              " for " + what + ", which is a whole number up to " +
              std::to_string(most),
            "Usually it was edited or has another format. Write it anew.");
        return value;
      }

      std::size_t
      position() const
      {
        return next;
      }

    private:
      const InputFile &file;
      std::size_t      next;
    };
  } // namespace



  template <int dim>
  void
  Voxels<dim>::start(const std::array<unsigned int, dim> &size)
  {
    n                 = size;
    std::size_t n_all = 1;
    for (const unsigned int along : size)
      n_all *= along;
    filled.assign(n_all, false);
    least   = std::numeric_limits<double>::max();
    largest = -least;
  }



  void
  read_pgm(const InputFile &file, Voxels<2> &voxels)
  {
    check_kind(file);
    PgmNumbers                  numbers(file, 2);
    std::array<unsigned int, 2> size;
    constexpr unsigned int      most_pixels = 1 << 20; // along an edge
    size[0]                    = numbers.read("the width", most_pixels);
    size[1]                    = numbers.read("the height", most_pixels);
    const unsigned int largest = numbers.read("the largest value", 65535);
    const std::size_t  n       = std::size_t(size[0]) * size[1];
    const std::size_t  begin   = numbers.position() + 1,
                      each     = largest < 256 ? 1 : 2;
    const bool        text     = file.bytes[1] == '2';
    const std::size_t there =
      file.bytes.size() < begin ? 0 : file.bytes.size() - begin;
    if (n == 0 || largest == 0 || there < n * (text ? 1 : each))
      refuse_image(
        file,
        "has " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
          " pixels up to " + std::to_string(largest) + " by its header, and " +
          std::to_string(there) + " bytes for them",
        "Usually it was cut off while it was copied. Write it anew.");
    voxels.start(size);
    for (std::size_t i = 0; i < n; ++i)
      {
        const std::size_t row  = size[1] - 1 - i / size[0];
        const auto        byte = [&](const std::size_t k) -> unsigned int {
          return static_cast<unsigned char>(file.bytes[begin + each * i + k]);
        };
        const unsigned int value =
          text      ? numbers.read("pixel " + std::to_string(i + 1), largest) :
          each == 1 ? byte(0) :
                      256 * byte(0) + byte(1);
        voxels.set(row * size[0] + i % size[0], value);
      }
  }



  namespace
  {
    /** How numbers of a type are read from bytes in this machine's order. */
    struct RawType
    {
      const char *word;
      std::size_t size;
      double (*value)(const char *);
    };

    template <typename T>
    double
    value_of(const char *bytes)
    {
      T value;
      std::memcpy(&value, bytes, sizeof(T));
      return value;
    }

    const RawType types[] = {{"uint8", 1, value_of<std::uint8_t>},
                             {"int8", 1, value_of<std::int8_t>},
                             {"uint16", 2, value_of<std::uint16_t>},
                             {"int16", 2, value_of<std::int16_t>},
                             {"uint32", 4, value_of<std::uint32_t>},
                             {"int32", 4, value_of<std::int32_t>},
                             {"float32", 4, value_of<float>},
                             {"float64", 8, value_of<double>}};



    bool
    machine_has_big_first()
    {
      const std::uint16_t one = 1;
      char                first;
      std::memcpy(&first, &one, 1);
      return first == 0;
    }
  } // namespace



  std::vector<std::string>
  raw_types()
  {
    std::vector<std::string> words;
    for (const RawType &type : types)
      words.push_back(type.word);
    return words;
  }



  template <int dim>
  void
  read_raw(const InputFile      &file,
           const RawFormat<dim> &format,
           Voxels<dim>          &voxels)
  {
    const RawType *type = types;
    while (format.type != type->word)
      ++type;
    double      wanted = 1;
    std::string edges;
    for (const unsigned int n : format.n)
      {
        wanted *= n;
        edges += (edges.empty() ? "" : " x ") + std::to_string(n);
      }
    if (wanted * type->size + format.header != file.bytes.size())
      refuse_image(file,
                   "has " + std::to_string(file.bytes.size()) + " bytes, but " +
                     edges + " numbers of the type " + format.type +
                     " behind " + std::to_string(format.header) +
                     " bytes take " +
                     brief(wanted * type->size + format.header),
                   "Correct 'Size', 'Number type' or 'Header bytes'.");
    voxels.start(format.n);
    const bool swap = format.big_first != machine_has_big_first();
    for (std::size_t i = 0; i < voxels.filled.size(); ++i)
      {
        char        bytes[8];
        const char *from = &file.bytes[format.header + i * type->size];
        for (std::size_t k = 0; k < type->size; ++k)
          bytes[swap ? type->size - 1 - k : k] = from[k];
        const double value = type->value(bytes);
        if (!std::isfinite(value))
          refuse_image(
            file,
            "has a value that is not finite, number " + std::to_string(i + 1) +
              " of " + brief(wanted),
            "Usually 'Number type' or 'Byte order' is another. Correct "
            "it, or write a number there.");
        voxels.set(i, value);
      }
  }



  template struct Voxels<2>;
  template struct Voxels<3>;
  template void
  read_raw(const InputFile &, const RawFormat<2> &, Voxels<2> &);
  template void
  read_raw(const InputFile &, const RawFormat<3> &, Voxels<3> &);
} // namespace limber
