// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/exceptions.h>
#include <limber/base/input_file.h>
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>

#include <zlib.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace limber
{
  namespace
  {
    constexpr double most_bytes = 1e9;



    /** What keeps the file from being read, and its bytes. */
    std::pair<std::string, std::string>
    read_bytes(const std::string &path)
    {
      std::error_code      error;
      const std::uintmax_t size = std::filesystem::file_size(path, error);
      if (error)
        return {error.message(), ""};
      if (size > most_bytes)
        return {"it has " + brief(size) + " bytes, more than " +
                  brief(most_bytes),
                ""};
      std::ifstream      file(path, std::ios::binary);
      std::ostringstream bytes;
      bytes << file.rdbuf();
      if (!file.is_open())
        return {std::strerror(errno), ""};
      return {bytes.str().empty() ? "it is empty" : "", bytes.str()};
    }
  } // namespace



  std::string
  InputFile::name() const
  {
    return in_quotes(std::filesystem::path(path).filename().string());
  }



  std::string
  InputFile::checksum() const
  {
    const auto crc =
      crc32_z(0, reinterpret_cast<const Bytef *>(bytes.data()), bytes.size());
    char text[16];
    std::snprintf(text, sizeof(text), "%08lx", crc);
    return std::to_string(bytes.size()) + " bytes, CRC-32 " + text;
  }



  InputFile
  read_input_file(const std::string &path, const std::string &where)
  {
    std::pair<std::string, std::string> read;
    const bool parallel = dealii::Utilities::MPI::job_supports_mpi();
    if (!parallel ||
        dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      read = read_bytes(path);
    if (parallel)
      {
        using dealii::Utilities::MPI::broadcast;
        read.first = broadcast_text(read.first, MPI_COMM_WORLD);
        read.second.resize(
          dealii::Utilities::MPI::max(std::uint64_t(read.second.size()),
                                      MPI_COMM_WORLD));
        broadcast(read.second.data(), read.second.size(), 0, MPI_COMM_WORLD);
      }

    if (!read.first.empty())
      throw FileError("The file " + in_quotes(path) + " of " + where +
                      " cannot be read: " + read.first +
                      ". Paths are relative to the scene's folder; resumed "
                      "runs need the file, too. Correct the path.");
    return {path, std::move(read.second)};
  }



  bool
  TextLines::next(std::string_view &line)
  {
    if (rest.empty())
      return false;
    const std::size_t end = rest.find('\n');
    line                  = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (!line.empty() && line.back() == '\r')
      line.remove_suffix(1);
    ++number;
    return true;
  }



  std::vector<std::string_view>
  words_of(std::string_view line, const char *separators)
  {
    const auto separates = [&](const char letter) {
      return letter == ' ' || letter == '\t' ||
             (letter != '\0' && std::strchr(separators, letter) != nullptr);
    };
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < line.size();)
      {
        if (separates(line[i]))
          {
            ++i;
            continue;
          }
        const std::size_t begin = i;
        while (i < line.size() && !separates(line[i]))
          ++i;
        words.push_back(line.substr(begin, i - begin));
      }
    return words;
  }



  bool
  is_number(std::string_view word, double &value)
  {
    if (!word.empty() && word.front() == '+')
      word.remove_prefix(1);
    const auto [end, error] =
      std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() &&
           std::isfinite(value);
  }
} // namespace limber
