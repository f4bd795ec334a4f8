// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_h
#define limber_time_contact_h

#include <limber/time/contact_impulses.h>
#include <limber/time/integrator.h>
#include <limber/transfer/surface_points.h>

#include <map>
#include <unordered_map>
#include <vector>

namespace limber
{
  /** Number of nodal velocity fields that the bodies of a problem use. */
  template <int dim>
  unsigned int
  n_nodal_fields(const Problem<dim> &problem);



  /**
   * Multi-field contact: contact of bodies that have nodal fields of their own,
   * at the surfaces of their material (ContactImpulses). A point p of a that
   * faces the points q of b, with the normal n out of a and the extent R of the
   * material of a point towards the other body, has the gap
   *
   *   g_p = sum_q w_q ((x_q - x_p) . n - R_q) - R_p
   *
   * over points whose edges overlap along the surface, with weights that fall
   * linearly with the distance along it, so that the surface of b interpolates
   * between its points. The rate of the gap is the relative velocity there,
   *
   *   sum_q w_q (v_b + grad v_b d_q)(x_q) - (v_a + grad v_a R_p n)(x_p),
   *
   * with d_q from x_q to the contact point. It must be at least -g_p / dt; the
   * impulse that this takes acts there, on both. a is the one whose points are
   * smaller.
   *
   * With linear functions the velocity extrapolated out of a point's cell
   * depends on nodes with hardly any mass, and jumps when points cross cells.
   * There impulses act at nodes at which both have mass, w = v_a - v_b, if the
   * points around them touch, min_b (x . n - R) - max_a (x . n + R) <= 0. They
   * do so in all methods of linear functions (GIMP, CPDI, DDMP): means over
   * domains are smooth, but their gradients see light nodes as well, and bodies
   * held at points were thrown off (doc/theory/contact.md).
   *
   * Contacts that are active in the new velocity are so in every other velocity
   * of the step. So momentum is conserved, and energy does not grow.
   *
   * Normals are those of nodes at which both bodies have mass. That of a body
   * there is its volume gradient, g = sum V grad N, corrected by a plane fitted
   * to the surface of its points (SurfaceFit). Of those of a, of b and the mean
   * the one is taken along which the material of the two is furthest apart.
   *
   * Bodies of different fields that are in no pair stick together: both have
   * the velocity and the increment that one field would give them.
   *
   * Theory: doc/theory/contact.md.
   */
  template <int dim>
  class Contact
  {
  public:
    explicit Contact(const RunParts<dim> &parts);

    /** Adopt a changed mesh, or another partition of it. */
    void
    reinit();

    /** Contact search: normals, gaps and contact points of this step. The
     * masses of nodes are known. Collective. */
    void
    find(double step);

    /** Whether there may be active contacts, see ContactImpulses::any(). */
    bool
    any() const
    {
      return impulses.any();
    }

    /**
     * Constrain the velocity at @p slot with the contacts that a prediction of
     * the new one, (p + dt f) / m + dt g, makes active; the force is in the
     * records.
     */
    void
    hold_before(unsigned int slot, double step);

    /** Apply contact impulses to new velocities and increments. */
    void
    exchange();

    /** Constrain another velocity with the active contacts of exchange(). */
    void
    hold(unsigned int slot);

    /**
     * The same for the re-mapped velocity, and account for the energy that
     * points lose by that beyond exchange(), by the share of FLIP.
     */
    void
    hold_after(unsigned int slot, double flip_share);

  private:
    using Layout = NodeLayout<dim>;
    using Vector = dealii::Tensor<1, dim>;

    /** Two fields that have mass at a node. */
    struct ContactNode
    {
      std::uint32_t node;
      unsigned int  a, b; // fields

      bool
      operator==(const ContactNode &other) const
      {
        return node == other.node && a == other.a && b == other.b;
      }
    };

    /** A point near another body. */
    struct Candidate
    {
      dealii::Point<dim> place;
      Vector             normal;   // outward
      Vector             velocity; // m/s
      double             reach;    // from the point to the end of its material
      double             width;    // half of its edge along the surface, m
      double             mass;     // kg
      std::uint32_t      body, point;
      unsigned int       rank;
    };

    /** Candidates of the two bodies of a pair. */
    using Sides = std::array<std::vector<Candidate>, 2>;

    /** Spatial hash of candidates: a table of bins of equal edges. */
    struct Bins
    {
      void
      fill(const std::vector<Candidate> &candidates, double edge);

