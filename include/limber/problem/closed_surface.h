// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_closed_surface_h
#define limber_problem_closed_surface_h

#include <limber/problem/nearest_facet.h>
#include <limber/problem/shape.h>

#include <array>
#include <vector>

namespace limber
{
  /** Triangles in space with common vertices, by number. */
  struct TriangleMesh
  {
    std::vector<dealii::Point<3>>            corners; // m
    std::vector<std::array<unsigned int, 3>> facets;

    /** Twice the area of a facet along its normal, m^2. */
    dealii::Tensor<1, 3>
    normal(std::size_t facet) const;
  };



  /** Merges vertices within @p tolerance of each other. Without that the facets
   * of a file, each of which has its own three, share nothing. */
  TriangleMesh
  welded(const std::vector<std::array<dealii::Point<3>, 3>> &facets,
         double                                              tolerance);

  /** Keeps each facet once that has the same corners in the same order as
   * another one: what was exported twice would have twice its volume. */
  void
  drop_repeated_facets(TriangleMesh &mesh);



  /** An edge at which a triangulated surface is not closed or not consistently
   * oriented. */
  struct SurfaceFault
  {
    enum class Kind
    {
      open,   // an odd number of facets meets there
      flipped // an even number, but not as many go one way as the other
    };

    Kind                            kind = Kind::open;
    std::size_t                     facet;       // the first one there
    std::size_t                     other_facet; // of the same direction
    std::array<dealii::Point<3>, 2> edge;
    std::size_t                     n_edges; // number of such edges
  };

  /**
   * The first edge along which facets do not run both ways equally often, open
   * ones before flipped ones; nothing where the surface is closed and
   * consistently oriented.
   */
  std::optional<SurfaceFault>
  find_fault(const TriangleMesh &mesh);



  /**
   * The region within closed, consistently oriented surfaces of triangles, by
   * the winding number: a place is inside if the facets that a ray from it
   * meets, counted with the side they are met from, do not cancel. So surfaces
   * within surfaces that go the other way around are cavities, and bodies that
   * overlap are one. Facets are kept in a lattice across the ray.
   */
  class ClosedSurface
  {
  public:
    explicit ClosedSurface(const TriangleMesh &mesh);

    bool
    contains(const dealii::Point<3> &place) const;

    /** Signed distance; the first call sorts all facets into bins. */
    SignedDistance<3>
    signed_distance(const dealii::Point<3> &place) const;

    const Corners<3> &
    bounding_box() const
    {
      return box;
    }

    /** Volume by Gauss's theorem, m^3, where the surface is in one piece. The
     * volumes of several need not add up: they may overlap. */
    std::optional<double>
    volume() const
    {
      return enclosed;
    }

  private:
    using Place = std::array<double, 2>;

    /** Coordinates across the ray, and along it. */
    struct Facet
    {
      std::array<Place, 3>  across;
      std::array<double, 3> along;
      double                top; // the largest of these
    };

    /** Cells of a lattice across the ray, and the facets over each, as rows of
     * a table (compressed rows). */
    struct Lattice
    {
      Place                      lower, edge;
      std::array<std::size_t, 2> n;
      std::vector<std::size_t>   begins;
      std::vector<std::uint32_t> facets;

      std::size_t
      index(const unsigned int direction, const double x) const;

      /** Range of cells that a triangle overlaps, in each direction. */
      std::array<std::size_t, 4>
      range(const std::array<Place, 3> &triangle) const;
    };

    void
    set_direction(const TriangleMesh &mesh, unsigned int direction);

    /** A lattice of cells about as large as facets, without the table. */
    Lattice
    fitting_lattice() const;

    /** Number of pairs of a facet and a cell that overlap. */
    std::size_t
    count(const Lattice &cells) const;

    void
    fill(Lattice &cells) const;

    unsigned int          ray = 0;
    std::vector<Facet>    facets;
    Lattice               lattice;
    Corners<3>            box;
    std::optional<double> enclosed;
    // built for the first call of signed_distance(), which is rare
    mutable std::shared_ptr<const NearestFacet> nearest;
  };
} // namespace limber

#endif
