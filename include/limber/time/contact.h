// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_h
#define limber_time_contact_h

#include <limber/points/cell_batch.h>
#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /** How many fields of nodes the bodies of a problem give to. */
  template <int dim>
  unsigned int
  n_nodal_fields(const Problem<dim> &problem);



  /**
   * Contact of bodies that have fields of nodes of their own, at nodes where
   * two fields have mass. There bodies press on each other if their new
   * velocities approach along the normal n, from a to b, and their points
   * touch:
   *
   *   (v_a - v_b) . n > 0,  min_b (x . n - R) - max_a (x . n + R) <= 0,
   *
   * over the points that see the node, with half their edge R. The impulse
   *
   *   J = m_r ((v_a - v_b) . n n + s),  m_r = m_a m_b / (m_a + m_b),
   *
   * with the sliding velocity s, or as much of it that m_r |s| is mu J_n
   * (Coulomb), goes from a to b. The normal is one for both: of -g_b, g_a and
   * g_a - g_b, with the gradient of volume g = sum V grad N of each body, the
   * direction along which the points are furthest apart. What presses in the
   * new velocity does so in every other one of the step: relative velocities
   * that J has taken away, trial velocities do not have either. So momentum is
   * kept, and energy does not grow.
   *
   * Bodies of different fields that are in no pair stick together: both have
   * the velocity and the increment that one field would give them.
   *
   * (Bardenhagen, Brackbill and Sulsky, CMAME 187, 2000; Nairn, Hammerquist and
   * Smith, CMAME 362, 2020, for contact that is decided by points)
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
    find();

    /**
     * Hold the velocity at @p slot as the new one is going to be held, that is
     * (p + dt f) / m, with the force in the records.
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

    enum class State
    {
      free,
      sliding,
      sticking
    };

    /** Two fields that have mass at a node. */
    struct Touch
    {
      std::uint32_t node;
      unsigned int  a, b;                   // fields
      Vector        gradient_a, gradient_b; // of volume, m^(dim-1)
      Vector        normal;
      bool          points_touch = false;
      State         state        = State::free;
      // Of the exchange, for the ledger: velocity of a against b as they have
      // been brought, and sliding afterwards, m/s; impulse of friction
      Vector brought, slides, rubbing;
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

    State
    decide(const Touch &touch, const Vector &v_a, const Vector &v_b) const;
    template <class Work>
    void
    for_each_held(unsigned int slot, const Work &work);
    void
    exchange(Touch &touch);
    void
    join(Touch &touch);

    const RunParts<dim> parts;
    const unsigned int  n_fields;
    std::vector<Law>    laws;
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
  };
} // namespace limber

#endif
