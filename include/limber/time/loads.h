// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_loads_h
#define limber_time_loads_h

#include <limber/stress/stress_update.h>
#include <limber/time/dual_domain.h>
#include <limber/time/hydrostatic_load.h>
#include <limber/time/loaded_face.h>

namespace limber
{
  /**
   * External forces: body force formulas, loads on faces and surfaces of bodies
   * (tractions, pressures), and the correction of gravity in unequal cells
   * (HydrostaticLoad). They are stored apart from the internal forces so that
   * their work is known; a scene without such loads has no cost.
   *
   * A piece of a face at x_p + r, where p is its carrier and r its arm, moves
   * with the velocity sum_i (N_i + r . grad N_i) v_i, with the functions at
   * x_p; a force t on it adds (N_i + r . grad N_i) t to the nodes. So the nodal
   * forces have the sum and the moment of those on the pieces, do the same
   * work, and act only on nodes that have mass. In the initial frame a force
   * adds the functions at the place of the piece itself where its carrier is in
   * the same cell (support_of_piece()): forces then balance those of a constant
   * stress, also on curved surfaces, to the error of the pieces.
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

    /** Update the hydrostatic load at the beginning of a step, when the sums of
     * the cells are complete; collective. */
    void
    look_at_cells(const NodalFields<dim> &nodes);

    /** Add the forces at @p time to those of active nodes, whose masses are
     * known; without those of FollowerLoads unless @p followers. Collective. */
    void
    add(NodalFields<dim> &nodes, double time, bool followers = true);

    /**
     * Deform the pieces of faces with the velocity gradient at their carriers,
     * before points are moved. @p mean_gradients: those around nodes in the
     * dual domain method, by nodal field, else empty.
     */
    void
    deform(NodalFields<dim>                   &nodes,
           const StressSweep                  &what,
           const std::vector<DualDomain<dim>> &mean_gradients = {});

    /** After points have changed ranks; collective. */
    void
    exchange_pieces();

    /** The pieces of each face load, for checkpoints. */
    using Pieces = std::vector<std::vector<FacePiece<dim>>>;
    Pieces
    pieces() const;
    void
    restore(const Pieces &pieces);

    /** See LoadedFace: for when points are replaced. Collective. */
    Pieces
    detached_pieces() const;
    void
    attach(const Pieces &detached);

    /** Force on a node of a field in the last add(), N. */
    dealii::Tensor<1, dim>
    on_node(unsigned int field, std::uint32_t node) const;

    /** Loaded faces in the order of the scene. */
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
