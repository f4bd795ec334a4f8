// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_closed_polygon_h
#define limber_problem_closed_polygon_h

#include <limber/problem/shape.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * On which side of an edge from @p lower to @p upper a place is, at a height
   * that the edge passes, lower[1] <= place[1] < upper[1]: whether the edge
   * lies beyond the place in direction 0. Rounded, but in the same way for all
   * who share the edge, so that counts of crossings stay exact.
   */
  bool
  is_before_edge(const std::array<double, 2> &place,
                 const std::array<double, 2> &lower,
                 const std::array<double, 2> &upper);

  /**
   * How a ray from a place in direction 0 crosses the edge from @p a to @p b:
   * 1 if the edge goes up, -1 if it goes down, 0 if it is not met. An edge has
   * its lower end and not its upper one; corners are counted once.
   */
  int
  crossing(const std::array<double, 2> &place,
           const std::array<double, 2> &a,
           const std::array<double, 2> &b);



  /**
   * The region within closed polygons in the plane, by the even-odd rule: a
   * place is inside if a ray from it crosses an odd number of edges (Shimrat
   * 1962, Commun. ACM 5(8), 434), so loops within loops are holes, whichever
   * way they go around. Edges are kept in rows: a question costs about as much
   * as the edges at its height.
   */
  class ClosedPolygon
  {
  public:
    using Edge = std::array<dealii::Point<2>, 2>;

    /** Edges that form closed lines. */
    explicit ClosedPolygon(const std::vector<Edge> &edges);

    bool
    contains(const dealii::Point<2> &place) const;

    /** Signed distance, by comparison with every edge. */
    SignedDistance<2>
    signed_distance(const dealii::Point<2> &place) const;

    /** Area by the even-odd rule, m^2. */
    double
    area() const
    {
      return enclosed;
    }

    const Corners<2> &
    bounding_box() const
    {
      return box;
    }

    /** Two edges, by number, that intersect or overlap. */
    std::optional<std::pair<std::size_t, std::size_t>>
    crossed_edges() const;

  private:
    using Place = std::array<double, 2>;

    std::size_t
    row_of(const double y) const;

    void
    fill_rows();

    double
    integrate_area() const;

    std::vector<std::array<Place, 2>> edges;
    Corners<2>                        box;
    double                            enclosed = 0;

    // The edges of row i: in_rows[row_begins[i]] to before that of i + 1
    double                     row_height = 1;
    std::vector<std::size_t>   row_begins;
    std::vector<std::uint32_t> in_rows;
  };
} // namespace limber

#endif
