// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_adaptation_h
#define limber_adaptation_adaptation_h

#include <limber/adaptation/mesh_change.h>

#include <string>
#include <unordered_set>
#include <vector>

namespace limber
{
  /** State of the adaptation between steps; plain data, for checkpoints. */
  struct AdaptationState
  {
    // The mesh, and the one that criteria wanted when last evaluated; see
    // RefinedCells::numbers()
    std::vector<std::uint64_t> mesh, wanted;
    // For each body the next free point id, and the number of points created
    // since the start
    std::vector<std::uint64_t> next_id;
    std::uint64_t              points_added = 0;
    double                     way          = 0; // see Adaptation::is_due()
    std::uint64_t              steps        = 0; // since the last evaluation
    std::uint64_t points_joined = 0; // number of points removed by joining
    // For the report
    std::uint64_t times_asked = 0, mesh_changes = 0, points_split = 0;
  };



  /**
   * Adaptive mesh refinement (AMR) with points: the mesh follows the refinement
   * criteria of the scene, and points follow the mesh. A point in a cell of a
   * finer level than it was made for is split into 2^dim of half its size, or
   * 3^dim if it is observed, of which the middle one stays. If the scene
   * permits, points in a cell of a coarser level than theirs are joined, and
   * stretched ones divided. All member functions except mere queries are
   * collective.
   */
  template <int dim>
  class Adaptation
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;
    // Ids of observed points of each body, which have to stay in place
    using KeptPoints = std::vector<std::unordered_set<std::uint64_t>>;

    /** For a scene that has been set up; does nothing if it does not adapt. */
    Adaptation(const Problem<dim>  &problem,
               BackgroundGrid<dim> &grid,
               Bodies              &bodies);

    /**
     * Whether criteria have to be evaluated again; to be called once per step,
     * with the largest displacement of a point in the last one, in edges of the
     * smallest cells.
     */
    bool
    is_due(double displacement);

    /**
     * Evaluate the criteria at @p time, change the mesh, split and join points.
     * Returns whether anything has changed; then fields of nodes and cells have
     * to adopt the mesh.
     */
    bool
    adapt(double time, const KeptPoints &kept);

    /** Restore the mesh of a checkpoint; all points are discarded. */
    void
    restore(const AdaptationState &former);

    const AdaptationState &
    state() const
    {
      return memory;
    }

    /**
     * Kinetic and strain energy removed by the last adapt() on this rank, J;
     * negative if it was added.
     */
    double
    energy_removed() const
    {
      return removed;
    }

    /** Wall time spent in adaptation on this rank, s. */
    double
    seconds() const
    {
      return seconds_spent;
    }

    /** Text for the report: cells and points by level, over all ranks. */
    std::string
    report() const;

  private:
    /** Store the present mesh in the state. */
    void
    set_mesh(const RefinedCells<dim> &mesh);

    bool
    adapt_mesh(double time, const KeptPoints &kept);

    std::uint64_t
    take_numbers(std::size_t body, unsigned long own, std::uint64_t &first);

    bool
    divide_points(std::size_t                              body,
                  const std::unordered_set<std::uint64_t> &kept);

    std::vector<dealii::Tensor<1, dim>>
    normals_to_obstacles(const MaterialBody<dim>        &body,
                         const std::vector<std::size_t> &which,
                         double                          time) const;

    /** Whether any body is in the current frame, where its points move through
     * cells. */
    bool
    points_cross_cells() const;

    /**
     * Whether points are split before they enter fine cells: if no refinement
     * moves, as moving ones have a margin instead.
     */
    bool
    looks_ahead() const;

    /**
     * The time, s, within which points may enter fine cells ahead of them; zero
     * if these have a margin. Collective.
     */
    double
    seconds_to_look_ahead() const;

    bool
    split_points(const RefinedCells<dim> &mesh,
                 const KeptPoints        &kept,
                 double                   time);

    bool
    join_points(const KeptPoints &kept);

    const Problem<dim>  &problem;
    BackgroundGrid<dim> &grid;
    Bodies              &bodies;
    const double         longest_way; // between adaptations, in fine cells
    AdaptationState      memory;
    // Number of steps on the finest possible cells per step on this mesh
    std::uint64_t fine_steps_in_one = 1;
    unsigned int  finest_level      = 0; // reached so far in this run
    double        seconds_spent     = 0;
    double        removed           = 0;
  };
} // namespace limber

#endif
