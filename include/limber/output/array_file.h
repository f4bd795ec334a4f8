// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_array_file_h
#define limber_output_array_file_h

#include <deal.II/base/mpi.h>

#include <limber/base/exceptions.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace limber
{
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

    /** Throws FileError, as does everything below. */
    ArrayFile(const std::string &path, const Mode mode);

    /** Closes; a failure then goes unnoticed. */
    ~ArrayFile();

    /** Write what is still held back and close. */
    void
    close();

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

    template <typename T>
    void
    read(const std::string &name,
         const std::size_t  begin,
         T                 *values,
         const std::size_t  n) const;

  private:
    void
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
     * complete: it crashes when the program ends.
     */
    GatheredFile(const std::string  &path,
                 const std::uint64_t n_bytes,
                 MPI_Comm            communicator);

    template <typename T>
    void
    write(const std::string &name, const T *own, const std::size_t n_own);

    void
    close();

  private:
    template <typename Task>
    void
    attempt(const Task &task);

    const MPI_Comm             communicator;
    const bool                 first;
    std::unique_ptr<ArrayFile> file; // on the first rank
    std::optional<Failure>     failure;
  };
} // namespace limber

#endif
