// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_text_file_h
#define limber_base_text_file_h

#include <limber/base/exceptions.h>

#include <cstdint>
#include <string>

namespace limber
{
  /** What to throw where writing to @p path failed; names the system's reason.
   */
  FileError
  cannot_write(const std::string &path, const std::string &reason);



  /**
   * A file that is written piece by piece and never through a symbolic link. A
   * piece is completely in the file, as far as the system tells, or a FileError
   * is thrown and the piece is removed. It is an error, too, if the file has
   * been removed meanwhile: what is written would be lost.
   */
  class TextFile
  {
  public:
    enum class Mode
    {
      create, // empty it if it is there
      fresh,  // it must not be there
      append
    };

    /** Throws FileError, as does everything below. */
    TextFile(const std::string &path, const Mode mode);

    TextFile(const TextFile &) = delete;
    TextFile &
    operator=(const TextFile &) = delete;

    /** Closes; a failure then goes unnoticed. */
    ~TextFile();

    void
    write(const std::string &text);

    /** In bytes. */
    std::uintmax_t
    length() const;

    /** Cut off what stands behind the first @p length bytes. */
    void
    shorten(const std::uintmax_t length);

    /** Some file systems tell only now that the disk is full. */
    void
    close();

  private:
    const std::string path;
    int               file;
  };
} // namespace limber

#endif
