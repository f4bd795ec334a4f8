// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_law_list_h
#define limber_materials_law_list_h

#include <limber/materials/cam_clay.h>
#include <limber/materials/drucker_prager.h>
#include <limber/materials/j2.h>
#include <limber/materials/linear_elastic.h>
#include <limber/materials/neo_hookean.h>
#include <limber/materials/newtonian_fluid.h>

#include <string>
#include <tuple>
#include <variant>
#include <vector>

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
                             NewtonianFluid<true>,
                             J2,
                             DruckerPrager<false>,
                             DruckerPrager<true>,
                             CamClay>;



  namespace internal
  {
    template <class List>
    struct OneOf;

    template <class... Law>
    struct OneOf<std::tuple<Law...>>
    {
      using type = std::variant<Law...>;
    };
  } // namespace internal

  /** An object of one of these laws. */
  using AnyLaw = typename internal::OneOf<LawList>::type;



  /** Every law in the list, once: its name, its entries in the scene. */
  const std::vector<LawDescription> &
  describe_laws();



  /** Bulk and shear modulus of a law at rest, Pa. */
  struct Moduli
  {
    double bulk = 0, shear = 0;
  };

  /** For the law of that name; @p values in the order of its entries. */
  Moduli
  moduli_of(const std::string &law, const std::vector<double> &values);

  /**
   * The named history variables of that law: the last entries of its history,
   * in this order.
   */
  std::vector<StateVariable>
  variables_of(const std::string &law, const std::vector<double> &values);

  /** Why these values are not admissible together; empty if they are. */
  std::string
  objection_to(const std::string &law, const std::vector<double> &values);

  /**
   * Whether the law is viscoplastic: its stress depends on the rate of plastic
   * flow.
   */
  bool
  flows_by_rate(const std::string &law, const std::vector<double> &values);

  /**
   * Whether it is plastic with a strength that depends neither on the pressure
   * nor on the rate, as that of a metal.
   */
  bool
  flows_like_metal(const std::string &law, const std::vector<double> &values);

  /** The names of the variables of all laws, each once. */
  std::vector<std::string>
  names_of_variables();



  /** Call a generic function with a null pointer to each law in turn. */
  template <class Function, std::size_t... index>
  void
  for_each_law(const Function &function, std::index_sequence<index...>)
  {
    (function(static_cast<std::tuple_element_t<index, LawList> *>(nullptr)),
     ...);
  }



  template <class Function>
  void
  for_each_law(const Function &function)
  {
    for_each_law(function,
                 std::make_index_sequence<std::tuple_size_v<LawList>>());
  }
} // namespace limber

#endif
