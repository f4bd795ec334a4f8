// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_impulses_h
#define limber_time_contact_impulses_h

#include <limber/grid/nodal_fields.h>

#include <vector>

namespace limber
{
  /**
   * Impulses at places that touch. At place p the velocity of the nodes
   * against what it touches is
   *
   *   w_p = sum_i a_pi v_i - v_p,
   *
   * with a_pi the functions of the nodes there. The impulses J_p that it gets
   * go to the nodes with the same numbers, m_i dv_i = sum_p a_pi J_p, and are
   * those with
   *
   *   J_n >= 0,  w_n >= least,  J_n (w_n - least) = 0,
   *   |J_t| <= mu J_n,  w_t = 0 where it is less        (Coulomb),
   *
   * found by a few passes of a projected Jacobi method. With the masses M_i of
   * nodes that belong to the places, M_i = sum_p |a_pi| m_p, a pass changes
   * J_p by m_p (least - w_n) / s_p with s_p = sum_i |a_pi| M_i / m_i: what is
   * the same at all places is right after one pass, and nothing overshoots.
   * All of them are found together, so that it does not matter how many places
   * or obstacles a node sees; functions may be those of any kernel.
   */
  template <int dim>
  class ContactImpulses
  {
  public:
    using Vector = dealii::Tensor<1, dim>;

    struct Place
    {
      Vector normal;       // out of what is touched, of unit length
      Vector velocity;     // v_p: of what is touched, m/s
      double least    = 0; // m/s
      double friction = 0; // mu; infinite where what presses sticks
      double mass     = 0; // m_p, kg: by what share it bears
      Vector impulse;      // J, kg m/s

      bool
      presses() const
      {
        return impulse * normal > 0;
      }

      // Of the nodes it sees, [begin, end) of all shares
      std::size_t begin = 0, end = 0;
      double      relaxation = 0; // m_p / s_p, kg
      bool        sticks     = false;
      bool        is_own     = true; // counted on this rank
      Vector      relative;          // w_p, m/s
    };

    /** Places that have parts on two ranks, in the same order on both. */
    struct Peer
    {
      unsigned int               rank;
      std::vector<std::uint32_t> own;   // those of this rank, a part is there
      std::vector<std::uint32_t> parts; // those of that rank, a part is here
    };

    explicit ContactImpulses(NodalFields<dim> &nodes);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Forget all places; those that there were are the former ones. */
    void
    clear();

    /**
     * The same as at(), of a former place: in the initial frame, where nodes
     * stay what they were.
     */
    Vector
    at_former(const Place &place, unsigned int slot) const;

    const std::vector<Place> &
    all_former() const
    {
      return former_places;
    }

    /** The next place; its nodes follow by add_share(). */
    Place &
    add_place();

    /** Of the last place: a node that it sees, of the grid, with a_pi. */
    void
    add_share(unsigned int field, std::uint32_t node, double share);

    /**
     * Call work(node, weight) with the nodes whose velocities make up that of
     * a node of the grid: itself, or the masters of one that hangs.
     */
    template <class Work>
    void
    for_each_master(const std::uint32_t node, const Work &work) const
    {
      if (!hanging.empty() && hanging[node] > 0)
        for (const auto &[master, weight] :
             nodes.table.hanging[hanging[node] - 1].masters)
          work(master, weight);
      else
        work(node, 1.);
    }

    /**
     * After all of these; masses of nodes are known. Collective. Places of a
     * rank are its own, apart from those with parts elsewhere, which @p peers
     * names by rank.
     */
    void
    finish_adding(std::vector<Peer> &&peers = {});

    /**
     * The same of places at nodes, of two fields each, of which each rank has
     * all that it holds: nothing has to be summed up.
     */
    void
    finish_adding_nodes();

    /** Whether there is any on any rank. */
    bool
    any() const
    {
      return any_place;
    }

    std::vector<Place> &
    all()
    {
      return places;
    }

    /** sum_i a_pi of the vector at a slot of the records. */
    Vector
    at(const Place &place, unsigned int slot) const;

    /** Find w_p of all places, of the vector at a slot of the records. */
    void
    find_relative(unsigned int slot);

    /**
     * Find the impulses that the velocities (p + dt f) / m + g dt would have.
     */
    void
    expect(double step, const Vector &gravity);

    /**
     * Find the impulses that the new velocities have, from what was expected,
     * and give them to these and to their increments.
     */
    void
    exchange();

    /**
     * Bring another velocity to the least one where places press, and to rest
     * along the surface where they stick. Returns the impulses which that
     * takes, one per place.
     */
    const std::vector<Vector> &
    hold(unsigned int slot);

  private:
    using Layout = NodeLayout<dim>;

    struct Share
    {
      std::uint32_t node;
      unsigned int  field;
      double        value; // a_pi
    };

    // Momentum that places give to the nodes of a field in a pass, or the mass
    // M_i; a record has both
    struct Given
    {
      static constexpr unsigned int momentum = 0;
      static constexpr unsigned int mass     = dim;
      static constexpr unsigned int stride   = dim + 1;

      LazyArray<double>          records;
      RecordExchange             exchange{stride};
      std::vector<std::uint32_t> nodes; // that any place sees, on any rank
    };

    Vector
    sum(const Place              &place,
        const std::vector<Share> &of_places,
        unsigned int              slot) const;
    template <class Velocity>
    void
    find_relative_of(const Velocity &velocity);
    void
    find_relaxation();
    void
    complete();
    void
    sum_given(Given &of_field, unsigned int first, unsigned int last);
    void
    give(const Place &place, const Vector &impulse);
    template <class Add>
    void
    add_given(const Add &add);
    template <class Velocity, class Add>
    void
    press(const Velocity &velocity, const Add &add);

    NodalFields<dim>              &nodes;
    std::vector<Place>             places, former_places;
    std::vector<Share>             shares, former_shares;
    std::vector<Given>             given;    // per field
    std::vector<LazyArray<double>> expected; // per field, dim numbers a node
    std::vector<Vector>            holding;
    std::vector<std::uint32_t>     hanging; // 1 + place in the table, or 0
    std::vector<Peer>              peers;
    unsigned int                   n_passes   = 0;
    bool                           any_place  = false;
    bool                           everywhere = false; // whether all ranks
                                                       // that hold a node have
                                                       // all of its places
  };
} // namespace limber

#endif
