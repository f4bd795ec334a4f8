// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_pictures_h
#define limber_output_pictures_h

#include <limber/output/vtu.h>
#include <limber/state/material_body.h>

/** @file Contents of a picture, as patches for write_vtu(). */
namespace limber
{
  /** Patches with their fields, as write_vtu() writes them. */
  template <int patch_dim, int dim>
  struct Picture
  {
    PictureFields                                           fields;
    std::vector<dealii::DataOutBase::Patch<patch_dim, dim>> patches;
  };



  /**
   * The points of all bodies on this rank with the fields that the scene
   * names. Stress is Cauchy, with nine components in two dimensions too, as
   * plane strain has a stress zz. Collective.
   */
  template <int dim>
  Picture<0, dim>
  draw_points(const State<dim> &state);

  /**
   * The owned cells of the grid: mass and velocity of the nodes, and for
   * each body whose pressure is averaged that pressure and the mean volume
   * ratio; cells without it show 0 and 1. Collective.
   */
  template <int dim>
  Picture<dim, dim>
  draw_grid(const State<dim> &state);
} // namespace limber

#endif
