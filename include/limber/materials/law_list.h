// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_law_list_h
#define limber_materials_law_list_h

#include <limber/materials/linear_elastic.h>
#include <limber/materials/neo_hookean.h>
#include <limber/materials/newtonian_fluid.h>

#include <tuple>

namespace limber
{
  /**
   * The one list of laws. The factory, the sections of the scene file, the
   * help text and the typed test suites follow from it. Laws of one name are
   * variants: the first whose accepts() says yes is taken.
   */
  using LawList = std::tuple<LinearElastic,
                             NeoHookean,
                             NewtonianFluid<false>,
                             NewtonianFluid<true>>;
} // namespace limber

#endif
