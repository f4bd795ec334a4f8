// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/array_file.h>
#include <limber/output/files.h>

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

namespace limber
{
  namespace
  {
    /** Owns an HDF5 identifier; negative ones stand for failures. */
    class Hdf5Object
    {
    public:
      Hdf5Object(const hid_t id, herr_t (*const close)(hid_t))
        : id(id)
        , close(close)
      {}

      Hdf5Object(const Hdf5Object &) = delete;
      Hdf5Object &
      operator=(const Hdf5Object &) = delete;

      ~Hdf5Object()
      {
        if (id >= 0)
          close(id);
      }

      operator hid_t() const
      {
        return id;
      }

    private:
      const hid_t id;
      herr_t (*const close)(hid_t);
    };



    hid_t
    hdf5_type(const double *)
    {
      return H5T_NATIVE_DOUBLE;
    }



    hid_t
    hdf5_type(const std::uint64_t *)
    {
      return H5T_NATIVE_UINT64;
    }



    hid_t
    hdf5_type(const char *)
    {
      return H5T_NATIVE_CHAR;
    }



    /** Entries [begin, begin + n) of an array in the file. */
    bool
    select(const hid_t space, const std::size_t begin, const std::size_t n)
    {
      const hsize_t start[] = {begin}, count[] = {n};
      return H5Sselect_hyperslab(
               space, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0;
    }



    Hdf5Object
    line_of(const std::size_t n)
    {
      const hsize_t size[] = {n};
      return {H5Screate_simple(1, size, nullptr), H5Sclose};
    }



    /** Throws unless a file of this size can be written. */
    void
    try_room(const std::string &path, const std::uint64_t n_bytes)
    {
      const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
      if (file < 0)
        throw cannot_write(path, std::strerror(errno));
      const int error = posix_fallocate(file, 0, n_bytes);
      ::close(file);
      if (error != 0)
        throw cannot_write(path, std::strerror(error));
    }
  } // namespace



  std::uint32_t
  checksum(const void         *bytes,
           const std::size_t   n_bytes,
           const std::uint32_t before)
  {
    // Given no bytes, zlib would start from the beginning.
    return n_bytes == 0 ?
             before :
             crc32_z(before, static_cast<const Bytef *>(bytes), n_bytes);
  }



  DamagedFile::DamagedFile(const std::string &path, const std::string &reason)
    : FileError("The file " + in_quotes(path) + " " + reason +
                ". Usually it was damaged or written by another program. "
                "Restore it, or start the run anew in another "
                "'Output/Directory'.")
    , reason(reason)
  {}



  ArrayFile::ArrayFile(const std::string &path,
                       const Mode         mode,
                       const std::size_t  room)
    : path(path)
    , mode(mode)
  {
    // Failures are reported by fail(), not by HDF5.
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Hdf5Object creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_userblock(creation, room);
    errno = 0;
    file  = mode == Mode::create ?
              H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT) :
              H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
      fail("the file");
  }



  ArrayFile::~ArrayFile()
  {
    if (file >= 0)
      H5Fclose(file);
  }



  void
  ArrayFile::fail(const std::string &what) const
  {
    const std::string reason =
      errno != 0 ? std::strerror(errno) : "HDF5 fails at " + what;
    if (mode == Mode::create)
      throw cannot_write(path, reason);
    throw DamagedFile(path, "could not be read: " + reason);
  }



  void
  ArrayFile::close()
  {
    errno             = 0;
    const bool failed = H5Fflush(file, H5F_SCOPE_GLOBAL) < 0;
    const int  reason = errno;
    if (H5Fclose(file) < 0 || failed)
      {
        errno = reason != 0 ? reason : errno;
        file  = -1;
        fail("closing it");
      }
    file = -1;
  }



  template <typename T>
  void
  ArrayFile::create(const std::string &name, const std::size_t n)
  {
    errno = 0;
    const Hdf5Object groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(groups, 1);
    const Hdf5Object array(H5Dcreate2(file,
                                      name.c_str(),
                                      hdf5_type(static_cast<T *>(nullptr)),
                                      line_of(n),
                                      groups,
                                      H5P_DEFAULT,
                                      H5P_DEFAULT),
                           H5Dclose);
    if (array < 0)
      fail("the array " + in_quotes(name));
  }



