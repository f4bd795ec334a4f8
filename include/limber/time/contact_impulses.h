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
   * Contact impulses with Coulomb friction at contact points ("places"). The
   * relative velocity at place p is
   *
   *   w_p = sum_i a_pi v_i - v_p,
   *
   * with the coefficients a_pi of the nodal velocities there and the velocity
   * v_p of the obstacle. The impulses J_p are distributed to the nodes with the
   * transpose, m_i dv_i = sum_p a_pi J_p, and satisfy the contact conditions
   *
   *   J_n >= 0,  w_n >= least,  J_n (w_n - least) = 0,
   *   |J_t| <= mu J_n,  w_t = 0 where it is less        (Coulomb),
   *
   * found by some passes of a projected Jacobi method. With the masses M_i of
   * the places as seen by a node, M_i = sum_p |a_pi| m_p, a pass changes J_p by
   * m_p (least - w_n) / s_p with s_p = sum_i |a_pi| M_i / m_i: this is exact
   * after one pass if the values are the same at all places, and never
   * overshoots. Without friction masses count by |n_q . n_p| at most (Borne),
   * as impulses across n_p do not change w_n.
   * All impulses are solved together, so that a node may see any number of
   * places and obstacles; functions may be those of any kernel.
   *
   * The energy that FLIP points lose by them in a step is in ContactLoss: with
   * the velocity b at a place mapped from the points at the start of the step,
   * r re-mapped from them at its end, the increment a by all other forces, and
   * the impulses K_b and K_r that constrain b and r where these strain the
   * points,
   *
   *   - J . (b + r) / 2 + a . (K_b + K_r) / 2,
   *
   * since forces have done a . (K_b + K_r) / 2 less work on the points than the
   * points have lost to strain. If points are not strained at the start of the
   * step, they are strained by r alone. Where places are nodes, the velocity
   * that strains the points keeps nothing of a constrained component,
   * K = -m_p b or r in active contacts.
   *
   * Only nodes that some place sees are visited.
   */
  template <int dim>
  class ContactImpulses
  {
  public:
    using Vector = dealii::Tensor<1, dim>;

    struct Place
    {
      Vector normal;        // outward from the other body or obstacle, unit
      Vector velocity;      // v_p: of the obstacle, m/s
      double least    = 0;  // lower bound of w_n, m/s
      double friction = 0;  // mu; infinite for stick
      double mass     = 0;  // m_p, kg: its weight among the places of a node
      Vector impulse;       // J, kg m/s
      bool   is_own = true; // counted on this rank

      bool
      presses() const
      {
        return impulse * normal > 0;
      }

      bool   is_given   = false; // the normal impulse, see give()
      double relaxation = 0;     // m_p / s_p, kg
      bool   sticks     = false;
      Vector ahead; // J extrapolated to the next pass

      // For ContactLoss: a; b or r; the new velocity; K
      Vector increase, brought, after, held;
    };

    /** Places with nodes on this and another rank, in the same order on both.
     */
    struct Peer
    {
      unsigned int               rank;
      std::vector<std::uint32_t> own;   // of this rank, with a part there
      std::vector<std::uint32_t> parts; // of that rank, with a part here
    };

    /**
     * With @p leapfrogs (the initial frame) the re-mapped velocity of a step
     * strains the points in the next one as well: K_b is K_r of the step
     * before.
     */
    explicit ContactImpulses(NodalFields<dim> &nodes, bool leapfrogs = false);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Forget all places. */
    void
    clear();

    /** What the places of a step will account for at a node in the next one,
     * with leapfrogs: see KeptNode. */
    struct Action
    {
      std::uint32_t node;
      Vector        across, along;
    };

    /** Those of nodes that this rank knows, to be summed over ranks; several
     * for a node. */
    std::vector<Action>
    actions_to_come() const;

    /** Restore them at nodes of this rank, from a checkpoint. */
    void
    restore(std::vector<Action> &&actions);

    /** The next place; its nodes follow by add_share(). */
    Place &
    add_place();

    /**
     * Add coefficients a_pi to the last place, for nodes given by the offsets
     * of their records in the grid. Repeated shares of a node are summed. The
     * sizes are sums of |a_pi| over the contributing points: |sum a_pi| would
     * depend on how these are distributed over ranks.
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

    // Shares of zero are left out: other ranks would not know of the node.
    void
    add_share(const unsigned int  field,
              const std::uint32_t node,
              const double        value)
    {
      if (value != 0)
        add_share(field, node, value, std::abs(value));
    }

    /**
     * Call work(node, weight) for a node, or for the masters of a hanging node
     * with their weights.
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
     * Take into account boundary conditions of the sides of the box that are
     * applied to the nodes of a field after all impulses: relative velocities
     * are computed with the constrained nodal velocities. For a place without
     * friction a node counts by the unconstrained part of the normal, |P n|,
     * and not at all if that is below .1. Impulses on components that a side
     * always holds go to the side, see for_each_given_to_side(). To be called
     * before finish_adding().
     */
    void
    add_side_constraints(unsigned int                   field,
                         const std::vector<Constraint> &constraints);

    /**
     * To be called after the last place has been added; masses of nodes are
     * known. Collective. @p peers lists, by rank, places with nodes on other
     * ranks. Four passes give the same results as sixteen for bodies that are
     * pressed or roll. With @p hurry passes are accelerated: sixteen are then
     * worth some fifty.
     */
    void
    finish_adding(std::vector<Peer> &&peers  = {},
                  unsigned int        passes = passes_of_points,
                  bool                hurry  = false);

    static constexpr unsigned int passes_of_points = 4;

    /**
     * The same for places at nodes, of two fields each: every rank that holds a
     * node has all its places, so that no sums over ranks are needed.
     */
    void
    finish_adding_nodes();

    /** Announce, on all ranks, that some normal impulses are set by give(). */
    void
    expect_given()
    {
      gives_some = true;
    }

    /** Prescribe the normal impulse of a place, kg m/s, after
     * finish_adding(): exchange() finds those of the others, and friction. */
    void
    give(const std::size_t place, const double across)
    {
      places[place].is_given = true;
      places[place].impulse  = across * places[place].normal;
    }

    /** Whether any rank has a place (for places at nodes: whether this one has)
     */
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
     * Constrain the velocity that strains points at the start of the step, at a
     * slot of the records, with the contacts that a prediction of the new one,
     * (p + dt f) / m + g dt, makes active.
     */
    void
    hold_before(unsigned int slot, double step, const Vector &gravity);

    /**
     * Solve for the impulses of the step, starting from those of the prediction
     * if there are any, and apply them to new velocities and increments.
     * Returns the energy that PIC loses.
     */
    ContactLoss
    exchange();

    /** Parts of the impulses that sides of the box have taken instead of nodes:
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
     * Constrain the re-mapped velocity, at a slot of the records, as hold()
     * does. Returns the energy that points lose beyond exchange(), by the share
     * of FLIP.
     */
    ContactLoss
    hold_after(unsigned int slot, double flip_share);

    /**
     * Constrain another velocity in active contacts: w_n = least, and w_t = 0
     * where they stick.
     */
    void
    hold(unsigned int slot);

    /** The same; the impulses that this takes are then in Place::held. */
    void
    hold_and_note(unsigned int slot);

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

    // Masses of the places of a node: of all of them, M_i, and weighted by
    // |n_d| for each direction d
    struct Borne
    {
      static constexpr unsigned int all = 0, along = 1;
      static constexpr unsigned int stride = 1 + dim;
    };

    // Sums over ranks at the nodes of a field: momentum from places in a pass,
    // or the masses; a record has both
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

    // How nodal values are constrained by sides before they are summed at
    // places: components always held become zero (increment) or the velocity of
    // the side; pressing also applies one-sided (separating) conditions
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
    free_share(const Place &place, const std::size_t share) const
    {
      return held_components.empty() ? share_sizes[share] :
                                       share_beside_sides(place, share);
    }
    double
    share_beside_sides(const Place &place, std::size_t share) const;
    void
    find_borne();
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
    std::vector<double>        share_sizes; // sum of |a_pi|, of each share
    std::vector<Node>          seen;
    std::vector<std::uint32_t> after_share;        // 1 + the last of each, or 0
    std::size_t                first_share = 0;    // of the last place
    std::vector<LazyArray<std::uint32_t>> seen_as; // per field, by node: 1 +
                                                   // its place in these, or 0
    // By seen node: 1 / m_i; M_i; the velocity at hand; the momentum from
    // places in a pass. By place: w_p; the change of its impulse; whether it
    // takes part in the sums
    std::vector<double> inverse_mass, bears, velocity, momentum;
    std::vector<double> relative, given_by_place;
    std::vector<char>   takes_part;
    // Constraints of seen nodes by sides, empty without add_side_constraints():
    // fields with their constraints; by node, the components always held
    // (bits), the sides that do so, and the constrained velocity
    std::vector<std::pair<unsigned int, const std::vector<Constraint> *>>
                               side_constraints;
    std::vector<HeldOfNode>    held;
    std::vector<unsigned char> held_components, holding_side;
    std::vector<double>        left_velocity;
    std::vector<Given>         given;   // per field
    std::vector<std::uint32_t> hanging; // 1 + place in the table, or 0
    std::vector<Peer>          peers;
    unsigned int               n_passes     = 0;
    bool                       hurries      = false; // accelerated passes
    bool                       any_place    = false;
    bool                       at_nodes     = false; // finish_adding_nodes()
    bool                       holds_before = false; // in this step
    bool                       gives_some   = false; // in this step
    // With leapfrogs, of the step before
    std::vector<Place> former_places;
    PlaceShares        former_shares;
    std::vector<Node>  former_seen;
    // The same from a checkpoint
    std::vector<Action> former_actions;
  };
} // namespace limber

#endif
