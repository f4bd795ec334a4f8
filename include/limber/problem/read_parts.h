// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_read_parts_h
#define limber_problem_read_parts_h

#include <limber/base/parameters.h>
#include <limber/problem/problem.h>

#include <map>
#include <string>
#include <vector>

/**
 * @file The parts of read_problem(), one file each. Every part declares its
 * entries, reads them, and refuses what contradicts a part before it. All read
 * functions throw InputError.
 */
namespace limber
{
  /** The names that a scene gives to things; they decide which sections exist.
   */
  struct SceneNames
  {
    std::vector<std::string> bodies, refinements, face_loads, contacts,
      obstacles, observables, checks;
    // Parts of a body's shape, where it is a union, by name of the body; and
    // of an obstacle's.
    std::map<std::string, std::vector<std::string>> shapes, obstacle_shapes;
  };

  // Small tools of the readers (source/problem/read_tools.cc)

  /** left, right, bottom, top, back, front: deal.II's order of faces. */
  std::vector<std::string>
  side_names(const unsigned int dim);

  /** Position in side_names(). */
  unsigned int
  side_index(const std::string &name);

  /** Sample places on the face of the box in a side, on a lattice, its corners
   * among them. */
  template <int dim>
  std::vector<dealii::Point<dim>>
  places_in_side(unsigned int side, const GridDescription<dim> &grid);

  /** The same text for each direction: "0, 0, 0". */
  std::string
  for_each_direction(const unsigned int dim,
                     const std::string &text,
                     const std::string &separator = ", ");

  /** The arguments of formulas for messages: "x, y, t" or "x, y, z, t". */
  std::string
  variable_names(const unsigned int dim);

  /** Declare the entry 'Constants' of a section. */
  void
  declare_constants(Parameters &parameters);

  /**
   * The constants of the top level and, with priority, those of the section.
   */
  Constants
  read_constants(const Section &section);

  template <int dim>
  dealii::Point<dim>
  read_point(const Section &section, const std::string &entry);

  /** The formula is evaluated once within @p box; it must be finite there. */
  template <int dim>
  Formula<dim>
  read_formula(const Section      &section,
               const std::string  &entry,
               const unsigned int  n_components,
               const Constants    &constants,
               const Corners<dim> &box);

  template <int dim>
  Corners<dim>
  corners(const GridDescription<dim> &grid);

  /** 'Lower corner' and 'Upper corner'; empty ones are taken from a default. */
  template <int dim>
  Corners<dim>
  read_corners(const Section &section, const Corners<dim> &default_box);

  /** "(1, 2)" */
  template <int dim>
  std::string
  to_text(const dealii::Point<dim> &point);

  /** The same with four significant digits, for messages. */
  template <int dim>
  std::string
  brief(const dealii::Point<dim> &point);

  /** Throws with a hint, unless @p name is one of @p known. */
  void
  check_name(const std::string              &kind,
             const std::string              &name,
             const std::vector<std::string> &known,
             const std::string              &where);

  // Grid, boundaries, loads (source/problem/read_grid.cc, read_loads.cc)

  void
  declare_grid(Parameters                     &parameters,
               const unsigned int              dim,
               const std::vector<std::string> &refinements);

  template <int dim>
  GridDescription<dim>
  read_grid(const Section &section, const std::vector<std::string> &bodies);

  // Levels of the grid (source/problem/read_levels.cc)

  /** Within the section 'Grid'. */
  void
  declare_levels(Parameters                     &parameters,
                 const unsigned int              dim,
                 const std::vector<std::string> &refinements);

  /**
   * From the section 'Grid'; needs its corners and cells, and the names of the
   * bodies.
   */
  template <int dim>
  void
  read_levels(const Section                  &section,
              const std::vector<std::string> &bodies,
              GridDescription<dim>           &grid);

  /** Refuses what does not work on cells of several sizes; needs all else. */
  template <int dim>
  void
  check_levels(const Section &root, const Problem<dim> &problem);

  void
  declare_boundaries(Parameters &parameters, const unsigned int dim);

