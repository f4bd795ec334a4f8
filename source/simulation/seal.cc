// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/simulation/seal.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <limits>
#include <sstream>

namespace limber
{
  namespace
  {
    constexpr const char *first_lines =
      "Limber checkpoint, format %lu\nseal %08" PRIx32 " of %zu bytes\n";
    constexpr const char *first_lines_read =
      "Limber checkpoint, format %lu\nseal %8" SCNx32 " of %zu bytes%n";
    constexpr std::size_t longest_first_lines = 128;
    constexpr std::size_t least_room          = 512; // that HDF5 admits



    /** A file on the disk that is closed when it is done with. */
    class Descriptor
    {
    public:
      Descriptor(const std::string &path, const int flags)
        : number(open(path.c_str(), flags))
      {}

      Descriptor(const Descriptor &) = delete;
      Descriptor &
      operator=(const Descriptor &) = delete;

      ~Descriptor()
      {
        if (number >= 0)
          close(number);
      }

      const int number;
    };



    /** Bytes [begin, begin + n); fewer where the file ends or cannot be read.
     */
    std::string
    bytes_of(const Descriptor   &file,
             const std::uint64_t begin,
             const std::size_t   n)
    {
      std::string result(n, '\0');
      std::size_t present = 0;
      while (present < n)
        {
          const ssize_t more =
            pread(file.number, &result[present], n - present, begin + present);
          if (more <= 0)
            break;
          present += more;
        }
      result.resize(present);
      return result;
    }



    /** The checksum of [begin, begin + n) behind @p before; 0 at its end. */
    std::uint32_t
    checksum_of(const Descriptor   &file,
                std::uint64_t       begin,
                const std::uint64_t n,
                std::uint32_t       before = 0)
    {
      constexpr std::uint64_t portion = 1 << 20;
      for (const std::uint64_t end = begin + n; begin < end;)
        {
          const std::string bytes =
            bytes_of(file, begin, std::min(portion, end - begin));
          if (bytes.empty())
            return 0;
          before = checksum(bytes.data(), bytes.size(), before);
          begin += bytes.size();
        }
      return before;
    }



    /** The checksum of what is neither in the seal nor in an array. */
    std::uint32_t
    checksum_of_rest(const Descriptor &file, const Seal &seal)
    {
      auto pieces = seal.pieces;
      std::sort(pieces.begin(),
                pieces.end(),
                [](const FilePiece &a, const FilePiece &b) {
                  return a.begin < b.begin;
                });
      std::uint32_t result = 0;
      std::uint64_t begin  = seal.room;
      for (const FilePiece &piece : pieces)
        if (piece.n_bytes > 0)
          {
            if (piece.begin > begin)
              result = checksum_of(file, begin, piece.begin - begin, result);
            begin = piece.begin + piece.n_bytes;
          }
      return begin < seal.n_bytes ?
               checksum_of(file, begin, seal.n_bytes - begin, result) :
               result;
    }



    std::string
    start_of(const Seal &seal, const std::uint32_t own)
    {
      char text[longest_first_lines];
      std::snprintf(
        text, sizeof(text), first_lines, seal.format, own, seal.room);
      return text;
    }



    std::string
    line_of(const FilePiece &piece)
    {
      char numbers[64];
      std::snprintf(numbers,
                    sizeof(numbers),
                    "%08" PRIx32 " %" PRIu64 " %" PRIu64 " ",
                    piece.checksum,
                    piece.begin,
                    piece.n_bytes);
      return numbers + piece.name + "\n";
    }



    /** All but the first two lines, up to the full room. */
    std::string
    text_of(const Seal &seal)
    {
      std::ostringstream text;
      text << std::hex << seal.run << " run\n"
           << seal.rest << " HDF5's own tables\n"
           << std::dec << seal.n_bytes << " bytes\n"
           << seal.step << " step\n"
           << to_text(seal.time) << " s\n"
           << seal.pieces.size() << " arrays: checksum, begin, bytes, name\n";
      for (const FilePiece &piece : seal.pieces)
        text << line_of(piece);
      std::string result = text.str();
      result.resize(seal.room - start_of(seal, 0).size(), ' ');
      result.back() = '\n';
      return result;
    }



    /** The checksum of the text, its own digits taken as zeros. */
    std::uint32_t
    own_checksum(const Seal &seal, const std::string &text)
    {
      const std::string start = start_of(seal, 0);
      return checksum(text.data(),
                      text.size(),
                      checksum(start.data(), start.size()));
    }



