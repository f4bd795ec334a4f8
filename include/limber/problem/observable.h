// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_observable_h
#define limber_problem_observable_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limber
{
  template <int dim>
  struct ObservableKind;



  /** A quantity that the scene asks for in every row of the statistics. */
  template <int dim>
  struct Observable
  {
    std::string                name;
    const ObservableKind<dim> *kind = nullptr;
    std::string                body; // empty: all bodies
    dealii::Point<dim>         location;
    // direction of a component, and of an extreme: +x, -x, +y, ...
    unsigned int axis     = 0;
    bool         positive = true;
    // second axis of a stress component: xx, xy, ...
    unsigned int second_axis = 0;
    // extreme coordinate: only points within this box, where given
    std::optional<std::pair<dealii::Point<dim>, dealii::Point<dim>>> within;
    std::string  observable; // frequency: of which other observable
    unsigned int side = 0;   // reaction force
    // obstacle force and moment: by its number
    unsigned int obstacle = 0;
    // state variable: by its number among those of the law of the body
    unsigned int variable = 0;
  };



  /** What kinds of observables observe. */
  enum class ObservedPart
  {
    place,    // position and velocity of the point near a place
    material, // the same and its stress, volume ratio and state
    body,     // sums over a body, or over all
    extent,   // largest coordinate of a body, or of all, in the direction
    largest,  // the largest value of a state variable in a body
    side,     // reaction force of a side of the box
    obstacle, // force and moment on an obstacle
    column    // another observable, over time
  };



  inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();



  /**
   * What an observable sees at one row, alike for material points and finite
   * elements: the part that its kind observes is filled. Unknown values are
   * NaN.
   */
  template <int dim>
  struct Seen
  {
    bool known = true; // else there is nothing to be seen
    // Place and material
    dealii::Point<dim>            position;     // m
    dealii::Tensor<1, dim>        displacement; // since the start, m
    dealii::Tensor<1, dim>        velocity;     // m/s
    dealii::SymmetricTensor<2, 3> stress;       // Cauchy, Pa
    double                        pressure     = not_known; // Pa
    double                        volume_ratio = not_known;
    // The named one of the law; of 'largest' that of all points
    double variable = not_known;
    // Body; gravitational energy is -sum of m g.x
    double                 mass = 0;             // kg
    dealii::Tensor<1, dim> momentum;             // kg m/s
    dealii::Tensor<1, dim> mass_moment;          // sum of m x, kg m
    double                 kinetic_energy   = 0; // J
    double                 strain_energy    = 0; // J
    double                 potential_energy = 0; // of gravity, J
    // The largest coordinate in the direction with its sign, m
    double extent = not_known;
    // Force of the material on the side or obstacle, N
    dealii::Tensor<1, dim> force;
    // Moment on the obstacle about its centre, N m; in the plane the last entry
    dealii::Tensor<1, 3> moment;
    double               frequency = not_known; // of the column, Hz
  };



  /**
   * A kind of observable: how the scene calls it, the entries that it must or
   * may be given, and its value, the sign of the direction left out.
   */
  template <int dim>
  struct ObservableKind
  {
    std::string              word, unit;
    ObservedPart             looks_at;
    std::vector<std::string> required, optional;
    double (*value)(const Observable<dim> &, const Seen<dim> &);
    unsigned int letters_of_direction = 1;
  };



  /** The list of kinds, see source/problem/observable_kinds.cc. */
  template <int dim>
  const std::vector<ObservableKind<dim>> &
  observable_kinds();

  /** The one with this word, which there must be. */
  template <int dim>
  const ObservableKind<dim> &
  observable_kind(const std::string &word);
} // namespace limber

#endif