      /** List those in the bin of a place and next to it. */
      const std::vector<std::uint32_t> &
      around(const dealii::Point<dim> &place);

    private:
      static constexpr std::uint32_t none = std::uint32_t(-1);

      using Bin = std::array<std::int64_t, dim>;

      Bin
      at(const dealii::Point<dim> &place) const;
      static std::uint64_t
      key(const Bin &bin);
      std::size_t
      entry(std::uint64_t key) const;

      double                     inverse_edge = 0;
      std::vector<std::uint64_t> keys;  // of the entries in use
      std::vector<std::uint32_t> first; // of each entry, or none
      std::vector<std::uint32_t> next;  // of each candidate
      Bin                        last{};
      bool                       knows_last = false;
      std::vector<std::uint32_t> found; // around the last one
    };

    /** Parts of contact points of this rank that come from points of another
     * rank. */
    struct PartsElsewhere
    {
      std::vector<std::uint32_t> places;
      std::vector<double>        numbers;     // see ask_for_part()
      std::size_t                n_parts = 0; // index of their count in these
    };

    /**
     * Reduction over ranks at the contact nodes of two fields: sums or maxima
     * of n numbers per node.
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
      const double       nothing; // neutral element of the reduction
      LazyArray<double>  records;
      RecordExchange     exchange{n};
    };

    /** Contact law of two fields. */
    struct Law
    {
      ContactLaw law      = ContactLaw::stick;
      double     friction = 0;
    };

    /** Nodes of a cell at which the bodies of a field may touch others: range
     * [first, last) of the corners. */
    struct ContactCellNodes
    {
      std::uint32_t first, last;
    };

    /** Batches of a body in cells with such nodes: range [first, last). */
    struct Group
    {
      unsigned int body;
      std::size_t  first, last;
    };

    /** Stretch of the points of a body in contact. */
    struct Stretch
    {
      double       largest = 1; // normal to its surface
      unsigned int age     = 0; // steps counted; updated every some of them
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
    find_reaches();
    void
    find_cells();
    bool
    find_nodes();
    void
    forget_cell_nodes();
    void
    find_batches();
    bool
    may_have_corners(const unsigned int field, const std::uint32_t cell) const
    {
      return cell_nodes_of[std::size_t(parts.grid.n_cells()) * field + cell] !=
             1;
    }
    std::uint32_t
    find_cell_nodes(unsigned int field, std::uint32_t cell);
    template <std::size_t n>
    void
    add_corners(unsigned int field, const std::array<std::uint32_t, n> &nodes);
    void
    add_corner(unsigned int field, std::uint32_t node, unsigned int k, double);
    MeetingBatches
    batches_of(const Group &group) const;
    template <class SlotsOf>
    void
    share(SharedSlots &slots, const SlotsOf &slots_of);
    void
    find_gradients();
    void
    end_at_sides();
    void
    fit_surfaces();
    void
    find_normals();

    void
    find_places(double step);
    void
    add_nodes();
    template <int degree>
    void
    gather(const Group &group);
    double
    stretch_of(const Group &group);
    void
    tell_candidates();
    template <int degree>
    void
    add_points(const std::array<unsigned int, 2> &pair,
               const Sides                       &both,
               double                             step);
    template <int degree>
    void
    add_places(const std::vector<Candidate> &acting,
               const std::vector<Candidate> &other,
               double                        spacing,
               const Law                    &law,
               double                        step);
    template <int degree>
    void
    add_part(const Candidate &candidate, const Vector &arm, double weight);
    template <int degree>
    void
    finish_part();
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

    /** A point of the other body that a point faces, see add_places(). */
    struct Facing
    {
      std::uint32_t candidate;
      double        gap, weight;
      Vector        along;
    };

    bool
    is_covered(const Facing &q, const std::vector<Candidate> &other) const;

    /** Share of a contact point that comes from the points of one cell, summed
     * up before it goes to ContactImpulses. */
    struct Part
    {
      static constexpr std::uint32_t no_cell = invalid_cell;
      static constexpr int n_nodes = dim == 2 ? 16 : 64; // of cubic splines

      std::uint32_t               cell = no_cell;
      unsigned int                field;
      std::array<double, n_nodes> shares, sizes; // of the nodes of the cell
    };

