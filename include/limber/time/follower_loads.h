// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_follower_loads_h
#define limber_time_follower_loads_h

#include <limber/interpolation/support.h>
#include <limber/time/loads.h>
#include <limber/time/numbered_nodes.h>

#include <array>
#include <functional>
#include <vector>

namespace limber
{
  /**
   * Follower loads in steps that Newton's method solves: loads that depend on
   * the displacements u of the nodes in the step.
   *
   * Pressure on a face or surface of a body: a piece at x_p + r with the edges
   * a, whose carrier p has the shape functions N_i, moves to
   *
   *   x = x_p + r + sum_i w_i u_i,  w_i = N_i + r . grad N_i,
   *   a = a + sum_i u_i (a . grad N_i),
   *
   * and adds - p(x, t) w_i n da to the nodal forces, where n da is the cross
   * product of the edges (ExternalLoads, which has these pieces). r and a of
   * the start of the step are pulled back if gradients are those at initial
   * positions (total Lagrangian); forces then have the shares of
   * support_of_piece() for w_i.
   *
   * Body force that varies in space, as a field of the present place: a point
   * adds m_p N_i b(x_p + sum_j N_j u_j, t).
   */
  template <int dim>
  class FollowerLoads
  {
  public:
    /** The arguments must outlive the object. */
    FollowerLoads(const RunParts<dim>      &parts,
                  const NumberedNodes<dim> &nodes,
                  ExternalLoads<dim>       &loads)
      : parts(parts)
      , nodes(nodes)
      , loads(loads)
    {}

    /** Whether the scene has such loads; the same on all ranks. */
    bool
    any() const;

    /** Set up the pieces at the start of a step; points must be sorted and the
     * nodes numbered. */
    void
    find();

    /** Loads are those at @p new_time times @p new_factor. */
    void
    set(const double new_time, const double new_factor)
    {
      time   = new_time;
      factor = new_factor;
    }

    /** Add the forces on nodes by the pieces of this rank, N; all by equation
     * (NewtonEquations). Collective. */
    void
    add_forces(const std::vector<double> &displacement,
               std::vector<double>       &forces) const;

    using Add = std::function<void(const std::uint32_t *numbers,
                                   unsigned int         n_nodes,
                                   const double        *block)>;

    /**
     * Load stiffness: minus the derivative of these forces, N/m, as one
     * row-wise block per piece or point; or its symmetric part. Left out are
     * the change of a pressure with the position, and that of SurfaceClosure.
     */
    void
    add_tangent(const std::vector<double> &displacement,
                bool                       symmetric,
                const Add                 &add) const;

  private:
    struct Piece
    {
      const LoadedFace<dim>     *face;
      std::vector<std::uint32_t> numbers; // of nodes
      std::vector<double>        weights; // w_i, of forces
      std::vector<double>        moving;  // of displacements, as in deform()
      // a . grad N_i by edge
      std::array<std::vector<double>, dim - 1>    slopes;
      dealii::Point<dim>                          place; // m
      std::array<dealii::Tensor<1, dim>, dim - 1> edges; // m
    };

    bool
    has_pressures() const;
    bool
    has_body_force() const;
    using Numbers = typename NumberedNodes<dim>::Numbers;
    Support<dim>
    at_free_nodes(Support<dim> at, std::uint32_t cell) const;
    FacePiece<dim>
    moved(const Piece &piece, const std::vector<double> &displacement) const;
    double
    pressure(const Piece &piece, const FacePiece<dim> &at) const;
    void
    add_pressures(const LoadedFace<dim>     &face,
                  const std::vector<double> &displacement,
                  std::vector<double>       &forces) const;
    void
    add_tangent_of_pressures(const std::vector<double> &displacement,
                             bool                       symmetric,
                             const Add                 &add) const;
    void
    add_tangent_of_body_force(const std::vector<double> &displacement,
                              bool                       symmetric,
                              const Add                 &add) const;
    template <class Work>
    void
    for_each_point(const std::vector<double> &displacement,
                   const Work                &work) const;

    const RunParts<dim>       parts;
    const NumberedNodes<dim> &nodes;
    ExternalLoads<dim>       &loads;
    std::vector<Piece>        pieces;
    double                    time = 0, factor = 1;
  };
} // namespace limber

#endif
