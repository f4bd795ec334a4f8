// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_integrator_h
#define limber_time_integrator_h

#include <limber/state/material_body.h>
#include <limber/time/filtered_node.h>
#include <limber/time/kept_node.h>
#include <limber/time/loads.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace limber
{
  /** The data of a run that steps work on; they outlive the integrator. */
  template <int dim>
  struct RunParts
  {
    const Problem<dim>                              &problem;
    BackgroundGrid<dim>                             &grid;
    NodalFields<dim>                                &nodes;
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies;
    Ledger<dim>                                     &ledger;
  };



  /** State of an integrator between steps; plain, for checkpoints. */
  template <int dim>
  struct IntegratorState
  {
    // Of the last step, over all ranks: m/s, m/s, cells, kg
    double                              wave_speed         = 0;
    double                              point_speed        = 0;
    double                              displacement       = 0;
    double                              largest_mass       = 0;
    unsigned long                       steps_since_filter = 0;
    double                              step               = 0; // s
    double                              way_since_shifting = 0; // cells
    typename ExternalLoads<dim>::Pieces face_pieces;
    double largest_force = 0; // so far, of steps in equilibrium, N
    double compliance    = 0; // of the first of these, m/N
    std::vector<FilteredNode<dim>> filtered_nodes;
    std::vector<KeptNode<dim>>     kept_nodes;
  };



  /** A point that a step has lost, and the name of its body. */
  template <int dim>
  using LostPointOfBody = std::pair<std::string, LostPoint<dim>>;



  /**
   * Interface of time integration. The points are the state: after
   * synchronise() it is complete, and pictures, rows and checkpoints are made
   * of it. All functions but plain queries are collective.
   *
   * An integrator decides itself whether to repeat a step. An explicit step is
   * done once. An implicit one may find no solution, or one that moves too far;
   * it then leaves points and ledger as they were, tries a shorter step, and
   * returns from advance() the length that was done.
   */
  template <int dim>
  class Integrator
  {
  public:
    virtual ~Integrator() = default;

    /**
     * To be called before each step, which begins at @p now: exchange points
     * between ranks or sort them, where due. Returns whether ranks have
     * exchanged points.
     */
    virtual bool
    reorganise(double now) = 0;

    /**
     * With functions that reach beyond the nodes of a cell (splines), send
     * points in ghost cells to the ranks that own these, which alone hold all
     * their nodes; nodal records become invalid. To be called before functions
     * are evaluated at points outside a step; returns whether there were any.
     */
    virtual bool
    bring_points_home() = 0;

    /** The longest step that may be asked for now, s. */
    virtual double
    longest_step() const = 0;

    /**
     * One step from @p time over at most @p step seconds; returns its length,
     * s, which is positive. Throws ComputationError when no step can be done.
     */
    virtual double
    advance(double time, double step) = 0;

    /**
     * Complete strain and stress up to the present time: a scheme may leave
     * them behind until they are needed. Later steps do not depend on whether
     * this was called, but for round-off.
     */
    virtual void
    synchronise() = 0;

    /** Adopt a mesh that has changed, and points that have moved with it. */
    virtual void
    reinit() = 0;

    virtual IntegratorState<dim>
    state() const = 0;

    /** Adopt points that have been replaced by those of a checkpoint. */
    virtual void
    restore(const IntegratorState<dim> &former) = 0;

    /** Detach the pieces of loaded faces from their points, and attach them
     * again after points have been replaced; see LoadedFace. Collective. */
    virtual typename ExternalLoads<dim>::Pieces
    detached_pieces() const = 0;
    virtual void
    attach(const typename ExternalLoads<dim>::Pieces &detached) = 0;

    /** Share of all points on the fullest rank times the number of ranks. */
    virtual double
    imbalance() const = 0;

    /** Bound of the displacement of points in the last step, in edges of the
     * smallest cells. */
    virtual double
    largest_displacement() const = 0;

    /** Whether any rank has lost points in the last step. */
    virtual bool
    points_were_lost() const = 0;

    /** Points that were lost in the last step, on this rank. */
    virtual const std::vector<LostPointOfBody<dim>> &
    lost_points() const = 0;

    /** The verbs of a step and the wall time each has taken here so far, s. */
    virtual std::vector<std::pair<std::string, double>>
    verb_seconds() const = 0;

    /** A line for the end of a run about work that varies; may be empty. */
    virtual std::string
    effort() const = 0;

    /** Why the last step was shorter than asked for: what is said of the
     * step, before 'over' and its length. */
    virtual std::string
    reason_for_shorter_step() const
    {
      return "no solution";
    }

    /** What happened in the last step that a user should know; said once,
     * empty otherwise. */
    virtual std::string
    warning()
    {
      return "";
    }
  };



  /** The integrator that the problem's method asks for. Collective. */
  template <int dim>
  std::unique_ptr<Integrator<dim>>
  make_integrator(const RunParts<dim> &parts);
} // namespace limber

#endif