  template <int dim>
  void
  read_boundaries(const Section &section, Problem<dim> &problem);

  void
  declare_loads(Parameters                     &parameters,
                const unsigned int              dim,
                const std::vector<std::string> &face_loads);

  /** Gravity and body force; needs the grid. */
  template <int dim>
  void
  read_volume_loads(const Section &section, Problem<dim> &problem);

  /** Needs the bodies. */
  template <int dim>
  void
  read_face_loads(const Section &section, Problem<dim> &problem);

  // Bodies (source/problem/read_shape.cc, read_material.cc, read_body.cc)

  void
  declare_shape(Parameters &parameters);

  /** The sections that details of the entry 'Shape' may be in. */
  void
  declare_shape_sections(Parameters                     &parameters,
                         const unsigned int              dim,
                         const std::vector<std::string> &union_parts);

  template <int dim>
  std::shared_ptr<const Shape<dim>>
  read_shape(const Section      &section,
             const Constants    &constants,
             const Corners<dim> &grid);

  void
  declare_material_sections(Parameters &parameters);

  /** Needs shape, initial velocity and gravity for the bulk modulus 'auto'. */
  template <int dim>
  void
  read_material(const Section &section, Body<dim> &body, Problem<dim> &problem);

  void
  declare_bodies(Parameters        &parameters,
                 const unsigned int dim,
                 const SceneNames  &names);

  /**
   * Resolves 'auto' of the frames, with a note for the log; refuses what a
   * frame cannot do (source/problem/frame.cc). Needs the sides, and of the
   * bodies all but treatment and points.
   */
  template <int dim>
  void
  choose_frames(const Section &root, Problem<dim> &problem);

  /** The same for the kernel (source/problem/kernel.cc); after the frames. */
  template <int dim>
  void
  choose_kernel(const Section &root, Problem<dim> &problem);

  /** Whether an entry is a positive number, not 'auto'. */
  bool
  is_switched_on(const Section &section, const std::string &control);

  /**
   * Notes for the log on motions of solids for which frame and kernel are
   * inaccurate: bending across the cells, torsion, rotation
   * (source/problem/solid_motion.cc).
   */
  template <int dim>
  void
  warn_of_solid_motion(const Section &root, Problem<dim> &problem);

  /**
   * Whether points can have affine velocities with increments (AFLIP). With
   * linear functions they then take the gradient of the new velocity, as with
   * USL. It is unbounded where a point is so close to an edge of its cell that
   * the nodes beyond have next to no mass (small cut), and the momentum that
   * points give back (P2G) includes it; APIC bounds it. Points of 'regular'
   * placement stay away from edges until they move, in the initial frame for
   * ever.
   */
  template <int dim>
  bool
  bounds_gradients(const Body<dim> &body, const GridDescription<dim> &grid);

  /**
   * Approximate angle, rad, by which the initial velocity rotates a body until
   * the end of the run, if nothing stops it (source/problem/solid_motion.cc).
   */
  template <int dim>
  double
  initial_rotation(const Body<dim> &body, double end_time);

  /** Rotation, rad, up to which a small-strain law in the initial frame is
   * accurate enough: it takes half the square of the angle for a strain. */
  inline constexpr double small_rotation = 0.1;

  /**
   * Whether a body cannot fold onto itself (self-contact): a ball, or a box or
   * block that is not slender (source/problem/solid_motion.cc).
   */
  template <int dim>
  bool
  is_compact(const Shape<dim> &shape);

  // Locking treatment, its stabilisation and histories
  // (source/problem/treatment.cc)

  void
  declare_treatment(Parameters &parameters);

  /** Needs shape, law, frame and kernel. */
  template <int dim>
  void
  read_treatment(const Section &section,
                 Body<dim>     &body,
                 Problem<dim>  &problem);

  /** Needs grid, sides and gravity; chooses the kernel with the frames. */
  template <int dim>
  void
  read_bodies(const Section &root, Problem<dim> &problem);

  // Stress and history at time 0 (source/problem/read_initial_state.cc)

  void
  declare_initial_state(Parameters &parameters, const unsigned int dim);

