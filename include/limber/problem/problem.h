// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_problem_h
#define limber_problem_problem_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <limber/base/functions.h>
#include <limber/base/text.h>
#include <limber/materials/frame.h>
#include <limber/materials/kernel.h>
#include <limber/materials/treatment.h>
#include <limber/problem/observable.h>
#include <limber/problem/obstacle.h>
#include <limber/problem/shapes.h>
#include <limber/problem/side_conditions.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/**
 * @file The input of a run as plain data, without mesh or points. It is filled
 * once by read_problem() and handed on as const.
 */
namespace limber
{
  /** How points are seeded in the cells. */
  enum class Placement
  {
    automatic, // chosen by what the body is, when the scene is read
    regular,   // cell edges divided evenly, points at the centres of the parts
    gauss,     // Gauss-Legendre places, weights into the masses
    jittered,  // regular, moved at random by up to a quarter of the spacing
    cut,       // regular, but the surface cuts parts, see seed()
    fitted     // a lattice in the natural coordinates of a box or block
  };

  /** What happens to the scatter of a history variable among the points of a
   * cell. */
  enum class HistoryTreatment
  {
    keep,     // every point keeps its own value
    relax,    // it tends to the mean of the cell within a given time
    crossing, // the same within the time in which points cross a cell
    replace   // it is replaced by the mean of the cell in every step
  };

  /** Which forces of a step are those of its end. */
  enum class TimeIntegration
  {
    explicit_steps, // none
    semi_implicit,  // the pressure of liquids
    implicit_steps, // all, along with those of the start
    quasi_static    // all, in equilibrium
  };

  /** Whether a step is solved by Newton's method. */
  constexpr bool
  is_solved_by_newton(const TimeIntegration integration)
  {
    return integration == TimeIntegration::implicit_steps ||
           integration == TimeIntegration::quasi_static;
  }

  /** Number of load steps of a quasi-static run with 'Time step' 0. */
  constexpr unsigned int default_load_steps = 10;

  /** When in a step the stress is updated. */
  enum class StressUpdateOrder
  {
    automatic, // chosen by the materials
    usf,       // update stress first (USF)
    usl,       // update stress last (USL)
    musl,      // USL with the velocity that points give back (MUSL)
    usavg      // half of it first, half last (USAVG)
  };

  /**
   * How points take their velocity from the nodes (doc/theory/transfers.md).
   */
  enum class Transfer
  {
    pic,
    flip,
    apic,
    aflip, // affine as APIC, increments as FLIP
    fmpm,  // full mass, of some order (FMPM(k))
    xpic   // the same for the velocity before the step (XPIC(k))
  };

  /** Whether points carry a velocity gradient, which P2G transfers to nodes. */
  constexpr bool
  is_affine(const Transfer transfer)
  {
    return transfer == Transfer::apic || transfer == Transfer::aflip;
  }

  /** Whether the velocity of the nodes is filtered before points take it. */
  constexpr bool
  filters_velocity(const Transfer transfer)
  {
    return transfer == Transfer::fmpm || transfer == Transfer::xpic;
  }

  /**
   * A load on one face of a box or block, or on the whole surface of a body of
   * any shape. A pressure acts along the present normal on the present area, a
   * function of the present place; a traction is a force per initial area, a
   * function of the initial place.
   */
  template <int dim>
  struct FaceLoad
  {
    std::string name;
    std::string body;
    // deal.II order: left right bottom top back front; empty: the surface
    std::optional<unsigned int> face;
    Formula<dim>                where; // 1 component; empty: everywhere
    bool                        is_pressure = true;
    Formula<dim> formula; // pressure: 1 component, Pa; traction: dim, Pa

    /** Whether this initial place of the face or surface bears the load. */
    bool
    acts_at(const dealii::Point<dim> &place) const
    {
      return where.empty() || where.value(place, 0.) > 0;
    }
  };

  /**
   * Initial stress of a solid: the overburden pressure of the weight above with
   * a lateral ratio K0, or all components by formulas. Cauchy stress, Pa;
   * components positive in tension, the overburden in compression.
   */
  template <int dim>
  struct InitialStress
  {
    Formula<dim> lateral_ratio; // K0; empty: components
    Formula<dim> overburden;    // pressure on the highest place; empty: none
    // xx, yy, zz, xy, yz, zx; empty: zero
    std::array<Formula<dim>, 6> components;
  };

