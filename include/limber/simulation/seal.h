// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_seal_h
#define limber_simulation_seal_h

#include <limber/output/array_file.h>

#include <string>
#include <vector>

namespace limber
{
  /** To be raised when the content of the files changes. */
  inline constexpr unsigned long checkpoint_format = 21;



  /**
   * Header of a checkpoint: a text in front of the HDF5 file with its kind, and
   * the sizes and checksums of all its content, including the text itself. So
   * every byte of the file is covered, and damage is detected before HDF5 opens
   * the file.
   */
  struct Seal
  {
    unsigned long          format  = 0;
    std::uint64_t          run     = 0; // a number that a run draws for itself
    unsigned long          step    = 0;
    double                 time    = 0; // s
    std::uint64_t          n_bytes = 0; // of the file
    std::vector<FilePiece> pieces;
    std::uint32_t          rest = 0; // checksum of all else: HDF5's tables
    std::uint32_t          own  = 0; // checksum of the text
    std::size_t            room = 0; // bytes of the text, a power of two
  };

  /** Bytes to be left in front of a file with arrays of these names. */
  std::size_t
  room_for_seal(const std::vector<std::string> &names);

  /**
   * Complete the seal of a file whose other bytes are final, put it into the
   * first Seal::room bytes and wait for the disk. Throws FileError.
   */
  void
  put_seal(const std::string &path, Seal &seal);

  /**
   * The seal of a file; the rest is not looked at, but for its length. Throws
   * DamagedFile; a file without a seal has the format 0 and nothing else.
   */
  Seal
  read_seal(const std::string &path);

  /** Throws DamagedFile unless the file is what its seal says. */
  void
  check_seal(const std::string &path, const Seal &seal);
} // namespace limber

#endif
