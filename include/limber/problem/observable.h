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
    std::string                unit; // of its values
    const ObservableKind<dim> *kind = nullptr;
    std::string                body; // empty: all bodies
    dealii::Point<dim>         location;
    // direction of a component, and of an extreme: +x, -x, +y, ...
    unsigned int axis     = 0;
    bool         positive = true;
    // second axis of a stress component: xx, xy, ...
    unsigned int second_axis = 0;
    // only what is in this box, where given
    std::optional<std::pair<dealii::Point<dim>, dealii::Point<dim>>> within;
    double       share_beyond = 0; // extreme: of the mass that lies beyond it
    std::string  observable;       // column: of which other observable
    double       from_time = 0;    // column: rows before it do not count, s
    unsigned int side      = 0;    // reaction force

    bool
    is_within(const dealii::Point<dim> &place) const
    {
      if (within)
        for (unsigned int d = 0; d < dim; ++d)
          if (place[d] < within->first[d] || place[d] > within->second[d])
            return false;
      return true;
    }

    // obstacle force and moment: by its number
    unsigned int obstacle = 0;
    // state variable: by its number among those of the law of the body
    unsigned int variable = 0;
  };



  /** What kinds of observables observe. */
  enum class ObservedPart
  {
    place,           // position and velocity of the point near a place
    material,        // the same and its stress, volume ratio and state
    region,          // mass and velocity of what is in a region of space
    region_material, // the same and its stress
    body,            // sums over a body, or over all
    extent,          // largest coordinate of a body, or of all
    largest,         // the largest value of a state variable in a body
    side,            // reaction force of a side of the box
    obstacle,        // force and moment on an obstacle
    column           // another observable, over time
  };



  /** Whether the part is what is in a region of space. */
  inline bool
  is_region(const ObservedPart part)
  {
    return part == ObservedPart::region ||
           part == ObservedPart::region_material;
  }



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
    // Place and material; of a region means
    dealii::Point<dim>            position;     // m
    dealii::Tensor<1, dim>        displacement; // since the start, m
    dealii::Tensor<1, dim>        velocity;     // m/s
    dealii::SymmetricTensor<2, 3> stress;       // Cauchy, Pa
    double                        pressure     = not_known; // Pa
    double                        volume_ratio = not_known;
    // The named one of the law; of 'largest' that of all points
    double variable = not_known;
    // Body, the mass of a region as well; gravitational energy is -sum of m g.x
    double                 mass = 0;             // kg
    dealii::Tensor<1, dim> momentum;             // kg m/s
    dealii::Tensor<1, dim> mass_moment;          // sum of m x, kg m
    double                 kinetic_energy   = 0; // J
    double                 strain_energy    = 0; // J
    double                 potential_energy = 0; // of gravity, J
    // The largest coordinate in the direction with its sign, or that with a
    // share of the mass beyond, m
    double extent = not_known;
    // Force of the material on the side or obstacle, N
    dealii::Tensor<1, dim> force;
    // Moment on the obstacle about its centre, N m; in the plane the last entry
    dealii::Tensor<1, 3> moment;
    // Of the column: frequency, Hz; the others in its unit
    double frequency = not_known;
    double mean = not_known, smallest = not_known, largest = not_known;
  };



  /**
   * A kind of observable: how the scene calls it, the entries that it must or
   * may be given, and its value, the sign of the direction left out.
   */
  template <int dim>
  struct ObservableKind
  {
    std::string              word;
    std::string              unit; // empty: none, or that of the column
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
