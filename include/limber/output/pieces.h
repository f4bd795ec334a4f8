// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_pieces_h
#define limber_output_pieces_h

#include <string>

namespace limber
{
  /**
   * Whether a file, by its name, is a piece of a series of pictures that a run
   * writes: "points_00012.vtu" is one of the series "points", and so is
   * "points_00012.h5".
   */
  bool
  is_piece(const std::string &file, const std::string &series);

  /**
   * Whether it is what a run leaves that is killed while it writes a piece:
   * "points_00012.vtu.part", or Open MPI's lock on it,
   * "points_00012.vtu.part-1-4711.lock".
   */
  bool
  is_unfinished_piece(const std::string &file, const std::string &series);
} // namespace limber

#endif
