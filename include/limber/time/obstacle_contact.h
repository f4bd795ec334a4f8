// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_obstacle_contact_h
#define limber_time_obstacle_contact_h

#include <limber/points/cell_batch.h>
#include <limber/time/contact_impulses.h>
#include <limber/time/cut_cells.h>
#include <limber/time/integrator.h>

#include <algorithm>
#include <vector>

namespace limber
{
  /**
   * Contact of bodies with rigid obstacles (Obstacle) at the surface of their
   * material, not at the points (ContactImpulses). With the signed distance
   * phi(x_p) of a point from the obstacle, n = grad phi, and the extent R_p of
   * the material of the point along -n, the gap
   *
   *   g_p = phi(x_p) - R_p
   *
   * must not become negative. Its rate is w . n with the velocity of the
   * surface relative to the obstacle,
   *
   *   w = v(x_p) - R_p grad v(x_p) n - v_o = sum_i a_pi v_i - v_o,
   *   a_pi = N_i(x_p) - R_p n . grad N_i(x_p),
   *
   * and therefore at least -g_p / dt. The impulse that this takes acts at the
   * surface, so that the stress reaches it. A penetration is removed slowly
   * (least_growth()).
   *
   * R_p is the undeformed extent times the stretch along n: the distance from
   * the surface of the body for the outermost point of a row, half the edge of
   * the point's cube for others.
   *
   * In the initial frame grad N = F^-T grad_X N and b = F F^T.
   *
   * The points of a liquid define no surface: it is held at nodes of whose mass
   * a sufficient share is that of points within half their edge of the
   * obstacle, along the mean of their normals. At a corner of an obstacle this
   * share is too small, though the pressure in all cells around acts on the
   * node there. A node in the surface is therefore held against forces in any
   * case, and against the momentum of the points that touch, while that of
   * other points passes the corner.
   *
   * Contacts that are active for the new velocity are so for every other
   * velocity of the step. The velocity of the obstacle is its displacement in
   * the step over dt, so that it does not drift relative to what it pushes.
   *
   * Sides of the box that meet surfaces (Side) are half-spaces at rest beyond
   * their faces, for bodies of the nodal fields that feel them so
   * (Problem::meets_sides()). Their impulses are those of the sides.
   */
  template <int dim>
  class ObstacleContact
  {
  public:
    /**
     * Collective; throws InputError where an obstacle holds points at the
     * start. With @p leapfrogs (the initial frame) the velocity that points
     * give back in a step strains them in the next as well. Sides that are
     * @p covered, which may be null, do not act.
     */
    ObstacleContact(const RunParts<dim>     &parts,
                    CutCells<dim>           *cut_cells,
                    bool                     leapfrogs,
                    const CoveredSides<dim> *covered);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Find the contacts at the beginning of a step; collective. The masses of
     * nodes are known. */
    void
    find(double time, double step);

    /** No point has moved by more than about @p way, m, in the step: what was
     * farther from a side needs no search yet. The same on all ranks. */
    void
    approach(double way);

    /** Whether this rank has contacts, active or possible ones. */
    bool
    any() const
    {
      return impulses.any();
    }

    /** What a step leaves to be accounted for in the next, see
     * ContactImpulses. */
    using Action = typename ContactImpulses<dim>::Action;

    std::vector<Action>
    actions_to_come() const
    {
      return impulses.actions_to_come();
    }

    void
    restore(std::vector<Action> &&actions)
    {
      impulses.restore(std::move(actions));
    }

    /**
     * Impose the contacts on the velocity at @p slot as they are going to be on
     * the new one, that is (p + dt f) / m + dt g, with the force in the
     * records.
     */
    void
    hold_before(unsigned int slot, double step);

    /** A node that an obstacle holds: its velocity v after the step has
     * v . normal >= least, m/s. */
    struct HeldNode
    {
      std::uint32_t          node;
      dealii::Tensor<1, dim> normal;
      double                 least;
      // Share of this rank in its impulse, and the number of that impulse:
      double      share;
      std::size_t place;
    };

