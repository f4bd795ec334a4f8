// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/records_of_ranks.h>
#include <limber/interpolation/point_support.h>
#include <limber/time/loaded_face.h>
#include <limber/time/point_deformation.h>
#include <limber/time/surface_closure.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace limber
{
  namespace
  {
    /** Indices of pieces by the id of their carriers. */
    template <int dim>
    std::unordered_multimap<std::uint64_t, std::size_t>
    by_carrier(const std::vector<FacePiece<dim>> &pieces)
    {
      std::unordered_multimap<std::uint64_t, std::size_t> result;
      for (std::size_t i = 0; i < pieces.size(); ++i)
        result.emplace(pieces[i].carrier, i);
      return result;
    }



    /** Call @p work with the place in the arrays of each carrier and its piece.
     */
    template <int dim, class Work>
    void
    for_each_carrier(const MaterialPoints<dim>         &points,
                     const std::vector<FacePiece<dim>> &pieces,
                     const Work                        &work)
    {
      const auto wanted = by_carrier(pieces);
      if (wanted.empty())
        return;
      for (std::size_t p = 0; p < points.size(); ++p)
        {
          const auto [begin, end] = wanted.equal_range(points.id(p));
          for (auto found = begin; found != end; ++found)
            work(p, found->second);
        }
    }



    // A light splinter of a cut body cannot carry the load of a whole piece:
    // carriers have at least this share of the mass of the heaviest point near
    // by, both scaled to cells of the same size.
    constexpr double least_share_of_piece = 0.25;

    // Tolerance for the sum of area vectors of a closed surface over its area
    constexpr double closed = 1e-6;



    /**
     * A point that may carry a piece: whether that is in another cell,
     * distance, place, id. Distances are rounded to a billionth of a cell, so
     * that of points at equal distance the first by coordinates wins on any
     * number of ranks.
     */
    template <int dim>
    using Candidate = std::array<double, 3 + dim>;



    /**
     * Whether a detached piece lies in the cell of a point, or in its boundary.
     * Where cells differ in size the nearest point may be in a smaller cell, to
     * whose nodes the load of the larger one would go.
     */
    template <int dim>
    bool
    is_in_cell_of(const dealii::Point<dim>  &place,
                  const unsigned int         level,
                  const FacePiece<dim>      &piece,
                  const BackgroundGrid<dim> &grid)
    {
      const auto &box = grid.description;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double edge = box.edge(d) / (1u << level);
          const double lower =
            box.lower[d] + std::floor((place[d] - box.lower[d]) / edge) * edge;
          if (std::abs(piece.arm[d] - lower - 0.5 * edge) > (0.5 + 1e-6) * edge)
            return false;
        }
      return true;
    }



    /**
     * By local number of a cell, the detached pieces in it and in its
     * neighbours, whichever their size. A step into these is a bit shorter than
     * they are: from a face between two cells a full one would end in the next
     * cell or, by round-off, in the one behind.
     */
    template <int dim>
    std::unordered_map<std::uint32_t, std::vector<unsigned int>>
    pieces_near_cells(const std::vector<FacePiece<dim>> &pieces,
                      const BackgroundGrid<dim>         &grid)
    {
      std::unordered_map<std::uint32_t, std::vector<unsigned int>> result;
      constexpr unsigned int n_neighbours = dim == 2 ? 9 : 27;
      constexpr double       step         = 1 - 1e-3; // edges
      const auto            &box          = grid.description;
      for (unsigned int i = 0; i < pieces.size(); ++i)
        for (unsigned int level = 0; level <= box.levels; ++level)
          for (unsigned int k = 0; k < n_neighbours; ++k)
            {
              std::array<double, dim> x;
              unsigned int            rest = k;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  x[d] = pieces[i].arm[d] + (int(rest % 3) - 1) * step *
                                              box.edge(d) / (1u << level);
                  rest /= 3;
                }
              const std::uint32_t cell = grid.bins.cell_at(x);
              if (cell < grid.n_owned_cells())
                result[cell].push_back(i);
            }
      return result;
    }



    template <int dim>
    std::string
    nothing_loaded(const FaceLoad<dim> &load)
    {
      const std::string nothing = "'Face load " + load.name +
                                  "' acts on nothing of body '" + load.body +
                                  "': ";
      if (!load.where.empty())
        return nothing + "'Where = " + load.where.expression() +
               "' is positive nowhere on it. Usually the sign is wrong, or that "
               "part lies in a side of the grid. Change 'Where', or enlarge the "
               "grid.";
      return nothing +
             "all of its surface lies in the sides of the grid, or it is "
             "thinner than the spacing of its points. Enlarge the grid, or set "
             "more 'Points per cell edge', for instance 4.";
    }
  } // namespace



  template <int dim>
  LoadedFace<dim>::LoadedFace(const FaceLoad<dim>       &load,
                              const MaterialBody<dim>   &body,
                              const BackgroundGrid<dim> &grid)
    : load(load)
    , body(body)
    , grid(grid)
  {
    auto all = pieces_at_start(load, body.description, grid.description);
    if (all.empty())
      throw InputError(nothing_loaded(load));
    for (const FacePiece<dim> &piece : all)
      centre += piece.arm / double(all.size());
    if (load.is_pressure)
      {
        SurfaceClosure<dim> surface(centre);
        for (const FacePiece<dim> &piece : all)
          surface.add(dealii::Point<dim>(piece.arm), piece.area_vector());
        surface.finish(MPI_COMM_SELF);
        if (surface.opening() < closed)
          n_of_closed = all.size();
      }
    if (!find_carriers(all).empty())
      throw InputError("'Face load " + load.name +
                       "' finds no point of body '" + load.body +
                       "' within one cell of its surface. Usually the body "
                       "is thinner than a spacing; enlarge it, or set more "
                       "'Points per cell edge', for instance 4.");
    adopt(all);
  }



  // Choose the carriers of detached pieces: the nearest point of all ranks,
  // preferably in the cell of the piece. Returns the indices of pieces without.
  template <int dim>
  std::vector<unsigned int>
  LoadedFace<dim>::find_carriers(std::vector<FacePiece<dim>> &all) const
  {
    Candidate<dim> nobody;
    nobody.fill(std::numeric_limits<double>::infinity());

    const auto           near               = pieces_near_cells(all, grid);
    const PointView<dim> points             = body.points.view();
    const auto           for_each_neighbour = [&](const auto &work) {
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto found = near.find(points.cell[p]);
          if (found != near.end())
            for (const unsigned int i : found->second)
              work(p, i);
        }
    };

    const auto in_large_cell = [&](const std::size_t p) {
      return std::ldexp(points.mass[p], dim * body.points.size_class(p));
    };
    std::vector<double> heaviest(all.size(), 0.);
    for_each_neighbour([&](const std::size_t p, const unsigned int i) {
      heaviest[i] = std::max(heaviest[i], in_large_cell(p));
    });
    dealii::Utilities::MPI::max(heaviest, grid.communicator, heaviest);

    std::vector<Candidate<dim>> best(all.size(), nobody);
    const bool initial = body.description.frame == Frame::initial;
    for_each_neighbour([&](const std::size_t p, const unsigned int i) {
      Candidate<dim>     candidate{};
      dealii::Point<dim> place;
      for (unsigned int d = 0; d < dim; ++d)
        place[d] = points.position[d][p];
      const bool is_beside =
        (grid.has_levels() || initial) &&
        !is_in_cell_of(place, grid.level_of(points.cell[p]), all[i], grid);
      const bool is_light =
        in_large_cell(p) < least_share_of_piece * heaviest[i];
      if (is_light && (is_beside || !initial))
        return;
      candidate[0] = 2 * is_beside + is_light;
      candidate[1] = std::round(place.distance(dealii::Point<dim>(all[i].arm)) /
                                (1e-9 * grid.smallest_edge));
      for (unsigned int d = 0; d < dim; ++d)
        candidate[2 + d] = place[d];
      candidate[2 + dim] = body.points.id(p);
      best[i]            = std::min(best[i], candidate);
    });

    std::vector<std::pair<unsigned int, Candidate<dim>>> own;
    for (unsigned int i = 0; i < all.size(); ++i)
      if (best[i] < nobody)
        own.emplace_back(i, best[i]);
    for (const auto &of_rank : gather_records(own, grid.communicator))
      for (const auto &[i, candidate] : of_rank)
        best[i] = std::min(best[i], candidate);

    std::vector<unsigned int> alone;
    for (unsigned int i = 0; i < all.size(); ++i)
      {
        if (best[i] == nobody)
          {
            alone.push_back(i);
            continue;
          }
        all[i].carrier = static_cast<std::uint64_t>(best[i][2 + dim]);
        for (unsigned int d = 0; d < dim; ++d)
          all[i].arm[d] -= best[i][2 + d];
      }
    return alone;
  }



  template <int dim>
  void
  LoadedFace<dim>::adopt(const std::vector<FacePiece<dim>> &candidates)
  {
    for_each_carrier(body.points,
                     candidates,
                     [&](const std::size_t, const std::size_t i) {
                       pieces.push_back(candidates[i]);
                     });
    order = 0;
  }



  template <int dim>
  const std::vector<typename LoadedFace<dim>::Here> &
  LoadedFace<dim>::here()
  {
    if (order != body.points.order())
      {
        present.clear();
        for_each_carrier(body.points,
                         pieces,
                         [&](const std::size_t p, const std::size_t i) {
                           present.push_back({p, &pieces[i]});
                         });
        order = body.points.order();
      }
    return present;
  }



  template <int dim>
  void
  LoadedFace<dim>::exchange()
  {
    std::vector<bool> is_here(pieces.size(), false);
    for_each_carrier(body.points,
                     pieces,
                     [&](const std::size_t, const std::size_t i) {
                       is_here[i] = true;
                     });
    std::vector<FacePiece<dim>> staying, leaving;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      (is_here[i] ? staying : leaving).push_back(pieces[i]);
    pieces.swap(staying);
    for (const auto &of_rank : gather_records(leaving, grid.communicator))
      adopt(of_rank);
    order = 0;
  }



  template <int dim>
  bool
  LoadedFace<dim>::is_closed() const
  {
    return n_of_closed > 0 &&
           dealii::Utilities::MPI::sum(pieces.size(), grid.communicator) ==
             n_of_closed;
  }



  template <int dim>
  std::vector<FacePiece<dim>>
  LoadedFace<dim>::all_pieces() const
  {
    std::vector<FacePiece<dim>> result = pieces;
    unite(result, grid.communicator);
    return result;
  }



  template <int dim>
  std::vector<FacePiece<dim>>
  LoadedFace<dim>::detached_pieces() const
  {
    std::vector<FacePiece<dim>> result = pieces;
    for_each_carrier(body.points,
                     result,
                     [&](const std::size_t p, const std::size_t i) {
                       add_place(p, 1, result[i].arm);
                     });
    unite(result, grid.communicator);
    return result;
  }



  // Pieces without a point near by keep their carriers.
  template <int dim>
  void
  LoadedFace<dim>::attach(std::vector<FacePiece<dim>> detached)
  {
    const auto                  alone = find_carriers(detached);
    std::vector<FacePiece<dim>> with_former;
    for (const unsigned int i : alone)
      with_former.push_back(detached[i]);
    for (auto i = alone.rbegin(); i != alone.rend(); ++i)
      detached.erase(detached.begin() + *i);
    for_each_carrier(body.points,
                     with_former,
                     [&](const std::size_t p, const std::size_t i) {
                       add_place(p, -1, with_former[i].arm);
                     });
    pieces.clear();
    adopt(detached);
    adopt(with_former);
    const auto n_attached =
      dealii::Utilities::MPI::sum(pieces.size(), grid.communicator);
    if (n_attached != detached.size() + with_former.size())
      throw ComputationError(
        "'Face load " + load.name + "' has lost the points of body '" +
        load.body +
        "' that carry it: none is left within one cell of its surface.");
  }



  template <int dim>
  void
  LoadedFace<dim>::add_place(const std::size_t       p,
                             const double            factor,
                             dealii::Tensor<1, dim> &to) const
  {
    const PointView<dim> points = body.points.view();
    for (unsigned int d = 0; d < dim; ++d)
      to[d] += factor * points.position[d][p];
  }



  template <int dim>
  void
  LoadedFace<dim>::restore(const std::vector<FacePiece<dim>> &all)
  {
    pieces.clear();
    adopt(all);
  }



  template <int dim>
  Support<dim>
  support_of_piece(const GridView<dim>  &grid,
                   const PointView<dim> &points,
                   const std::size_t     p,
                   const FacePiece<dim> &piece)
  {
    Support<dim> result = support_of_point<dim>(grid, points, p);
    if (points.in_initial_frame() && !points.has_domains())
      {
        const CellGeometry<dim> &cell      = grid.cells[points.cell[p]];
        bool                     is_inside = true;
        std::array<double, dim>  place;
        for (int d = 0; d < dim; ++d)
          {
            place[d] = piece.reference[d];
            const double xi =
              (place[d] - cell.origin[d]) * cell.inverse_edge[d];
            is_inside = is_inside && std::abs(xi - 0.5) <= 0.5 + 1e-6;
          }
        if (is_inside)
          {
            result.value =
              support_at<dim, false>(grid, points.cell[p], place).value;
            return result;
          }
      }
    const dealii::Tensor<1, dim> arm = pull_back(points, p) * piece.arm;
    for (int i = 0; i < result.n; ++i)
      for (int d = 0; d < dim; ++d)
        result.value[i] += result.gradient[i][d] * arm[d];
    return result;
  }



  template class LoadedFace<2>;
  template class LoadedFace<3>;
  template Support<2>
  support_of_piece(const GridView<2> &,
                   const PointView<2> &,
                   std::size_t,
                   const FacePiece<2> &);
  template Support<3>
  support_of_piece(const GridView<3> &,
                   const PointView<3> &,
                   std::size_t,
                   const FacePiece<3> &);
} // namespace limber
