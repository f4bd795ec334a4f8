// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_impulses_h
#define limber_time_contact_impulses_h

#include <limber/grid/nodal_fields.h>
#include <limber/grid/side_constraints.h>
#include <limber/state/ledger.h>
#include <limber/transfer/place_sums.h>

#include <cmath>
#include <utility>
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
   * found by some passes of a projected Jacobi method. With the masses M_i of
   * nodes that belong to the places, M_i = sum_p |a_pi| m_p, a pass changes
   * J_p by m_p (least - w_n) / s_p with s_p = sum_i |a_pi| M_i / m_i: what is
   * the same at all places is right after one pass, and nothing overshoots.
   * Without friction M_i has masses times |n_q . n_p| at most (Borne): what
   * presses across does not matter.
   * All of them are found together, so that it does not matter how many places
   * or obstacles a node sees; functions may be those of any kernel.
   *
   * Of a step, FLIP points lose by them what ContactLoss tells: with the
   * velocity b that they bring to a place, r that they give back, the increase
   * a by all other forces, and the impulses K_b and K_r that hold these
   * velocities where they strain the points,
   *
   *   - J . (b + r) / 2 + a . (K_b + K_r) / 2,
   *
   * since forces have done a . (K_b + K_r) / 2 less on the points than they
   * have lost to strain. Points that nothing has strained at the beginning of
   * the step are strained by r alone. Where places are nodes, what strains the
   * points has nothing left of what is held, K = -m_p b or r where it presses.
   *
   * Nodes that no place sees are not met by any of this.
   */
  template <int dim>
  class ContactImpulses
  {
  public:
    using Vector = dealii::Tensor<1, dim>;

    struct Place
    {
      Vector normal;        // out of what is touched, of unit length
      Vector velocity;      // v_p: of what is touched, m/s
      double least    = 0;  // m/s
      double friction = 0;  // mu; infinite where what presses sticks
      double mass     = 0;  // m_p, kg: by what share it bears
      Vector impulse;       // J, kg m/s
      bool   is_own = true; // counted on this rank

      bool
      presses() const
      {
        return impulse * normal > 0;
      }

      bool   is_given   = false; // the impulse across the surface
      double relaxation = 0;     // m_p / s_p, kg
      bool   sticks     = false;

      // What ContactLoss wants to know: a, b or r, the new velocity; K
      Vector increase, brought, after, held;
    };

    /** Places that have parts on two ranks, in the same order on both. */
    struct Peer
    {
      unsigned int               rank;
      std::vector<std::uint32_t> own;   // those of this rank, a part is there
      std::vector<std::uint32_t> parts; // those of that rank, a part is here
    };

    /**
     * With @p leapfrogs (the initial frame) the velocity that points give back
     * in a step strains them in the next as well: K_b is K_r of the step
     * before.
     */
    explicit ContactImpulses(NodalFields<dim> &nodes, bool leapfrogs = false);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Forget all places. */
    void
    clear();

    /** The next place; its nodes follow by add_share(). */
    Place &
    add_place();

    /**
     * Of the last place: nodes that it sees, by the offsets of their records in
     * the grid, with a_pi. A place has one share of a node, however often it is
     * told. The sizes are sums of |a_pi| over the points that it comes from: of
     * the share itself they would depend on how ranks have divided these.
     */
    template <class Offsets>
    void
    add_shares(const unsigned int  field,
               const Offsets      &offsets,
               const double *const values,
               const double *const sizes)
    {
      if (!hanging.empty())
        {
          for (std::size_t k = 0; k < offsets.size(); ++k)
            if (sizes[k] != 0)
              add_share(field,
                        offsets[k] / Layout::stride,
                        values[k],
                        sizes[k]);
          return;
        }
      // The same as add_share_of_master(), without growing one by one.
      std::size_t end = shares.begin.back();
      grow(end + offsets.size());
      PlaceShare *const    all     = shares.all.data();
      std::uint32_t *const numbers = seen_as[field].data();
      for (std::size_t k = 0; k < offsets.size(); ++k)
        {
          if (sizes[k] == 0)
            continue;
          const std::uint32_t node = offsets[k] / Layout::stride;
          const std::uint32_t as =
            numbers[node] != 0 ? numbers[node] - 1 : see(field, node);
          std::uint32_t &after = after_share[as];
          if (after > first_share)
            {
              all[after - 1].value += values[k];
              share_sizes[after - 1] += sizes[k];
            }
          else
            {
              all[end]         = {as, values[k]};
              share_sizes[end] = sizes[k];
              after            = static_cast<std::uint32_t>(++end);
            }
        }
      shares.begin.back() = end;
    }

    // A node with a share of zero would not be known on other ranks.
    void
    add_share(const unsigned int  field,
              const std::uint32_t node,
              const double        value)
    {
      if (value != 0)
        add_share(field, node, value, std::abs(value));
    }

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
     * What sides of the box are going to hold of the nodes of a field, after
     * all impulses: places see there what the sides leave, and do not wait for
     * what they do not let happen. Of a place without friction a node counts
     * with the part of its normal n that the sides leave, |P n|; where that is
     * less than .1, not at all. What they give to components that a side always
     * holds goes to the side, see for_each_given_to_side(). To be told before
     * these end.
     */
    void
    heed_sides(unsigned int field, const std::vector<Constraint> &constraints);

    /**
     * After all of these; masses of nodes are known. Collective. Places of a
     * rank are its own, apart from those with parts elsewhere, which @p peers
     * names by rank. After four passes points that are pressed or roll do what
     * they do after sixteen.
     */
    void
    finish_adding(std::vector<Peer> &&peers  = {},
                  unsigned int        passes = passes_of_points);

    static constexpr unsigned int passes_of_points = 4;

    /**
     * The same of places at nodes, of two fields each, of which each rank has
     * all that it holds: nothing has to be summed up.
     */
    void
    finish_adding_nodes();

    /** On all ranks: some places have impulses known from elsewhere. */
    void
    expect_given()
    {
      gives_some = true;
    }

    /** That of a place across the surface, kg m/s, after these have ended:
     * exchange() finds those of the others, and what rubs. */
    void
    give(const std::size_t place, const double across)
    {
      places[place].is_given = true;
      places[place].impulse  = across * places[place].normal;
    }

    /** Whether there is any on any rank. */
    bool
    any() const
    {
      return any_place;
    }

    const std::vector<Place> &
    all() const
    {
      return places;
    }

    /**
     * Hold the velocity that points bring, at a slot of the records, as the new
     * one is going to be held: (p + dt f) / m + g dt.
     */
    void
    hold_before(unsigned int slot, double step, const Vector &gravity);

    /**
     * Find the impulses that the new velocities have, from what was expected,
     * and give them to these and to their increments. Returns what PIC loses.
     */
    ContactLoss
    exchange();

    /** Of the impulses of places, what has gone to sides instead of nodes:
     * work(side, component, impulse, kg m/s). */
    template <class Work>
    void
    for_each_given_to_side(const Work &work) const
    {
      if (held.empty())
        return;
      for (std::size_t p = 0; p < places.size(); ++p)
        for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
          for (int d = 0; d < dim; ++d)
            if (is_held(shares.all[k].node, d))
              work(holding_side[shares.all[k].node * dim + d],
                   d,
                   shares.all[k].value * places[p].impulse[d]);
    }

    /**
     * Hold the velocity that points have given back, at a slot of the records.
     * Returns what they lose beyond that, by the share of FLIP.
     */
    ContactLoss
    hold_after(unsigned int slot, double flip_share);

    /**
     * Bring another velocity to the least one where places press, and to rest
     * along the surface where they stick.
     */
    void
    hold(unsigned int slot);

  private:
    using Layout = NodeLayout<dim>;

    static constexpr int lanes = vector_lanes<dim>;

    /** A node of a field that any place sees, on any rank. */
    struct Node
    {
      double      *record;
      unsigned int field, number;
    };

    struct HeldOfNode
    {
      std::uint32_t     node; // place in those seen
      const Constraint *constraint;
    };

    // The masses of places that bear on a node: of all of them, M_i, and times
    // |n_d| by direction
    struct Borne
    {
      static constexpr unsigned int all = 0, along = 1;
      static constexpr unsigned int stride = 1 + dim;
    };

    // What ranks tell each other of the nodes of a field: momentum that places
    // give in a pass, or the masses; a record has both
    struct Given
    {
      static constexpr unsigned int momentum = 0;
      static constexpr unsigned int borne    = dim;
      static constexpr unsigned int stride   = dim + Borne::stride;

      LazyArray<double> records;
      RecordExchange    exchange{stride};
    };

    std::uint32_t
    see(const unsigned int field, const std::uint32_t number)
    {
      std::uint32_t &as = seen_as[field][number];
      if (as == 0)
        {
          seen.push_back({nodes.record(field, number), field, number});
          after_share.push_back(0);
          as = static_cast<std::uint32_t>(seen.size());
        }
      return as - 1;
    }

    void
    add_share(const unsigned int  field,
              const std::uint32_t node,
              const double        value,
              const double        size)
    {
      if (hanging.empty() || hanging[node] == 0)
        add_share_of_master(field, node, value, size);
      else
        for_each_master(
          node, [&](const std::uint32_t master, const double weight) {
            add_share_of_master(field, master, weight * value, weight * size);
          });
    }

    /** Room for that many shares. */
    void
    grow(const std::size_t n)
    {
      if (shares.all.size() < n)
        shares.all.resize(2 * n);
      if (share_sizes.size() < n)
        share_sizes.resize(2 * n);
    }

    void
    add_share_of_master(const unsigned int  field,
                        const std::uint32_t node,
                        const double        value,
                        const double        size)
    {
      const std::uint32_t as    = see(field, node);
      std::uint32_t      &after = after_share[as];
      if (after > first_share)
        {
          shares.all[after - 1].value += value;
          share_sizes[after - 1] += size;
        }
      else
        {
          const std::size_t end = shares.begin.back();
          grow(end + 1);
          shares.all[end]     = {as, value};
          share_sizes[end]    = size;
          shares.begin.back() = end + 1;
          after               = static_cast<std::uint32_t>(end + 1);
        }
    }

    static Vector
    vector_at(const std::vector<double> &vectors, const std::size_t i)
    {
      Vector result;
      for (int d = 0; d < dim; ++d)
        result[d] = vectors[i * lanes + d];
      return result;
    }

    static void
    store_at(const Vector &vector, const std::size_t i, std::vector<double> &to)
    {
      for (int d = 0; d < dim; ++d)
        to[i * lanes + d] = vector[d];
    }

    void
    load(unsigned int slot);
    void
    expect(double step, const Vector &gravity);
    bool
    is_held(const std::size_t node, const int component) const
    {
      return !held_components.empty() &&
             (held_components[node] >> component & 1);
    }

    // What of the velocities of nodes the sides have left already, or are going
    // to leave: of components that they always hold theirs, or their increment,
    // which is zero; pressing, what they let go
    enum class Seen
    {
      increment,
      velocity,
      pressing
    };

    void
    find_relative(bool only_of_pressing, Seen seen_as);
    void
    see_what_sides_leave(Seen seen_as);
    void
    find_held();
    double
    borne_along(const Place &place, std::uint32_t node) const;
    double
    free_share(const Place &place, std::size_t share) const;
    void
    find_relaxation();
    void
    see_those_of_others();
    void
    complete();
    bool
    shares_nodes() const;
    void
    sum_given(unsigned int first, unsigned int last);
    void
    give_impulses();
    void
    store_velocity(unsigned int slot);
    void
    press(bool relative_is_known);
    void
    account_former(ContactLoss &loss);
    void
    hold_and_tell(unsigned int slot, bool tell);
    void
    account(ContactLoss  &loss,
            const Place  &place,
            const Vector &velocity,
            const Vector &held,
            double        share) const;

    NodalFields<dim>          &nodes;
    const bool                 leapfrogs;
    std::vector<Place>         places;
    PlaceShares                shares;
    std::vector<double>        share_sizes; // of each share
    std::vector<Node>          seen;
    std::vector<std::uint32_t> after_share;        // 1 + the last of each, or 0
    std::size_t                first_share = 0;    // of the last place
    std::vector<LazyArray<std::uint32_t>> seen_as; // per field, by node: 1 +
                                                   // its place in these, or 0
    // Of those seen: 1 / m_i; M_i; the velocity that is dealt with; the
    // momentum that places give in a pass. Of places: w_p; what
    // they give; whether they are asked, or give any
    std::vector<double> inverse_mass, bears, velocity, momentum;
    std::vector<double> relative, given_by_place;
    std::vector<char>   takes_part;
    // What sides hold of nodes that are seen, empty where nobody heeds any:
    // fields with their constraints; of nodes, the components always held
    // (bits), by which sides, and the velocity that sides leave
    std::vector<std::pair<unsigned int, const std::vector<Constraint> *>>
                               heeded;
    std::vector<HeldOfNode>    held;
    std::vector<unsigned char> held_components, holding_side;
    std::vector<double>        left_velocity;
    std::vector<Given>         given;   // per field
    std::vector<std::uint32_t> hanging; // 1 + place in the table, or 0
    std::vector<Peer>          peers;
    unsigned int               n_passes     = 0;
    bool                       any_place    = false;
    bool                       at_nodes     = false; // finish_adding_nodes()
    bool                       holds_before = false; // in this step
    bool                       gives_some   = false; // in this step
    // With leapfrogs, of the step before
    std::vector<Place> former_places;
    PlaceShares        former_shares;
    std::vector<Node>  former_seen;
  };
} // namespace limber

#endif