  /** A deformable body as the scene describes it. */
  template <int dim>
  struct Body
  {
    std::string                       name;
    std::shared_ptr<const Shape<dim>> shape;
    std::array<unsigned int, dim>     points_per_cell_edge{};
    Placement                         placement = Placement::regular;
    // Of a box or block: number of parts along its edges in each natural
    // direction, for the placement 'fitted' and for the pieces of loaded faces
    std::array<unsigned int, dim>     lattice{};
    Formula<dim>                      initial_velocity; // dim components, m/s
    bool                              hydrostatic = false;
    std::optional<Formula<dim>>       initial_pressure; // 1 component, Pa
    std::optional<InitialStress<dim>> initial_stress;   // of solids

    std::string         law;      // by name, as in the list of laws
    std::vector<double> material; // its parameters, in the order of the law

    bool is_liquid  = false; // bears pressure, but no shape of its own
    bool is_plastic = false; // may flow plastically
    // Whether points at the surface remain there: it does not flow, or only as
    // metal does.
    bool keeps_surface = true;

    // By number of the law's state variable: 1 component each; those not given
    // are absent
    std::map<unsigned int, Formula<dim>> initial_state;

    Frame             frame             = Frame::current;
    Treatment         treatment         = Treatment::none;
    HourglassResponse hourglass         = HourglassResponse::bending;
    double            hourglass_control = 0; // chi, without dimension
    // Without dimension; where the pressure is implicit, the share gamma of the
    // compact Laplacian in its equation
    double checkerboard_control = 0;
    // C of the particle shifting of liquids, without dimension
    // (ParticleShifting)
    double particle_shifting = 0;
    // Whether the pressure at the end of the step is solved for, together with
    // the velocity
    bool implicit_pressure = false;
    // Whether the pressure system cuts off tension, if the pressure is
    // implicit; otherwise the law does
    bool cuts_tension = false;
    // Density control: share of the excess of the points' volume over that of a
    // node which a step removes, as far as the motion in it allows
    double density_control = 0;
    // of the volume ratio, and of the deviatoric strain
    HistoryTreatment history            = HistoryTreatment::keep;
    HistoryTreatment deviatoric_history = HistoryTreatment::keep;
    double           relaxation_time    = 0; // s, for HistoryTreatment::relax

    // Whether points are split where they are stretched so far that cells
    // between them would soon be empty
    bool splits_stretched_points = false;

    // Number of the nodal velocity field: bodies that may separate have
    // different ones (multi-field contact)
    unsigned int nodal_field = 0;

    // Whether contact with sides that have Side::meets_surfaces acts at the
    // surface of the body, as with obstacles, and not at nodes
    // (choose_side_contact())
    bool meets_sides = false;

    /** Mass per volume in the reference state, kg/m^3. */
    double
    density() const
    {
      return material.front();
    }
  };

  /** What a refinement criterion asks of a cell. */
  enum class RefinementCriterion
  {
    region,        // its place
    body,          // whether it holds points of certain bodies
    surface,       // its distance from an empty cell (free surface)
    obstacle,      // its distance from an obstacle
    contact,       // its distance from a body that may separate
    stress,        // the jump of mean stress to its neighbours
    rate,          // the shear rate
    plastic_strain // plastic strain
  };

  /** Whether the criterion compares an indicator of the cell with a scale. */
  inline bool
  has_scale(const RefinementCriterion criterion)
  {
    return criterion == RefinementCriterion::stress ||
           criterion == RefinementCriterion::rate ||
           criterion == RefinementCriterion::plastic_strain;
  }

  /**
   * Where cells of a level are wanted: a refinement criterion within a region.
   */
  template <int dim>
  struct Refinement
  {
    std::string         name;
    RefinementCriterion criterion = RefinementCriterion::region;
    unsigned int        level     = 1; // wanted there
    Corners<dim>        box;           // m
    Formula<dim>        where;    // 1 component, positive inside; empty: all
    bool depends_on_time = false; // the formula, or an obstacle that moves
    // Of 'surface', 'obstacle' and 'contact': range, in cells
    int distance = 1;
    // Of the criterion 'body', and those with a scale; empty: all
    std::vector<std::string> bodies;
    std::vector<std::string> obstacles; // of 'obstacle'; empty: all
    double scale = 0; // cells above it are refined; of 'stress' in Pa

    /** Whether the mesh may change during the run because of it. */
    bool
    is_moving() const
    {
      return (criterion != RefinementCriterion::region &&
              criterion != RefinementCriterion::obstacle) ||
             depends_on_time;
    }

    /** Whether it may ask for another mesh though no point has moved. */
    bool
    changes_mesh_at_rest() const
    {
      return depends_on_time || has_scale(criterion);
    }

    /** Whether the criterion 'obstacle' looks at one of this name. */
    bool
    looks_at(const std::string &obstacle) const
    {
      return criterion == RefinementCriterion::obstacle &&
             (obstacles.empty() ||
              std::find(obstacles.begin(), obstacles.end(), obstacle) !=
                obstacles.end());
    }
  };

