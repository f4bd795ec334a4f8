// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_obstacle_contact_h
#define limber_time_obstacle_contact_h

#include <limber/points/cell_batch.h>
#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /**
   * Contact of bodies with rigid obstacles (Obstacle): that of two bodies
   * (Contact) of which one has infinitely more mass. A point touches an
   * obstacle if its distance from it is at most half its edge, phi(x_p) <= R_p.
   * A node of whose mass half (0.35 with quadratic, 0.2 with cubic splines) is
   * that of such points has the normal
   *
   *   n = sum m_p N_i(x_p) grad phi(x_p) / |...|
   *
   * over them, and there material presses if its new velocity approaches that
   * of the obstacle, w = v - v_o, w . n < 0. Then it gets the impulse
   *
   *   J = m (-(w . n) n - s),
   *
   * with the sliding velocity s, or as much of it that m |s| is mu J_n
   * (Coulomb). What presses in the new velocity does so in every other one of
   * the step. The velocity of the obstacle is that of its way over the step, so
   * that its place and that of what it pushes stay together.
   *
   * The distance of points rather than of nodes decides, as nodes inside the
   * obstacle have mass up to a cell before anything touches it.
   */
  template <int dim>
  class ObstacleContact
  {
  public:
    /**
     * Collective; throws InputError where an obstacle holds points at the
     * start.
     */
    explicit ObstacleContact(const RunParts<dim> &parts);

    /** Adopt a changed mesh. */
    void
    reinit();

    /**
     * Where obstacles are touched at the beginning of a step; collective. The
     * masses of nodes are known.
     */
    void
    find(double time, double step);

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

    /** A node of a field of which enough touches an obstacle. */
    struct Touch
    {
      std::uint32_t node;
      unsigned int  field, obstacle;
      Vector        normal;   // out of the obstacle
      Vector        velocity; // of the obstacle at the node, m/s
      Vector        arm;      // from the centre of the obstacle, m
      State         state = State::free;
      // Of the exchange, for the ledger: velocity against the obstacle as it
      // has been brought, and sliding afterwards, m/s; impulse of friction
      Vector brought, slides, rubbing;
    };

    /** Sums at nodes over the points of a field that touch an obstacle. */
    struct Sums
    {
      // sum m_p N_i times the normals at the points, the place of the node, 1
      static constexpr unsigned int normal = 0;
      static constexpr unsigned int place  = dim;
      static constexpr unsigned int weight = 2 * dim;
      static constexpr unsigned int stride = 2 * dim + 1;

      LazyArray<double> records;
      RecordExchange    exchange{stride};
    };

    const Obstacle<dim> &
    obstacle(const Touch &touch) const
    {
      return parts.problem.obstacles[touch.obstacle];
    }

    void
    check_start() const;
    void
    check_way(unsigned int obstacle, double time, double step) const;
    bool
    is_beyond(double                    reach,
              unsigned int              obstacle,
              const ObstaclePlace<dim> &place,
              std::uint32_t             cell);
    void
    add_points(unsigned int              body,
               unsigned int              obstacle,
               const ObstaclePlace<dim> &place,
               Sums                     &some);
    template <int degree>
    void
    add_points_of_degree(unsigned int              body,
                         unsigned int              obstacle,
                         const ObstaclePlace<dim> &place,
                         Sums                     &some);
    void
    find_places();
    void
    give_to_masters(Sums &some) const;
    void
    add_touches(unsigned int field,
                unsigned int obstacle,
                double       time,
                double       step,
                const Sums  &some);

    State
    decide(const Touch &touch, const Vector &velocity) const;
    template <class Work>
    void
    for_each_held(unsigned int slot, const Work &work);
    void
    exchange(Touch &touch);

    const RunParts<dim> parts;
    std::vector<double> half_edge; // largest of the points of a body, m
    std::vector<Sums>   sums;      // of an obstacle and a field
    std::vector<Touch>  touches;
    // Of nodes, dim numbers each, m; only where some may hang
    LazyArray<double> places;
    // From the middles of cells when they asked, m, 0 where nobody has; and
    // where these were in the frame of the obstacle then
    std::vector<LazyArray<double>> cell_distance;
  };
} // namespace limber

#endif
