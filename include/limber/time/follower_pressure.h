// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_follower_pressure_h
#define limber_time_follower_pressure_h

#include <limber/time/loads.h>
#include <limber/time/numbered_nodes.h>

#include <array>
#include <functional>
#include <vector>

namespace limber
{
  /**
   * Pressures on faces and surfaces of bodies in steps that Newton's method
   * solves: they follow the displacements u of the nodes in the step. A piece
   * at x_p + r with the edges a, whose carrier p has the functions N_i, goes to
   *
   *   x = x_p + r + sum_i w_i u_i,  w_i = N_i + r . grad N_i,
   *   a = a + sum_i u_i (a . grad N_i),
   *
   * and gives the nodes the forces - p(x, t) w_i n da, where n da is the cross
   * product of the edges (ExternalLoads, whose pieces these are). r and a of
   * the start of the step are pulled back where gradients are those of initial
   * places.
   */
  template <int dim>
  class FollowerPressure
  {
  public:
    /** All are those of the caller. */
    FollowerPressure(const RunParts<dim>      &parts,
                     const NumberedNodes<dim> &nodes,
                     ExternalLoads<dim>       &loads)
      : parts(parts)
      , nodes(nodes)
      , loads(loads)
    {}

    /** Whether the scene has pressures, on whatever rank. */
    bool
    any() const;

    /** The pieces as they are at the start of a step; points must be sorted and
     * the nodes numbered. */
    void
    find();

    /** Pressures are those of @p time times @p factor. */
    void
    set(const double new_time, const double new_factor)
    {
      time   = new_time;
      factor = new_factor;
    }

    /** Add the forces on nodes by the pieces of this rank, N; all by equation
     * (NewtonEquations). */
    void
    add_forces(const std::vector<double> &displacement,
               std::vector<double>       &forces) const;

    using Add = std::function<void(const std::uint32_t *numbers,
                                   unsigned int         n_nodes,
                                   const double        *block)>;

    /**
     * Minus the derivative of these forces, N/m, row by row of the nodes with
     * these numbers; or its symmetric part. That p may change with the place
     * is left out.
     */
    void
    add_tangent(const std::vector<double> &displacement,
                bool                       symmetric,
                const Add                 &add) const;

  private:
    struct Piece
    {
      const FaceLoad<dim>       *load;
      std::vector<std::uint32_t> numbers; // of nodes
      std::vector<double>        weights; // w_i
      // a . grad N_i by edge
      std::array<std::vector<double>, dim - 1>    slopes;
      dealii::Point<dim>                          place; // m
      std::array<dealii::Tensor<1, dim>, dim - 1> edges; // m
    };

    FacePiece<dim>
    moved(const Piece &piece, const std::vector<double> &displacement) const;
    double
    pressure(const Piece &piece, const FacePiece<dim> &at) const;

    const RunParts<dim>       parts;
    const NumberedNodes<dim> &nodes;
    ExternalLoads<dim>       &loads;
    std::vector<Piece>        pieces;
    double                    time = 0, factor = 1;
  };
} // namespace limber

#endif
