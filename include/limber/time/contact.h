// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_h
#define limber_time_contact_h

#include <limber/points/cell_batch.h>
#include <limber/time/contact_impulses.h>
#include <limber/time/integrator.h>

#include <map>
#include <unordered_map>
#include <vector>

namespace limber
{
  /** How many fields of nodes the bodies of a problem give to. */
  template <int dim>
  unsigned int
  n_nodal_fields(const Problem<dim> &problem);



  /**
   * Contact of bodies that have fields of nodes of their own, where the
   * material of their points ends (ContactImpulses). A point p of a that faces
   * the points q of b, with the normal n out of a, and how far the material of
   * points goes towards the other body, R, has the gap
   *
   *   g_p = sum_q w_q ((x_q - x_p) . n - R_q) - R_p
   *
   * over points whose edges overlap along the surface, with weights that fall
   * linearly with the distance along it: from point to point of b, its surface
   * is what lies between their ends. The gap grows by the relative velocity
   * there,
   *
   *   sum_q w_q (v_b + grad v_b d_q)(x_q) - (v_a + grad v_a R_p n)(x_p),
   *
   * with d_q from x_q to the place, which is therefore at least -g_p / dt. The
   * impulse that this takes acts there, on both. a is the one whose points are
   * smaller.
   *
   * With linear functions the velocity of what is outside its cell depends on
   * nodes that hardly have any mass, and jumps when points enter cells. There
   * impulses act at nodes at which both have mass, w = v_a - v_b, if the points
   * that see them touch, min_b (x . n - R) - max_a (x . n + R) <= 0.
   *
   * What presses in the new velocity does so in every other one of the step. So
   * momentum is kept, and energy does not grow.
   *
   * Normals are those of nodes at which both bodies have mass: of -g_b, g_a and
   * g_a - g_b, with the gradient of volume g = sum V grad N of each body, the
   * direction along which the points are furthest apart.
   *
   * Bodies of different fields that are in no pair stick together: both have
   * the velocity and the increment that one field would give them.
   */
  template <int dim>
  class Contact
  {
  public:
    explicit Contact(const RunParts<dim> &parts);

    /** Adopt a changed mesh, or another share of it. */
    void
    reinit();

    /** Where bodies touch; the masses of nodes are known. Collective. */
    void
    find(double step);

    /**
     * Hold the velocity at @p slot as the new one is going to be held, that is
     * (p + dt f) / m + dt g, with the force in the records.
     */
    void
    hold_before(unsigned int slot, double step);

    /** Exchange momentum: changes new velocities and increments. */
    void
    exchange();

    /** Hold another velocity as the new one has been held. */
    void
    hold(unsigned int slot);

    /**
     * The same of the velocity that points have given back, and account for
     * what they lose by that beyond exchange(), by the share of FLIP.
     */
    void
    hold_after(unsigned int slot, double flip_share);

  private:
    using Layout = NodeLayout<dim>;
    using Vector = dealii::Tensor<1, dim>;

    /** Two fields that have mass at a node. */
    struct Touch
    {
      std::uint32_t node;
      unsigned int  a, b;                   // fields
      Vector        gradient_a, gradient_b; // of volume, m^(dim-1)
      Vector        normal;
      bool          points_touch = false;
    };

    /** A point near another body. */
    struct Candidate
    {
      dealii::Point<dim> place;
      Vector             normal;   // out of its body
      Vector             velocity; // m/s
      double             reach;    // from the point to the end of its material
      double             width;    // half of its edge along the surface, m
      double             mass;     // kg
      std::uint32_t      body, point;
      unsigned int       rank;
    };

    /** Those of one side of a pair, found by place. */
    struct Side
    {
      std::vector<Candidate>                               all;
      std::vector<std::pair<std::uint64_t, std::uint32_t>> by_bin;
    };

    using Sides = std::array<Side, 2>;

    /** What places of this rank have of points of another one. */
    struct PartsElsewhere
    {
      std::vector<std::uint32_t> places;
      std::vector<double>        numbers;     // see ask_for_part()
      std::size_t                n_parts = 0; // where their number stands
    };

    /** How far apart two bodies are at a node along some directions, m. */
    struct Separation
    {
      std::array<Vector, 3> direction;
      // How far a goes along it, and b against it
      std::array<double, 3> furthest_a{{-1e300, -1e300, -1e300}};
      std::array<double, 3> furthest_b{{-1e300, -1e300, -1e300}};
    };

    /**
     * What ranks tell each other of the touches of two fields: n numbers a
     * node, of which the sums or the largest are wanted.
     */
    struct SharedSlots
    {
      SharedSlots(const unsigned int n, const bool of_largest)
        : n(n)
        , of_largest(of_largest)
        , nothing(of_largest ? -1e300 : 0)
      {}

