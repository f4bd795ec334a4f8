// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_loads_h
#define limber_time_loads_h

#include <limber/stress/stress_update.h>
#include <limber/time/hydrostatic_load.h>
#include <limber/time/loaded_face.h>

namespace limber
{
  /**
   * Body force formulas, loads on faces and surfaces of bodies, and what
   * gravity does where unequal cells meet (HydrostaticLoad). Their
   * forces are kept apart from the internal ones so that their work is known;
   * a scene without such loads has none of this.
   *
   * A piece of a face at the place x_p + r, where p is its carrier and r its
   * arm, moves with the velocity sum_i (N_i + r . grad N_i) v_i, the functions
   * taken at x_p; a force t on it gives (N_i + r . grad N_i) t to the nodes.
   * So the forces of the nodes have the sum and the moment of those on the
   * pieces, do the same work, and reach only nodes that have mass.
   */
  template <int dim>
  class ExternalLoads
  {
  public:
    ExternalLoads(const Problem<dim>                              &problem,
                  const BackgroundGrid<dim>                       &grid,
                  std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
                  CutCells<dim> *cut_cells = nullptr);

    bool
    any() const;

    /** Adopt a changed mesh. */
    void
    reinit();

    /** At the beginning of a step, when the sums of the cells are complete;
     * collective. */
    void
    look_at_cells(const NodalFields<dim> &nodes);

    /** Add the forces at @p time to those of active nodes, whose masses are
     * known; on request without FollowerLoads. Collective. */
    void
    add(NodalFields<dim> &nodes, double time, bool followers = true);

    /**
     * Deform the pieces of faces as the points around them are strained, while
     * these still are where they were. @p mean_gradients are those around
     * nodes of the dual domain method (DualDomainLayout); null elsewhere.
     */
    void
    deform(NodalFields<dim>  &nodes,
           const StressSweep &what,
           const double      *mean_gradients = nullptr);

    /** After points have changed ranks; collective. */
    void
    exchange_pieces();

    /** The pieces of each face load, for checkpoints. */
    using Pieces = std::vector<std::vector<FacePiece<dim>>>;
    Pieces
    pieces() const;
    void
    restore(const Pieces &pieces);

    /** See LoadedFace: for when points become others. Collective. */
    Pieces
    detached_pieces() const;
    void
    attach(const Pieces &detached);

    /** The sum of the forces on a node of a field, of the last add(), N. */
    dealii::Tensor<1, dim>
    on_node(unsigned int field, std::uint32_t node) const;

    /** In the order of the scene. */
    std::vector<LoadedFace<dim>> &
    loaded_faces()
    {
      return faces;
    }

  private:
    void
    add_body_force(const MaterialBody<dim> &body, double time);
    void
    add_uniform_force(const NodalFields<dim> &nodes,
                      unsigned int            field,
                      double                  time);
    void
    add_face_load(LoadedFace<dim> &face, double time);
    void
    complete(const NodalFields<dim> &nodes, LazyArray<double> &of_nodes);

    const Problem<dim>                              &problem;
    const BackgroundGrid<dim>                       &grid;
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies;
    std::vector<LoadedFace<dim>>                     faces;
    HydrostaticLoad<dim>                             hydrostatic;
    std::vector<LazyArray<double>> forces; // of fields: dim per node, N
    RecordExchange                 exchange{dim};
  };
} // namespace limber

#endif
