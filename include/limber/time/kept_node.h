// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_kept_node_h
#define limber_time_kept_node_h

#include <deal.II/base/tensor.h>

#include <cstdint>

namespace limber
{
  /**
   * What a node in contact keeps in the initial frame from one step to the
   * next, for checkpoints: the re-mapped velocity as contact constrains it, and
   * vectors whose product with the increment of the velocity in the next step
   * is energy lost by contact, across the surfaces and along them.
   */
  template <int dim>
  struct KeptNode
  {
    std::uint64_t          place    = 0;     // see places_of_nodes()
    bool                   is_owned = false; // else of its actions alone
    dealii::Tensor<1, dim> velocity;         // m/s
    dealii::Tensor<1, dim> across, along;    // kg m/s

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &place &is_owned &velocity &across &along;
    }
  };
} // namespace limber

#endif
