// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_adaptation_h
#define limber_adaptation_adaptation_h

#include <limber/adaptation/mesh_change.h>

#include <string>
#include <unordered_set>
#include <vector>

namespace limber
{
  /** What an adaptation takes from step to step; plain, for checkpoints. */
  struct AdaptationState
  {
    // The mesh, and what criteria wanted when they were last asked; see
    // RefinedCells::numbers()
    std::vector<std::uint64_t> mesh, wanted;
    // Of each body, numbers that its points have had, and points made beyond
    // those of the start
    std::vector<std::uint64_t> next_id;
    std::uint64_t              points_added = 0;
    double                     way          = 0; // see Adaptation::is_due()
    std::uint64_t              steps        = 0; // since criteria were asked
    std::uint64_t points_joined = 0; // those that have gone in this way
    // For the report
    std::uint64_t times_asked = 0, mesh_changes = 0, points_split = 0;
  };



  /**
   * Lets the mesh follow what the scene's refinements want, and points follow
   * the mesh: one in a cell of a finer level than it was made for becomes 2^dim
   * of half its size, or 3^dim if it is observed, of which the middle one
   * stays. Where the scene allows it, points in a cell of a coarser level than
   * they were made for are joined, and stretched ones divided. Every member
   * function is collective but those that only tell something.
   */
  template <int dim>
  class Adaptation
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;
    // Numbers of points of each body that are observed: they stay where they
    // are
    using KeptPoints = std::vector<std::unordered_set<std::uint64_t>>;

    /** Of a scene set up; does nothing where it does not adapt. */
    Adaptation(const Problem<dim>  &problem,
               BackgroundGrid<dim> &grid,
               Bodies              &bodies);

    /**
     * To be called once per step, with the largest way of a point in the last
     * one, in edges of the smallest cells: whether it is time to ask the
     * criteria again.
     */
    bool
    is_due(double displacement);

    /**
     * Ask the criteria at @p time, change the mesh, split and join points;
     * returns whether anything has changed, and then fields of nodes and cells
     * have to adopt the mesh.
     */
    bool
    adapt(double time, const KeptPoints &kept);

    /** Make the mesh that of a checkpoint; points are lost. */
    void
    restore(const AdaptationState &former);

    const AdaptationState &
    state() const
    {
      return memory;
    }

    /** Kinetic and strain energy less by the last adapt() on this rank, J;
     * below zero where there is more. */
    double
    energy_removed() const
    {
      return removed;
    }

    /** Time that adapting has taken on this rank, s. */
    double
    seconds() const
    {
      return seconds_spent;
    }

    /** "points and cells by level ...", of all ranks, for the report. */
    std::string
    report() const;

  private:
    /** Keep on record what the mesh is. */
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
    normals_to_obstacles(const MaterialPoints<dim>      &points,
                         const std::vector<std::size_t> &which,
                         double                          time) const;

    /** Whether points are split before they come into fine cells: where no
     * refinement moves. */
    bool
    looks_ahead() const;

    /** In which points may come into fine cells that lie before them, s; zero
     * where there is a rim around these. Collective. */
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
    // Steps of the finest cells that there may be, in one on this mesh
    std::uint64_t fine_steps_in_one = 1;
    unsigned int  finest_level      = 0; // that there has been in this run
    double        seconds_spent     = 0;
    double        removed           = 0;
  };
} // namespace limber

#endif