  template <typename T>
  void
  ArrayFile::write(const std::string &name,
                   const std::size_t  begin,
                   const T           *values,
                   const std::size_t  n)
  {
    errno = 0;
    const Hdf5Object array(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Object place(H5Dget_space(array), H5Sclose);
    if (!select(place, begin, n) ||
        H5Dwrite(
          array, hdf5_type(values), line_of(n), place, H5P_DEFAULT, values) < 0)
      fail("the array " + in_quotes(name));
  }



  bool
  ArrayFile::has(const std::string &name) const
  {
    return Hdf5Object(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose) >= 0;
  }



  std::size_t
  ArrayFile::size(const std::string &name) const
  {
    errno = 0;
    const Hdf5Object array(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Object space(H5Dget_space(array), H5Sclose);
    const hssize_t   n = H5Sget_simple_extent_npoints(space);
    if (n < 0)
      fail("the array " + in_quotes(name));
    return n;
  }



  std::uint64_t
  ArrayFile::begin(const std::string &name) const
  {
    if (size(name) == 0)
      return 0;
    errno = 0;
    const Hdf5Object array(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const haddr_t    result = H5Dget_offset(array);
    if (result == HADDR_UNDEF)
      fail("the array " + in_quotes(name));
    return result;
  }



  template <typename T>
  void
  ArrayFile::read(const std::string &name,
                  const std::size_t  begin,
                  T                 *values,
                  const std::size_t  n) const
  {
    errno = 0;
    const Hdf5Object array(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Object place(H5Dget_space(array), H5Sclose);
    if (!select(place, begin, n) ||
        H5Dread(
          array, hdf5_type(values), line_of(n), place, H5P_DEFAULT, values) < 0)
      fail("the array " + in_quotes(name));
  }



  GatheredFile::GatheredFile(const std::string  &path,
                             const std::uint64_t n_bytes,
                             const MPI_Comm      communicator,
                             const std::size_t   room)
    : communicator(communicator)
    , first(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
  {
    attempt([&]() {
      try_room(path, room + n_bytes);
      file = std::make_unique<ArrayFile>(path, ArrayFile::Mode::create, room);
    });
  }



  /** On the first rank, unless something has failed before. */
  template <typename Task>
  void
  GatheredFile::attempt(const Task &task)
  {
    if (!first || failure)
      return;
    try
      {
        task();
      }
    catch (const Failure &caught)
      {
        failure.emplace(caught);
      }
  }



  template <typename T>
  void
  GatheredFile::write(const std::string &name,
                      const T           *own,
                      const std::size_t  n_own)
  {
    const MPI_Datatype type = dealii::Utilities::MPI::mpi_type_id_for_type<T>;
    constexpr int      tag  = 0;
    const auto         sizes =
      dealii::Utilities::MPI::gather<unsigned long>(communicator, n_own);
    if (!first)
      {
        MPI_Send(own, n_own, type, 0, tag, communicator);
        return;
      }

    std::size_t n = 0;
    for (const unsigned long size : sizes)
      n += size;
    attempt([&]() { file->create<T>(name, n); });
    attempt([&]() { file->write(name, 0, own, n_own); });
    FilePiece   piece{name, 0, n * sizeof(T), checksum(own, n_own * sizeof(T))};
    std::size_t begin = n_own;
    std::vector<T> theirs;
    for (unsigned int rank = 1; rank < sizes.size(); ++rank)
      {
        theirs.resize(sizes[rank]);
        MPI_Recv(theirs.data(),
                 theirs.size(),
                 type,
                 rank,
                 tag,
                 communicator,
                 MPI_STATUS_IGNORE);
        attempt(
          [&]() { file->write(name, begin, theirs.data(), theirs.size()); });
        begin += theirs.size();
        piece.checksum =
          checksum(theirs.data(), theirs.size() * sizeof(T), piece.checksum);
      }
    attempt([&]() {
      piece.begin = file->begin(name);
      written.push_back(piece);
    });
  }



  void
  GatheredFile::close()
  {
    attempt([&]() { file->close(); });
    file.reset();
    throw_together(failure, communicator);
  }



  template void
  ArrayFile::create<double>(const std::string &, const std::size_t);
  template void
  ArrayFile::create<std::uint64_t>(const std::string &, const std::size_t);
  template void
  ArrayFile::create<char>(const std::string &, const std::size_t);

  template void
  ArrayFile::write(const std::string &,
                   const std::size_t,
                   const double *,
                   const std::size_t);
  template void
  ArrayFile::write(const std::string &,
                   const std::size_t,
                   const std::uint64_t *,
                   const std::size_t);
  template void
  ArrayFile::write(const std::string &,
                   const std::size_t,
                   const char *,
                   const std::size_t);

  template void
  ArrayFile::read(const std::string &,
                  const std::size_t,
                  double *,
                  const std::size_t) const;
  template void
  ArrayFile::read(const std::string &,
                  const std::size_t,
                  std::uint64_t *,
                  const std::size_t) const;
  template void
  ArrayFile::read(const std::string &,
                  const std::size_t,
                  char *,
                  const std::size_t) const;

  template void
  GatheredFile::write(const std::string &, const double *, const std::size_t);
  template void
  GatheredFile::write(const std::string &,
                      const std::uint64_t *,
                      const std::size_t);
  template void
  GatheredFile::write(const std::string &, const char *, const std::size_t);
} // namespace limber