    /** Nodes of liquids that this rank knows, also by points of others. */
    const std::vector<HeldNode> &
    held_nodes() const
    {
      return nodes_held;
    }

    /**
     * Call work(cell, k, least, number) for the surfaces with an active or
     * possible contact of a liquid: surface k of a cell of this rank
     * (CutCells), on which the mean normal velocity is to be at least @p least,
     * m/s.
     */
    template <class Work>
    void
    for_each_surface(const Work &work) const
    {
      for (const SurfacePlace &one : surface_places)
        {
          const Place &place = impulses.all()[one.place];
          work(one.cell,
               one.surface,
               place.least + place.velocity * place.normal,
               one.place);
        }
    }

    /** On all ranks: impulses of surfaces are going to be prescribed by
     * give(). */
    void
    expect_given()
    {
      impulses.expect_given();
    }

    /**
     * Prescribe the impulse of a surface in this step, kg m/s, known from its
     * implicit pressure, by the number that for_each_surface() has for it; or
     * that of a node, by its place.
     */
    void
    give(const std::size_t number, const double impulse)
    {
      impulses.give(number, impulse);
    }

    /** Apply the contact impulses: changes new velocities and increments. */
    void
    exchange();

    /** Impose the contacts on another velocity as on the new one. */
    void
    hold(unsigned int slot);

    /** Impose the contacts on a velocity of the series that the full-mass
     * filter sums up; the last one of the step has the impulses of them all. */
    void
    hold_filtered(unsigned int slot);

    /** Account for these impulses, also in the balances of obstacles and sides.
     * Returns their work by the motion of obstacles, J. */
    double
    account_filtered();

    /** Impose the contacts on the re-mapped velocity, and account for what
     * points lose by this beyond exchange(), times the share of FLIP. */
    void
    hold_after(unsigned int slot, double flip_share);

    /**
     * Put points of liquids that a step has left inside an obstacle, as
     * surfaces in cells hold the mean flow only, back onto its surface, and
     * remove their normal velocity into it: an inelastic impact, which is in
     * the ledger. Returns the longest way on this rank in cells, 0 where there
     * was none: otherwise the sums of cells are out of date.
     */
    double
    put_out(double time, double step);

  private:
    using Layout = NodeLayout<dim>;
    using Vector = dealii::Tensor<1, dim>;
    using Place  = typename ContactImpulses<dim>::Place;

    /** What the balance of an obstacle needs of an impulse. */
    struct Touch
    {
      unsigned int obstacle;
      Vector       arm; // from the centre of the obstacle, m
      // Part of the hydrostatic pressure beyond the mean over the piece, which
      // acts on the nodes as a load (HydrostaticLoad), kg m/s
      double beyond = 0;
    };

    /** A surface in a cell of this rank, and its impulse. */
    struct SurfacePlace
    {
      std::uint32_t cell;
      unsigned int  surface;
      std::size_t   place;
    };

    using Way = ObstacleMotion<dim>;

    /** A point that is next to an obstacle. */
    struct Near
    {
      std::size_t         point;
      unsigned int        obstacle;
      dealii::Point<dim>  x;
      SignedDistance<dim> distance;
      double              reach; // R_p, m
    };

    /** An obstacle that has put a point back, and its normal there. */
    struct Wall
    {
      unsigned int obstacle;
      Vector       normal;
    };

    /** Sums at nodes over the points of liquids that touch an obstacle. */
    struct Sums
    {
      // sum m_p N_i times the normals at the points, their places, their
      // velocities, 1
      static constexpr unsigned int normal   = 0;
      static constexpr unsigned int place    = dim;
      static constexpr unsigned int momentum = 2 * dim;
      static constexpr unsigned int weight   = 3 * dim;
      static constexpr unsigned int n_summed = 3 * dim + 1;
      // The weight of the points of this rank
      static constexpr unsigned int own    = n_summed;
      static constexpr unsigned int stride = n_summed + 1;