    const RunParts<dim> parts;
    const unsigned int  n_fields;
    std::vector<Law>    laws;
    std::vector<double> edge;  // of the largest point of a field, m
    std::vector<double> reach; // largest extent of a point of a field, m
    // Pairs of fields a < b that may separate, in the same order on all ranks
    std::vector<std::array<unsigned int, 2>> parting;
    GridView<dim>                            grid;   // as of this step
    std::vector<PointView<dim>>              points; // of the bodies, likewise
    // By body, the cells of its points in the step before
    std::vector<std::vector<std::uint32_t>> cells_of;
    bool                     cells_are_others = true; // changed in this step
    std::vector<ContactNode> contact_nodes; // those of a node side by side
    std::vector<ContactNode> found;         // those of this step
    LazyArray<std::uint32_t> first_of; // by node: 1 + number of the first, or 0
    // By node: 1 + its number among those that hang, or 0; empty if none may
    LazyArray<std::uint32_t> hanging_of;
    // By field and cell: 2 + its number in cell_nodes, 1 without corners, 0
    // where not yet determined since the contact nodes changed
    LazyArray<std::uint32_t>      cell_nodes_of;
    std::vector<std::uint32_t>    looked_at; // entries of these that are not 0
    std::vector<ContactCellNodes> cell_nodes;
    std::vector<MeetingCorner>    corners; // of these
    std::vector<MeetingBatch>     batches; // of points in cells with such nodes
    std::vector<Group>            groups;  // of these
    std::vector<double>           volume_gradients; // in slots, m^(dim-1)
    std::vector<double>           directions;       // of the nodes, see Extents
    Extents<dim>                  extents;
    std::vector<Faces<dim>>       faces;        // of the nodes
    std::vector<char>             points_touch; // likewise
    std::vector<SurfaceFit<dim>>  fits;         // in slots
    SurfacePoints<dim>            surface;      // of a body
    SharedSlots                   gradients_of_ranks{2 * dim, false};
    SharedSlots                   fits_of_ranks{2 * SurfaceFit<dim>::n, false};
    SharedSlots                   extents_of_ranks{2 * n_separations, true};
    ContactImpulses<dim>          impulses;
    std::vector<Stretch>          stretches; // of the bodies
    std::vector<Sides>            sides;     // of the pairs
    std::vector<std::uint32_t>    near;      // points of a batch
    Bins                          bins;
    std::vector<Facing>           facing;
    Part                          part;
    const unsigned int            this_rank;
    // Ranks that share a vertex with this one
    std::unordered_map<std::uint32_t, std::vector<unsigned int>>
                                           ranks_of_vertex;
    std::map<unsigned int, PartsElsewhere> parts_elsewhere;
  };



  // Reduce over all ranks that share a node what each has summed over its own
  // points.
  template <int dim>
  template <class SlotsOf>
  void
  Contact<dim>::share(SharedSlots &slots, const SlotsOf &slots_of)
  {
    const ExchangePlan &plan = parts.nodes.node_plan();
    if (plan.neighbours.empty())
      return;
    const unsigned int n = slots.n;
    if (slots.records.size() != std::size_t(parts.nodes.table.n()) * n)
      slots.records.reinit(std::size_t(parts.nodes.table.n()) * n);
    double *const records = slots.records.data();
    const auto    clear   = [&](const std::vector<std::uint32_t> &nodes) {
      for (const std::uint32_t node : nodes)
        std::fill_n(records + std::size_t(node) * n, n, slots.nothing);
    };
    // work(slot of the contact node, slot of the record)
    const auto for_each_slot = [&](const auto &pair, const auto &work) {
      for (std::size_t t = 0; t < contact_nodes.size(); ++t)
        if (contact_nodes[t].a == pair[0] && contact_nodes[t].b == pair[1])
          {
            double *record = records + std::size_t(contact_nodes[t].node) * n;
            for (double *const slot : slots_of(t))
              work(*slot, *record++);
          }
    };
    for (const auto &pair : parting)
      {
        for (const auto &neighbour : plan.neighbours)
          {
            clear(neighbour.send);
            clear(neighbour.receive);
          }
        for_each_slot(pair, [](double &own, double &shared) { shared = own; });
        slots.exchange.start(plan, records, 0, n);
        if (slots.of_largest)
          slots.exchange.finish_largest(records);
        else
          slots.exchange.finish(records);
        for_each_slot(pair, [](double &own, double &shared) { own = shared; });
      }
  }
} // namespace limber

#endif
