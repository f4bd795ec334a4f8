// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/closed_polygon.h>
#include <limber/problem/closed_surface.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;



  Tensor<1, 3>
  TriangleMesh::normal(const std::size_t facet) const
  {
    const auto &[a, b, c] = facets[facet];
    return dealii::cross_product_3d(corners[b] - corners[a],
                                    corners[c] - corners[a]);
  }



  namespace
  {
    /** Merges places within a tolerance of each other (spatial hashing). */
    class DistinctPlaces
    {
    public:
      explicit DistinctPlaces(const double tolerance)
        : tolerance(tolerance)
      {}

      /** The number of the place, or of an earlier one within the tolerance. */
      unsigned int
      number(const Point<3> &place)
      {
        const std::array<long, 3> cell = cell_of(place);
        for (long i = -1; i <= 1; ++i)
          for (long j = -1; j <= 1; ++j)
            for (long k = -1; k <= 1; ++k)
              {
                const auto [begin, end] = numbers.equal_range(
                  hash({{cell[0] + i, cell[1] + j, cell[2] + k}}));
                for (auto found = begin; found != end; ++found)
                  if (places[found->second].distance(place) <= tolerance)
                    return found->second;
              }
        numbers.emplace(hash(cell), places.size());
        places.push_back(place);
        return places.size() - 1;
      }

      std::vector<Point<3>> places;

    private:
      std::array<long, 3>
      cell_of(const Point<3> &place) const
      {
        std::array<long, 3> cell;
        for (unsigned int d = 0; d < 3; ++d)
          cell[d] = std::lround(place[d] / tolerance);
        return cell;
      }

      static std::size_t
      hash(const std::array<long, 3> &cell)
      {
        std::size_t result = 0;
        for (const long i : cell)
          result = (result ^ static_cast<std::size_t>(i)) * 0x9e3779b97f4a7c15u;
        return result;
      }

      const double                                       tolerance;
      std::unordered_multimap<std::size_t, unsigned int> numbers;
    };
  } // namespace



  TriangleMesh
  welded(const std::vector<std::array<Point<3>, 3>> &facets,
         const double                                tolerance)
  {
    // Most corners coincide to the last bit, which sorting finds faster.
    std::vector<std::array<double, 4>> all; // with the number of the corner
    all.reserve(3 * facets.size());
    for (const auto &facet : facets)
      for (const Point<3> &corner : facet)
        all.push_back({{corner[0], corner[1], corner[2], double(all.size())}});
    std::sort(all.begin(), all.end());

    TriangleMesh result;
    result.facets.resize(facets.size());
    DistinctPlaces distinct(tolerance);
    unsigned int   number = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      {
        if (i == 0 || !std::equal(&all[i][0], &all[i][3], &all[i - 1][0]))
          number = distinct.number(Point<3>(all[i][0], all[i][1], all[i][2]));
        const auto corner                     = std::size_t(all[i][3]);
        result.facets[corner / 3][corner % 3] = number;
      }
    result.corners = std::move(distinct.places);
    return result;
  }



  void
  drop_repeated_facets(TriangleMesh &mesh)
  {
    std::set<std::array<unsigned int, 3>> known;
    const auto                            is_repeated = [&](auto facet) {
      std::rotate(facet.begin(),
                  std::min_element(facet.begin(), facet.end()),
                  facet.end());
      return !known.insert(facet).second;
    };
    mesh.facets.erase(std::remove_if(mesh.facets.begin(),
                                     mesh.facets.end(),
                                     is_repeated),
                      mesh.facets.end());
  }



  namespace
  {
    /** An edge of a facet (half-edge), its lower vertex number first. */
    struct EdgeOfFacet
    {
      unsigned int  low, high;
      std::uint32_t facet;
      bool          upwards; // from the low number to the high one

      bool
      same_edge(const EdgeOfFacet &other) const
      {
        return low == other.low && high == other.high;
      }

      bool
      operator<(const EdgeOfFacet &other) const
      {
        return std::tie(low, high, facet) <
               std::tie(other.low, other.high, other.facet);
      }
    };



    std::vector<EdgeOfFacet>
    sorted_edges(const TriangleMesh &mesh)
    {
      std::vector<EdgeOfFacet> edges;
      edges.reserve(3 * mesh.facets.size());
      for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (unsigned int i = 0; i < 3; ++i)
          {
            const unsigned int a = mesh.facets[f][i],
                               b = mesh.facets[f][(i + 1) % 3];
            edges.push_back(
              {std::min(a, b), std::max(a, b), std::uint32_t(f), a < b});
          }
      std::sort(edges.begin(), edges.end());
      return edges;
    }



    /** What is wrong with the facets at one edge, [begin, end), if anything. */
    std::optional<SurfaceFault::Kind>
    fault_at(const EdgeOfFacet *begin, const EdgeOfFacet *end)
    {
      const auto n  = end - begin;
      const auto up = std::count_if(begin, end, [](const EdgeOfFacet &edge) {
        return edge.upwards;
      });
      if (n % 2 == 1)
        return SurfaceFault::Kind::open;
      if (2 * up != n)
        return SurfaceFault::Kind::flipped;
      return std::nullopt;
    }
  } // namespace



  std::optional<SurfaceFault>
  find_fault(const TriangleMesh &mesh)
  {
    const std::vector<EdgeOfFacet> edges = sorted_edges(mesh);
    std::optional<SurfaceFault>    open, flipped;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end)
      {
        while (end < edges.size() && edges[end].same_edge(edges[begin]))
          ++end;
        const auto kind =
          fault_at(&edges[begin], &edges[begin] + (end - begin));
        if (!kind)
          continue;
        auto &fault = *kind == SurfaceFault::Kind::open ? open : flipped;
        if (!fault)
          {
            // The next facet that runs along the edge in the same direction.
            std::size_t other = begin + 1;
            while (other + 1 < end &&
                   edges[other].upwards != edges[begin].upwards)
              ++other;
            fault = {*kind,
                     edges[begin].facet,
                     edges[std::min(other, end - 1)].facet,
                     {{mesh.corners[edges[begin].low],
                       mesh.corners[edges[begin].high]}},
                     0};
          }
        ++fault->n_edges;
      }
    return open ? open : flipped;
  }



  namespace
  {
    Corners<3>
    box_around(const TriangleMesh &mesh)
    {
      Corners<3> box(mesh.corners[mesh.facets[0][0]],
                     mesh.corners[mesh.facets[0][0]]);
      for (const auto &facet : mesh.facets)
        for (const unsigned int corner : facet)
          for (unsigned int d = 0; d < 3; ++d)
            {
              box.first[d]  = std::min(box.first[d], mesh.corners[corner][d]);
              box.second[d] = std::max(box.second[d], mesh.corners[corner][d]);
            }
      return box;
    }



    /** Whether all facets are connected by common vertices (union-find). */
    bool
    is_one_piece(const TriangleMesh &mesh)
    {
      std::vector<unsigned int> leader(mesh.corners.size());
      std::iota(leader.begin(), leader.end(), 0);
      const auto leader_of = [&](unsigned int corner) {
        while (leader[corner] != corner)
          corner = leader[corner] = leader[leader[corner]];
        return corner;
      };
      for (const auto &facet : mesh.facets)
        for (const unsigned int corner : {facet[1], facet[2]})
          leader[leader_of(corner)] = leader_of(facet[0]);
      return std::all_of(mesh.facets.begin(),
                         mesh.facets.end(),
                         [&](const auto &facet) {
                           return leader_of(facet[0]) ==
                                  leader_of(mesh.facets[0][0]);
                         });
    }



    double
    signed_volume(const TriangleMesh &mesh)
    {
      // relative to a corner of the body: far from zero places lose digits
      const Point<3> origin = mesh.corners[mesh.facets[0][0]];
      double         sum    = 0;
      for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        sum += mesh.normal(f) * (mesh.corners[mesh.facets[f][0]] - origin) / 6;
      return sum;
    }
  } // namespace



  ClosedSurface::ClosedSurface(const TriangleMesh &mesh)
    : box(box_around(mesh))
  {
    if (is_one_piece(mesh))
      enclosed = std::abs(signed_volume(mesh));
    // Cast rays along the axis in which the fewest facets lie behind each
    // other.
    double       least = 0;
    unsigned int best  = 0;
    for (unsigned int direction = 0; direction < 3; ++direction)
      {
        set_direction(mesh, direction);
        const Lattice cells = fitting_lattice();
        const double  mean =
          double(count(cells)) / double(cells.n[0] * cells.n[1]);
        if (direction == 0 || mean < least)
          {
            least = mean;
            best  = direction;
          }
      }
    set_direction(mesh, best);
    lattice = fitting_lattice();
    fill(lattice);
  }



  void
  ClosedSurface::set_direction(const TriangleMesh &mesh,
                               const unsigned int  direction)
  {
    ray = direction;
    facets.resize(mesh.facets.size());
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
      {
        Facet &facet = facets[f];
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Point<3> &corner = mesh.corners[mesh.facets[f][i]];
            facet.across[i] = {{corner[(ray + 1) % 3], corner[(ray + 2) % 3]}};
            facet.along[i]  = corner[ray];
          }
        facet.top = *std::max_element(facet.along.begin(), facet.along.end());
      }
  }



  std::size_t
  ClosedSurface::Lattice::index(const unsigned int direction,
                                const double       x) const
  {
    return std::clamp((x - lower[direction]) / edge[direction],
                      0.,
                      n[direction] - 1.);
  }



  std::array<std::size_t, 4>
  ClosedSurface::Lattice::range(const std::array<Place, 3> &triangle) const
  {
    std::array<std::size_t, 4> result;
    for (unsigned int d = 0; d < 2; ++d)
      {
        result[2 * d] =
          index(d, std::min({triangle[0][d], triangle[1][d], triangle[2][d]}));
        result[2 * d + 1] =
          index(d, std::max({triangle[0][d], triangle[1][d], triangle[2][d]}));
      }
    return result;
  }



  std::size_t
  ClosedSurface::count(const Lattice &cells) const
  {
    std::size_t result = 0;
    for (const Facet &facet : facets)
      {
        const auto range = cells.range(facet.across);
        result += (range[1] - range[0] + 1) * (range[3] - range[2] + 1);
      }
    return result;
  }



  ClosedSurface::Lattice
  ClosedSurface::fitting_lattice() const
  {
    Lattice cells;
    Place   extent;
    for (unsigned int d = 0; d < 2; ++d)
      {
        const unsigned int axis = (ray + 1 + d) % 3;
        cells.lower[d]          = box.first[axis];
        extent[d]               = box.second[axis] - box.first[axis];
      }
    const double wanted = std::sqrt(extent[0] * extent[1] / facets.size());
    for (unsigned int d = 0; d < 2; ++d)
      cells.n[d] = wanted > 0 ? std::clamp(extent[d] / wanted, 1., 2048.) : 1;
    // Long facets overlap many cells: coarsen, to limit the memory.
    for (;;)
      {
        for (unsigned int d = 0; d < 2; ++d)
          cells.edge[d] = extent[d] > 0 ? extent[d] / cells.n[d] : 1;
        if (cells.n[0] * cells.n[1] == 1 || count(cells) <= 8 * facets.size())
          return cells;
        for (std::size_t &n : cells.n)
          n = (n + 1) / 2;
      }
  }



  void
  ClosedSurface::fill(Lattice &cells) const
  {
    const auto for_each_cell = [&](const auto &work) {
      for (std::size_t f = 0; f < facets.size(); ++f)
        {
          const auto range = cells.range(facets[f].across);
          for (std::size_t j = range[2]; j <= range[3]; ++j)
            for (std::size_t i = range[0]; i <= range[1]; ++i)
              work(j * cells.n[0] + i, f);
        }
    };
    cells.begins.assign(cells.n[0] * cells.n[1] + 1, 0);
    for_each_cell(
      [&](const std::size_t cell, std::size_t) { ++cells.begins[cell + 1]; });
    std::partial_sum(cells.begins.begin(),
                     cells.begins.end(),
                     cells.begins.begin());
    cells.facets.resize(cells.begins.back());
    std::vector<std::size_t> next(cells.begins.begin(), cells.begins.end() - 1);
    for_each_cell([&](const std::size_t cell, const std::size_t f) {
      cells.facets[next[cell]++] = f;
    });
  }



  namespace
  {
    /**
     * Where the ray through a place intersects the plane of a facet: its
     * coordinate along the ray.
     */
    double
    meeting_place(const std::array<std::array<double, 2>, 3> &across,
                  const std::array<double, 3>                &along,
                  const std::array<double, 2>                &place)
    {
      const auto &[a, b, c] = across;
      const double bx = b[0] - a[0], by = b[1] - a[1];
      const double cx = c[0] - a[0], cy = c[1] - a[1];
      const double x = place[0] - a[0], y = place[1] - a[1];
      const double area = bx * cy - by * cx;
      if (area == 0)
        return along[0];
      const double result =
        along[0] + ((along[1] - along[0]) * (x * cy - y * cx) +
                    (along[2] - along[0]) * (bx * y - by * x)) /
                     area;
      const auto [low, high] = std::minmax({along[0], along[1], along[2]});
      return std::clamp(result, low, high);
    }
  } // namespace



  // Winding number by ray casting. A line through the surface meets exactly as
  // many facets from one side as from the other, in spite of round-off, since
  // neighbours evaluate their common edge by the same expression.
  bool
  ClosedSurface::contains(const Point<3> &point) const
  {
    for (unsigned int d = 0; d < 3; ++d)
      if (point[d] < box.first[d] || point[d] > box.second[d])
        return false;
    const Place       place{{point[(ray + 1) % 3], point[(ray + 2) % 3]}};
    const double      height = point[ray];
    const std::size_t cell =
      lattice.index(1, place[1]) * lattice.n[0] + lattice.index(0, place[0]);
    int winding = 0;
    for (std::size_t i = lattice.begins[cell]; i < lattice.begins[cell + 1];
         ++i)
      {
        const Facet &facet = facets[lattice.facets[i]];
        if (facet.top < height)
          continue;
        const auto &[a, b, c] = facet.across;
        const int side =
          crossing(place, a, b) + crossing(place, b, c) + crossing(place, c, a);
        if (side != 0 &&
            meeting_place(facet.across, facet.along, place) >= height)
          winding += side;
      }
    return winding != 0;
  }



  SignedDistance<3>
  ClosedSurface::signed_distance(const Point<3> &place) const
  {
    if (nearest == nullptr)
      {
        std::vector<NearestFacet::Facet> all(facets.size());
        for (std::size_t f = 0; f < facets.size(); ++f)
          for (unsigned int i = 0; i < 3; ++i)
            {
              all[f][i][ray]           = facets[f].along[i];
              all[f][i][(ray + 1) % 3] = facets[f].across[i][0];
              all[f][i][(ray + 2) % 3] = facets[f].across[i][1];
            }
        nearest = std::make_shared<const NearestFacet>(all, box);
      }
    const NearestFacet::Found  found = (*nearest)(place);
    const dealii::Tensor<1, 3> way   = place - found.place;
    const double               far   = way.norm();
    SignedDistance<3>          result;
    const bool                 inside = contains(place);
    result.value                      = inside ? -far : far;
    const double size                 = box.first.distance(box.second);
    if (far > 1e-9 * size)
      result.normal = way / result.value;
    else // on a facet, whose outside is where the surface does not contain
      result.normal = contains(found.place + 1e-6 * size * found.normal) ?
                        -1. * found.normal :
                        found.normal;
    return result;
  }
} // namespace limber