      LazyArray<double> records; // none where the field has no liquid
      RecordExchange    exchange{stride};
    };

    /** Faces at a node between cells that obstacles cover and open ones: walls
     * that hold a node full of liquid, whether points touch them or not. */
    struct Walls
    {
      // By direction, sign of the axis towards the open cells; 0: no wall
      std::array<int, dim> across{};
      // Share of the open cells around the node that have such a face
      double open_at_walls = 1;

      bool
      any() const
      {
        return std::any_of(across.begin(), across.end(), [](const int is) {
          return is != 0;
        });
      }
    };

    void
    add_impulse(const Touch &touch, const Vector &impulse);
    Walls
    walls_at(unsigned int field, std::uint32_t node) const;
    unsigned int
    n_obstacles() const
    {
      return parts.problem.obstacles.size();
    }
    void
    check_start() const;
    void
    check_way(unsigned int obstacle, double time, double step) const;
    dealii::Point<dim>
    middle_of(const PointView<dim> &points,
              const CellBatch      &batch,
              double               &reach) const;
    bool
    is_in(std::uint32_t node,
          unsigned int  obstacle,
          const Way    &way,
          bool          in_wall);
    bool
    is_beyond(double                    reach,
              unsigned int              obstacle,
              const ObstaclePlace<dim> &place,
              const dealii::Point<dim> &middle,
              std::uint32_t             cell);
    void
    find_points_at_sides(const std::vector<Way> &ways, double step);
    double
    find_points(unsigned int body, const std::vector<Way> &ways, double step);
    void
    add_surface(unsigned int body,
                const Near  &near,
                const Way   &way,
                double       step);
    void
    add_to_nodes(unsigned int body, const Near &near);
    void
    clear_sums();
    void
    add_nodes(const std::vector<Way> &ways);
    void
    add_node(unsigned int  obstacle,
             unsigned int  field,
             std::uint32_t node,
             const double *touching,
             const Way    &way);
    void
    add_cut_cells(const std::vector<Way> &ways, double step);
    bool
    is_met_by_surface(unsigned int field, std::uint32_t node) const;
    bool
    find_outside(const std::vector<Way>          &ways,
                 const std::vector<unsigned int> &near,
                 dealii::Point<dim>              &x,
                 std::vector<Wall>               &met) const;
    double
    put_out(const PointView<dim>            &points,
            std::size_t                      p,
            const std::vector<Way>          &ways,
            const std::vector<unsigned int> &near);

    const RunParts<dim>  parts;
    CutCells<dim> *const cut_cells; // or null
    // What may be touched: the obstacles of the scene, in its order, and after
    // them sides, whose numbers are in the second list
    std::vector<Obstacle<dim>> rigid;
    std::vector<unsigned int>  sides_that_meet;
    SideConstraints<dim>       sides;
    // Conditions at nodes for fields that meet sides at surfaces
    const Sides<dim>          other_sides;
    SideConstraints<dim>      of_other_sides;
    std::vector<double>       edge; // largest of the points of a body, m
    std::vector<double>       liquid_density; // of a field, the largest, kg/m^3
    ContactImpulses<dim>      impulses;
    std::vector<Sums>         sums;    // of an obstacle and a field
    std::vector<Touch>        touches; // of each impulse
    std::vector<SurfacePlace> surface_places;
    std::vector<HeldNode>     nodes_held;
    std::vector<Wall>         walls; // of the point that is put out
    // By obstacle and cell, cached: distance from the centre of the cell's
    // material, m, 0 where not evaluated; and that centre then, in the
    // obstacle's frame
    std::vector<LazyArray<double>> cell_distance;
    // By body, where there are sides alone: how far it still is at least from
    // touching one, m
    std::vector<double> room;
    // Where the nodes are, in scenes with liquids, if they are vertices
    std::vector<dealii::Point<dim>> vertices;
    // Cached for obstacles at rest, by node: whether it is in them (2) or not
    // (1)
    std::vector<LazyArray<std::uint8_t>> known_nodes;
  };
} // namespace limber

#endif