      const unsigned int n;
      const bool         of_largest;
      const double       nothing; // of nodes that nothing was gathered at
      LazyArray<double>  records;
      RecordExchange     exchange{n};
    };

    /** What two fields do where they meet. */
    struct Law
    {
      ContactLaw law      = ContactLaw::stick;
      double     friction = 0;
    };

    /**
     * A node of a cell at which two fields touch, or one that hangs on such a
     * node and has a share of its function.
     */
    struct Corner
    {
      std::uint32_t touch;
      unsigned int  k; // its number in the cell
      double        share = 1;
    };

    /** Points of a body in a cell with such corners: [first, last). */
    struct Neighbours
    {
      unsigned int body;
      CellBatch    batch;
      std::size_t  first, last;
    };

    const Law &
    law(const unsigned int a, const unsigned int b) const
    {
      return laws[a * n_fields + b];
    }

    unsigned int
    field_of(const unsigned int body) const
    {
      return parts.bodies[body]->description.nodal_field;
    }

    void
    find_nodes();
    void
    find_neighbours();
    template <std::size_t n>
    bool
    may_touch(const std::array<std::uint32_t, n> &nodes) const;
    template <std::size_t n>
    void
    add_corners(unsigned int body, const std::array<std::uint32_t, n> &nodes);
    void
    add_corner(unsigned int field, std::uint32_t node, unsigned int k, double);
    void
    extend(const Neighbours     &some,
           const PointView<dim> &points,
           const Corner &);
    template <class Work>
    void
    for_each_neighbour(const Work &work);
    template <class SlotsOf>
    void
    share(SharedSlots &slots, const SlotsOf &slots_of);
    void
    find_gradients();
    void
    find_normals();

    void
    find_places(double step);
    void
    add_nodes();
    template <int degree>
    void
    gather(const std::array<unsigned int, 2> &pair, Sides &sides);
    void
    tell_candidates(std::vector<Sides> &sides);
    template <int degree>
    void
    add_points(const std::array<unsigned int, 2> &pair,
               Sides                             &sides,
               double                             step);
    template <int degree>
    void
    add_places(const Side &acting,
               const Side &other,
               double      spacing,
               const Law  &law,
               double      step);
    template <int degree>
    void
    add_part(const Candidate &candidate, const Vector &arm, double weight);
    void
    ask_for_part(std::uint32_t    place_number,
                 const Candidate &candidate,
                 const Vector    &arm,
                 double           weight);
    template <int degree>
    std::vector<typename ContactImpulses<dim>::Peer>
    exchange_parts();
    void
    join(unsigned int slot);

    const RunParts<dim> parts;
    const unsigned int  n_fields;
    std::vector<Law>    laws;
    std::vector<double> edge; // of the largest point of a field, m
    // Fields a < b that may part, in the same order on all ranks
    std::vector<std::array<unsigned int, 2>> parting;
    std::vector<Touch>       touches;  // those of a node side by side
    LazyArray<std::uint32_t> first_of; // by node: 1 + number of the first, or 0
    // By node: 1 + its number among those that hang, or 0; empty if none may
    LazyArray<std::uint32_t> hanging_of;
    std::vector<Neighbours>  neighbours;
    std::vector<Corner>      corners;     // of the neighbours
    std::vector<Separation>  separations; // of the touches
    std::vector<double>      half_edges;  // m, of the points of a batch
    SharedSlots              gradients{2 * dim, false}, extents{6, true};
    ContactImpulses<dim>     impulses;
    const unsigned int       this_rank;
    // Of vertices that other ranks hold as well: who does
    std::unordered_map<std::uint32_t, std::vector<unsigned int>>
                                           ranks_of_vertex;
    std::map<unsigned int, PartsElsewhere> parts_elsewhere;
    // By vertex: bit s where side s of a pair has points in a cell of it
    LazyArray<std::uint8_t>    of_pair_at;
    std::vector<std::uint32_t> marked; // those that have any
  };



  // work(neighbours, points, 1 / density of their body)
  template <int dim>
  template <class Work>
  void
  Contact<dim>::for_each_neighbour(const Work &work)
  {
    for (std::size_t k = 0; k < neighbours.size();)
      {
        const unsigned int   body   = neighbours[k].body;
        const PointView<dim> points = parts.bodies[body]->points.view();
        const double         inverse_density =
          1 / parts.bodies[body]->stress->density();
        for (; k < neighbours.size() && neighbours[k].body == body; ++k)
          work(neighbours[k], points, inverse_density);
      }
  }
} // namespace limber

#endif
