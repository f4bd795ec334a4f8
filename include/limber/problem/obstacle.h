// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_obstacle_h
#define limber_problem_obstacle_h

#include <limber/problem/shape.h>

#include <string>

namespace limber
{
  /**
   * A rigid obstacle with prescribed motion. Its material point X is at time t
   * at
   *
   *   x = c + Q(t) (X - c) + u(t),
   *
   * with the displacement u, and the rotation Q by an angle about an axis
   * through the centre c.
   */
  template <int dim>
  struct Obstacle
  {
    std::string                       name;
    std::shared_ptr<const Shape<dim>> shape; // where u = 0 and Q = 1
    // Friction coefficient (Coulomb); infinite: material sticks while it
    // presses on the obstacle
    double               friction = 0;
    dealii::Point<dim>   centre;       // c, m; moments are taken about c + u
    dealii::Tensor<1, 3> axis;         // of unit length
    Formula<dim>         displacement; // dim components, m; empty: none
    Formula<dim>         rotation;     // 1 component, rad; empty: none

    bool
    moves() const
    {
      return !displacement.empty() || !rotation.empty();
    }

    /** Whether its surface moves: not if it is a body of revolution that turns
     * about its own axis. */
    bool
    changes_place() const
    {
      return !displacement.empty() ||
             (!rotation.empty() && !shape->is_round_about(centre, axis));
    }
  };



  /** An obstacle in its position at some time. */
  template <int dim>
  class ObstaclePlace
  {
  public:
    ObstaclePlace(const Obstacle<dim> &obstacle, double time);

    /** From its surface in this position. */
    SignedDistance<dim>
    distance(const dealii::Point<dim> &place) const;

    /** Map from the present position to the initial one, and back. */
    dealii::Point<dim>
    start_of(const dealii::Point<dim> &place) const;
    dealii::Point<dim>
    place_of(const dealii::Point<dim> &start) const;

    /** c + u, the present centre */
    dealii::Point<dim>
    centre() const;

    /** Whether all formulas have finite values at this time. */
    bool
    is_finite() const;

  private:
    const Obstacle<dim>   *obstacle;
    bool                   moves;
    dealii::Tensor<1, dim> displacement;
    dealii::Tensor<2, dim> rotation; // Q
    bool                   finite = true;
  };



  /** The motion of an obstacle in a step. */
  template <int dim>
  struct ObstacleMotion
  {
    ObstacleMotion(const Obstacle<dim> &obstacle,
                   const double         time,
                   const double         step)
      : before(obstacle, time)
      , middle(obstacle, time + 0.5 * step)
      , after(obstacle, time + step)
      , step(step)
    {}

    /**
     * Velocity at a place, m/s: the mean one over the step of what of the
     * obstacle is there in the middle of the step. The chord from there at the
     * beginning points out of what turns: the pressure on a smooth disc that
     * turns about its centre would do work.
     */
    dealii::Tensor<1, dim>
    velocity(const dealii::Point<dim> &x) const
    {
      const dealii::Point<dim> start = middle.start_of(x);
      return (after.place_of(start) - before.place_of(start)) / step;
    }

    ObstaclePlace<dim> before, middle, after;
    double             step; // s
  };
} // namespace limber

#endif
