// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_input_file_h
#define limber_base_input_file_h

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/** @file Files of other programs that a scene names, and their lines. */
namespace limber
{
  /** A whole file. */
  struct InputFile
  {
    std::string path;
    std::string bytes;

    /** "gear.stl", as messages show it. */
    std::string
    name() const;

    /** "684 bytes, CRC-32 0a1b2c3d": what a resumed run must find again. */
    std::string
    checksum() const;
  };



  /**
   * Read a file on the first rank and hand it to all. @p where is the entry
   * that names it. Throws FileError on all ranks where it cannot be read, is
   * empty, or has more than 1e9 bytes.
   */
  InputFile
  read_input_file(const std::string &path, const std::string &where);



  /** Goes through a text line by line, without their ends, and counts them. A
   * byte order mark of UTF-8, as spreadsheets write it, is no text. */
  class TextLines
  {
  public:
    explicit TextLines(const std::string_view text)
      : rest(text)
    {
      constexpr std::string_view mark = "\xef\xbb\xbf";
      if (rest.substr(0, mark.size()) == mark)
        rest.remove_prefix(mark.size());
    }

    /** Whether there is a next line; it is in @p line then. */
    bool
    next(std::string_view &line);

    std::size_t number = 0; // of the line that was read last, from 1

  private:
    std::string_view rest;
  };



  /** The words between blanks and any of @p separators. */
  std::vector<std::string_view>
  words_of(std::string_view line, const char *separators = ",;");

  /** Whether the whole word is a finite number, and which. */
  bool
  is_number(std::string_view word, double &value);
} // namespace limber

#endif