    /** The opposite of text_of(); whether it is complete. */
    bool
    read_text(const std::string &text, Seal &seal)
    {
      constexpr auto     to_end = std::numeric_limits<std::streamsize>::max();
      std::istringstream in(text);
      std::size_t        n = 0;
      in >> std::hex >> seal.run;
      in.ignore(to_end, '\n') >> seal.rest >> std::dec;
      in.ignore(to_end, '\n') >> seal.n_bytes;
      in.ignore(to_end, '\n') >> seal.step;
      in.ignore(to_end, '\n') >> seal.time;
      in.ignore(to_end, '\n') >> n;
      in.ignore(to_end, '\n');
      FilePiece piece;
      while (seal.pieces.size() < n &&
             in >> std::hex >> piece.checksum >> std::dec >> piece.begin >>
               piece.n_bytes &&
             std::getline(in.ignore(1), piece.name))
        seal.pieces.push_back(piece);
      return in && seal.pieces.size() == n;
    }



    std::string
    present_bytes(const std::uint64_t present, const std::uint64_t wanted)
    {
      return "has " + std::to_string(present) + " bytes instead of " +
             std::to_string(wanted);
    }



    /** Throws unless there is a file that can be read; its length. */
    std::uint64_t
    check_presence(const std::string &path, const Descriptor &file)
    {
      struct stat status;
      if (file.number < 0)
        throw DamagedFile(path,
                          errno == ENOENT ? "is not there" :
                                            std::string("cannot be read: ") +
                                              std::strerror(errno));
      if (fstat(file.number, &status) != 0 || !S_ISREG(status.st_mode))
        throw DamagedFile(path, "is not a file");
      return status.st_size;
    }



    bool
    is_plain_hdf5(const std::string &start)
    {
      const std::string signature = "\x89HDF\r\n\x1a\n";
      return start.compare(0, signature.size(), signature) == 0;
    }



    /** Format, own checksum and room; throws where there is no seal. */
    Seal
    read_start(const std::string &path, const std::string &start)
    {
      Seal seal;
      int  end = 0;
      if (std::sscanf(start.c_str(),
                      first_lines_read,
                      &seal.format,
                      &seal.own,
                      &seal.room,
                      &end) != 3 ||
          start.compare(0, end + 1, start_of(seal, seal.own)) != 0 ||
          seal.room < least_room)
        throw DamagedFile(path, "has changed in its first lines");
      return seal;
    }
  } // namespace



  std::size_t
  room_for_seal(const std::vector<std::string> &names)
  {
    // Lines of six numbers at most, and those of the arrays.
    std::size_t needed = longest_first_lines + 256;
    for (const std::string &name : names)
      needed += name.size() + 64;
    std::size_t room = least_room;
    while (room < needed)
      room *= 2;
    return room;
  }



  void
  put_seal(const std::string &path, Seal &seal)
  {
    const Descriptor file(path, O_RDWR);
    struct stat      status;
    if (file.number < 0 || fstat(file.number, &status) != 0)
      throw cannot_write(path, std::strerror(errno));
    seal.n_bytes           = status.st_size;
    seal.rest              = checksum_of_rest(file, seal);
    const std::string text = text_of(seal);
    seal.own               = own_checksum(seal, text);
    const std::string all  = start_of(seal, seal.own) + text;
    errno                  = 0;
    const ssize_t done     = pwrite(file.number, all.data(), all.size(), 0);
    if (done != static_cast<ssize_t>(all.size()) || fsync(file.number) != 0)
      throw cannot_write(path, std::strerror(errno != 0 ? errno : ENOSPC));
  }



  Seal
  read_seal(const std::string &path)
  {
    // Without waiting for what might be a pipe.
    const Descriptor    file(path, O_RDONLY | O_NONBLOCK);
    const std::uint64_t n_bytes = check_presence(path, file);
    const std::string   start   = bytes_of(file, 0, longest_first_lines);
    if (is_plain_hdf5(start))
      return {};
    Seal seal = read_start(path, start);
    if (n_bytes < seal.room)
      throw DamagedFile(path, present_bytes(n_bytes, seal.room));
    const std::size_t begin = start_of(seal, 0).size();
    const std::string text  = bytes_of(file, begin, seal.room - begin);
    if (seal.own != own_checksum(seal, text))
      throw DamagedFile(path, "has changed in its first lines");
    // Other formats may differ from here on.
    if (seal.format != checkpoint_format)
      return seal;
    if (!read_text(text, seal))
      throw DamagedFile(path, "has first lines that nobody has written");
    if (n_bytes != seal.n_bytes)
      throw DamagedFile(path, present_bytes(n_bytes, seal.n_bytes));
    return seal;
  }



  void
  check_seal(const std::string &path, const Seal &seal)
  {
    const Descriptor file(path, O_RDONLY | O_NONBLOCK);
    check_presence(path, file);
    for (const FilePiece &piece : seal.pieces)
      if (checksum_of(file, piece.begin, piece.n_bytes) != piece.checksum)
        throw DamagedFile(path,
                          "has changed in the array " + in_quotes(piece.name));
    if (checksum_of_rest(file, seal) != seal.rest)
      throw DamagedFile(path, "has changed in the tables of HDF5");
  }
} // namespace limber