  /** Needs shape, material and gravity. */
  template <int dim>
  void
  read_initial_state(const Section      &section,
                     const Constants    &constants,
                     const Problem<dim> &problem,
                     Body<dim>          &body);

  // Placement of points (source/problem/read_placement.cc)

  /** Whether a shape is a block whose faces are all normal to the axes. */
  template <int dim>
  bool
  is_upright(const Shape<dim> &shape);

  /** With what the surfaces of bodies may come into contact in a scene. */
  struct Meetings
  {
    bool obstacles = false;
    bool bodies    = false; // each other, in contact pairs
    bool sides     = false; // sides that act at the surfaces of bodies
  };

  /** Number of points of a body and their placement; its shape and kernel are
   * known, and what it @p meets. */
  template <int dim>
  void
  read_placement(const Section  &section,
                 const Meetings &meets,
                 Body<dim>      &body,
                 Problem<dim>   &problem);

  // Contact of bodies (source/problem/read_contact.cc)

  void
  declare_contact(Parameters                     &parameters,
                  const std::vector<std::string> &pairs);

  /** The contact pairs and the nodal fields of bodies; needs the bodies and the
   * method, and refuses what does not go with it. */
  template <int dim>
  void
  read_contact(const Section &root, Problem<dim> &problem);

  // Rigid obstacles (source/problem/read_obstacles.cc)

  void
  declare_obstacles(Parameters        &parameters,
                    const unsigned int dim,
                    const SceneNames  &names);

  /** Needs grid and end time. */
  template <int dim>
  void
  read_obstacles(const Section &root, Problem<dim> &problem);

  /** Refuses what does not go with bodies and method, which are known. */
  template <int dim>
  void
  check_obstacles(const Section &root, const Problem<dim> &problem);

  // Method and output (source/problem/read_method.cc)

  void
  declare_method(Parameters &parameters);

  Method
  read_method(const Section &section);

  // Of bodies and method (source/problem/time_integration.cc)

  /** Time integration of the word 'auto', and which bodies have an implicit
   * pressure; throws InputError where that is not possible. */
  template <int dim>
  void
  choose_time_integration(const Section &root, Problem<dim> &problem);

  /** Resolves the 'History' of liquids that is 'auto'. Time integration,
   * bodies, sides and obstacles are known. */
  template <int dim>
  void
  choose_histories(const Section &root, Problem<dim> &problem);

  /** How clumping of points of liquids is prevented: Body::density_control and
   * particle_shifting. Time integration, bodies and obstacles are known. */
  template <int dim>
  void
  choose_density_control_and_shifting(const Section &root,
                                      Problem<dim>  &problem);

  // Steps by Newton's method (source/problem/newton_scene.cc)

  /** Throws InputError for what they do not support. */
  template <int dim>
  void
  check_newton_scene(const Section &root, Problem<dim> &problem);

  void
  declare_output(Parameters &parameters);

  OutputRequest
  read_output(const Section &section);

  void
  declare_checkpoint(Parameters &parameters);

  CheckpointRequest
  read_checkpoint(const Section &section);

  // Finite element reference, exact solution (source/problem/read_reference.cc)

  void
  declare_reference(Parameters &parameters, const unsigned int dim);

  ReferenceRequest
  read_reference(const Section &section,
                 const Method  &method,
                 const double   end_time);

  void
  declare_exact_solution(Parameters &parameters, const unsigned int dim);

  /** Needs the grid. */
  template <int dim>
  void
  read_exact_solution(const Section &section, Problem<dim> &problem);

  // Observables and checks (source/problem/read_observables.cc)

  void
  declare_observables(Parameters                     &parameters,
                      const unsigned int              dim,
                      const std::vector<std::string> &names);

  /** Needs grid and bodies. */
  template <int dim>
  void
  read_observables(const Section &root, Problem<dim> &problem);

  void
  declare_checks(Parameters &parameters, const std::vector<std::string> &names);

  /** Needs end time and observables. */
  template <int dim>
  void
  read_checks(const Section &root, Problem<dim> &problem);
} // namespace limber

#endif
