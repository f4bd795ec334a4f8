// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_array_file_h
#define limber_output_array_file_h

#include <deal.II/base/mpi.h>

#include <limber/base/exceptions.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** CRC-32 as by zlib; @p before: the checksum of the preceding bytes. */
  std::uint32_t
  checksum(const void         *bytes,
           const std::size_t   n_bytes,
           const std::uint32_t before = 0);



  /** Where an array stands in a file, and the checksum of its bytes there. */
  struct FilePiece
  {
    std::string   name;
    std::uint64_t begin    = 0;
    std::uint64_t n_bytes  = 0;
    std::uint32_t checksum = 0;
  };



  /** A file that cannot be read, or whose content has changed (checksum). */
  class DamagedFile : public FileError
  {
  public:
    /** @p reason continues a sentence: "has changed in the array 'id'". */
    DamagedFile(const std::string &path, const std::string &reason);

    const std::string reason;
  };



  /**
   * Named arrays of double, std::uint64_t or char in an HDF5 file, for one
   * rank. A slash in a name makes a group. HDF5's own interface is used, since
   * deal.II's does not tell in release mode when a disk is full.
   */
  class ArrayFile
  {
  public:
    enum class Mode
    {
      create, // replaces what is there
      read
    };

    /**
     * In front of a file that is created, @p room bytes (0 or a power of two
     * from 512 on) are left to the caller; they are undefined at first. Throws
     * FileError, as does everything below; DamagedFile when reading.
     */
    ArrayFile(const std::string &path,
              const Mode         mode,
              const std::size_t  room = 0);

    /** Closes; a failure then goes unnoticed. */
    ~ArrayFile();

    /** Write what is still held back and close. */
    void
    close();

    /** The path. */
    const std::string &
    name() const
    {
      return path;
    }

    /** A new array of @p n numbers, which write() fills part by part. */
    template <typename T>
    void
    create(const std::string &name, const std::size_t n);

    template <typename T>
    void
    write(const std::string &name,
          const std::size_t  begin,
          const T           *values,
          const std::size_t  n);

    bool
    has(const std::string &name) const;

    std::size_t
    size(const std::string &name) const;

    /** Where an array begins in the file; 0 for one without entries. */
    std::uint64_t
    begin(const std::string &name) const;

    template <typename T>
    void
    read(const std::string &name,
         const std::size_t  begin,
         T                 *values,
         const std::size_t  n) const;

  private:
    [[noreturn]] void
    fail(const std::string &what) const;

    const std::string path;
    const Mode        mode;
    std::int64_t      file; // HDF5's handle
  };



  /**
   * An ArrayFile in which the first rank writes the arrays of all ranks, one
   * behind the other. A failure does not end the exchange of messages; it is
   * thrown on all ranks by close(). Every member function is collective.
   */
  class GatheredFile
  {
  public:
    /**
     * @p n_bytes: at least what will be written. Whether there is room for
     * them is tried first, as HDF5 cannot let go of a file that it cannot
     * complete: it crashes when the program ends. @p room: as in ArrayFile.
     */
    GatheredFile(const std::string  &path,
                 const std::uint64_t n_bytes,
                 MPI_Comm            communicator,
                 const std::size_t   room = 0);

    template <typename T>
    void
    write(const std::string &name, const T *own, const std::size_t n_own);

    void
    close();

    /** What has been written, in this order; on the first rank. */
    const std::vector<FilePiece> &
    pieces() const
    {
      return written;
    }

  private:
    template <typename Task>
    void
    attempt(const Task &task);

    const MPI_Comm             communicator;
    const bool                 first;
    std::unique_ptr<ArrayFile> file; // on the first rank
    std::optional<Failure>     failure;
    std::vector<FilePiece>     written;
  };
} // namespace limber

#endif