  /** The box of the background grid, its kernel and its adaptive refinement. */
  template <int dim>
  struct GridDescription
  {
    dealii::Point<dim>            lower, upper;
    std::array<unsigned int, dim> cells{};
    KernelKind                    kernel = KernelKind::linear;
    // Why 'Kernel = auto' does not take splines in this scene; empty if it may
    std::string against_splines;
    // How often a cell may be refined; 0: uniform grid
    unsigned int                 levels = 0;
    std::vector<Refinement<dim>> refinements;
    unsigned int adapt_every = 0; // steps; 0: by the distance points have moved
    // Whether points that are finer than their cells may be merged
    bool joins_points = false;

    /** Whether criteria may ask for another mesh though no point has moved. */
    bool
    may_change_at_rest() const
    {
      for (const Refinement<dim> &refinement : refinements)
        if (refinement.changes_mesh_at_rest())
          return true;
      return false;
    }

    /** Edge of a cell of the finest level, m. */
    double
    finest_edge(const unsigned int direction) const
    {
      return edge(direction) / (1u << levels);
    }

    /** Edge of a cell, m; of the coarsest level. */
    double
    edge(const unsigned int direction) const
    {
      return (upper[direction] - lower[direction]) / cells[direction];
    }

    /** Whether a place is in the box and not in one of its sides. */
    bool
    has_inside(const dealii::Point<dim> &place) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (const double tolerance = 1e-9 * edge(d);
            place[d] < lower[d] + tolerance || place[d] > upper[d] - tolerance)
          return false;
      return true;
    }
  };

  /** Gravity, body force and loads on faces. */
  template <int dim>
  struct Loads
  {
    dealii::Tensor<1, dim>      gravity;    // m/s^2
    std::optional<Formula<dim>> body_force; // dim components, per mass, m/s^2;
                                            // empty where identically zero
    bool body_force_at_start = false;       // b of the initial place of a point
    std::vector<FaceLoad<dim>> faces;
    // Load factor of a quasi-static run, of gravity and loads: 1 component, a
    // function of time; empty: proportional to time, 1 at the end
    Formula<dim> factor;

    /** Whether the body force differs from place to place. */
    bool
    body_force_varies() const
    {
      return body_force && !body_force->is_uniform();
    }
  };

  /** Contact law of two bodies. */
  enum class ContactLaw
  {
    stick,   // common nodal velocity, as without a pair
    separate // unilateral contact, with Coulomb friction or without
  };

  /** Two bodies with a contact law of their own. */
  struct ContactPair
  {
    std::string                 name;
    std::array<unsigned int, 2> bodies; // by number
    ContactLaw                  law      = ContactLaw::separate;
    double                      friction = 0; // coefficient, without dimension
  };

  /** Time integration, transfer and their parameters. */
  struct Method
  {
    TimeIntegration   integration    = TimeIntegration::explicit_steps;
    StressUpdateOrder order          = StressUpdateOrder::automatic;
    Transfer          transfer       = Transfer::flip;
    unsigned int      transfer_order = 4; // k of FMPM(k) and XPIC(k)
    unsigned int transfer_period = 1; // filtered every so many steps, else FLIP
    double       blend_time      = 0; // s; FLIP share 1 - dt/time, 0: pure FLIP
    double       damping_rate    = 0; // alpha of the acceleration -alpha v, 1/s
    double       courant_number  = 0.4; // C
    double       time_step       = 0;   // s; 0: from the Courant number
    double       lost_points_limit = 0; // share of all points that may be lost
    double energy_growth_limit = 1; // drift over energy scale that stops a run
    // Of Newton's method: tolerance of the residual over forces; ghost penalty:
    // stiffness against jumps of the strain next to the surface, over Young's
    // modulus
    double newton_tolerance = 1e-6;
    double ghost_penalty    = 0.03;
    // Of implicit steps, at infinite frequency: 1, or below it
    // generalised-alpha
    double spectral_radius = 0.9;
  };

  /** What is written to the run folder, and how often. */
  struct OutputRequest
  {
    std::string              directory     = "output";
    bool                     replace       = false; // an existing run folder
    double                   time_interval = 0;     // s; 0: statistics only
    std::vector<std::string> fields;                // names of point fields
    bool                     point_arrays = false;  // HDF5 beside the pictures
    unsigned int             statistics_interval = 1; // steps
    double                   progress_interval   = 5; // s of wall time
  };

  /** When checkpoints are written, and when a run stops to be resumed. */
  struct CheckpointRequest
  {
    double       interval        = 3600; // s of wall time; 0: none
    unsigned int steps           = 0;    // between checkpoints; 0: none
    double       wall_time_limit = 0;    // s; 0: none
    bool         at_the_end      = true; // of a run that has finished
  };

  /**
   * Finite elements of the reference: displacement alone, or mixed (three
   * fields).
   */
  enum class ReferenceElement
  {
    q1,
    q2,
    q1_p0_p0, // displacement, pressure, volume ratio
    q2_p1_p1
  };

  /** Time integration of the reference. */
  enum class ReferenceMethod
  {
    quasi_static,   // load steps without inertia
    implicit_steps, // HHT-alpha (Newmark's formulas)
    explicit_steps  // central differences
  };

  /** How the finite element reference solution of the scene is computed. */
  struct ReferenceRequest
  {
    ReferenceElement          element    = ReferenceElement::q2_p1_p1;
    ReferenceMethod           method     = ReferenceMethod::implicit_steps;
    unsigned int              over_depth = 4; // elements
    std::vector<unsigned int> elements;       // along each direction, or empty
    std::string               mesh_file;      // empty: a mesh of our own
    unsigned int              refinements = 0;
    double                    time_step   = 0; // s; 0: from the wave speed
    unsigned int              load_steps  = 1;
    double                    tolerance   = 1e-8; // residual over forces
    unsigned int              frequencies = 0;    // how many; 0: solve in time
  };

  /** Exact solution: formulas of initial place and time; those not given are
   * empty. */
  template <int dim>
  struct ExactSolution
  {
    Formula<dim> displacement, velocity; // dim components, m, m/s
    Formula<dim> pressure;               // 1 component, Pa
  };

  /** A value that an observable should have, for the verdict of the run. */
  struct Check
  {
    std::string           name;
    std::string           observable;
    std::optional<double> at_time; // s; empty: at the end
    double                reference = 0;
    double                tolerance = 0;
  };

  /** All that a scene asks for; SI units. */
  template <int dim>
  struct Problem
  {
    double        end_time     = 1; // s
    unsigned long end_step     = 0; // 0: the time alone counts
    double        memory_limit = 0; // bytes, all ranks; 0: what the machine has
    std::vector<Body<dim>>       bodies;
    GridDescription<dim>         grid;
    Sides<dim>                   sides;
    Loads<dim>                   loads;
    std::vector<ContactPair>     contacts;
    std::vector<Obstacle<dim>>   obstacles;
    Method                       method;
    OutputRequest                output;
    CheckpointRequest            checkpoint;
    ReferenceRequest             reference;
    ExactSolution<dim>           exact;
    std::vector<Observable<dim>> observables;
    std::vector<Check>           checks;
    std::vector<std::string>     notes; // what the reader decided, for the log
    // Entries that a resumed run must not change, as "name = value"
    std::vector<std::string> fixed_entries;

    /** Whether all bodies of a nodal field have contact with the sides at their
     * surfaces, so that its nodes are free there. */
    bool
    meets_sides(const unsigned int nodal_field) const
    {
      return std::all_of(bodies.begin(),
                         bodies.end(),
                         [nodal_field](const Body<dim> &body) {
                           return body.meets_sides ||
                                  body.nodal_field != nodal_field;
                         });
    }

    /** Whether there are obstacles, or sides with contact at the surfaces of
     * bodies. */
    bool
    has_rigid_contact() const
    {
      return !obstacles.empty() ||
             std::any_of(sides.begin(), sides.end(), [](const auto &side) {
               return side.meets_surfaces;
             });
    }

    /** Whether the load factor is proportional to the time and 1 at the end of
     * the run; its formula, "t/2". */
    bool
    loads_grow_until_the_end() const
    {
      return method.integration == TimeIntegration::quasi_static &&
             loads.factor.empty();
    }

    std::string
    factor_until_the_end() const
    {
      return "t/" + to_text(end_time);
    }

    /** Whether stretched points of any body are split. */
    bool
    splits_stretched_points() const
    {
      for (const Body<dim> &body : bodies)
        if (body.splits_stretched_points)
          return true;
      return false;
    }

    /** Whether the mesh or the set of points changes during the run. */
    bool
    adapts() const
    {
      return grid.levels > 0 || splits_stretched_points();
    }

    /** Whether points keep their initial place beside the present one, for
     * pictures of displacements or for a body force of the material. */
    bool
    keeps_initial_places() const
    {
      return (output.time_interval > 0 && std::count(output.fields.begin(),
                                                     output.fields.end(),
                                                     "displacement") > 0) ||
             (loads.body_force_at_start && loads.body_force_varies());
    }
  };
} // namespace limber

#endif
