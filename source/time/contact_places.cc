// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>

#include <algorithm>
#include <cmath>
#include <map>

/**
 * @file The places at which bodies may press on each other in a step: which
 * points face each other, how far they are apart, and what nodes they see.
 */
namespace limber
{
  namespace
  {
    /** Bins of equal edges over all space, numbered along rows. */
    template <int dim>
    struct Bins
    {
      double inverse_edge;

      std::array<std::int64_t, dim>
      at(const dealii::Point<dim> &place) const
      {
        std::array<std::int64_t, dim> result;
        for (int d = 0; d < dim; ++d)
          result[d] = std::int64_t(std::floor(place[d] * inverse_edge));
        return result;
      }

      static std::uint64_t
      key(const std::array<std::int64_t, dim> &bin)
      {
        constexpr int bits   = 64 / dim;
        std::uint64_t result = 0;
        for (int d = dim - 1; d >= 0; --d)
          result = (result << bits) +
                   std::uint64_t(bin[d] + (std::int64_t(1) << (bits - 1)));
        return result;
      }
    };
  } // namespace



  template <int dim>
  void
  Contact<dim>::find_places(const double step)
  {
    impulses.clear();
    with_degree(parts.nodes.view(), [&](const auto degree) {
      constexpr int n = decltype(degree)::value;
      if constexpr (n == 1)
        add_nodes();
      else
        {
          std::vector<Sides> sides(parting.size());
          for (std::size_t k = 0; k < parting.size(); ++k)
            gather<n>(parting[k], sides[k]);
          tell_candidates(sides);
          for (std::size_t k = 0; k < parting.size(); ++k)
            add_points<n>(parting[k], sides[k], step);
          impulses.finish_adding(exchange_parts<n>());
        }
    });
  }



  // All ranks that hold a node do the same with it.
  template <int dim>
  void
  Contact<dim>::add_nodes()
  {
    for (const Touch &touch : touches)
      if (law(touch.a, touch.b).law == ContactLaw::separate &&
          touch.points_touch)
        {
          const double a =
                         parts.nodes.record(touch.a, touch.node)[Layout::mass],
                       b =
                         parts.nodes.record(touch.b, touch.node)[Layout::mass];
          auto &place    = impulses.add_place();
          place.normal   = -touch.normal;
          place.friction = law(touch.a, touch.b).friction;
          place.mass     = a * b / (a + b);
          place.is_own   = parts.nodes.owns(touch.node);
          impulses.add_share(touch.a, touch.node, 1);
          impulses.add_share(touch.b, touch.node, -1);
        }
    impulses.finish_adding_nodes();
  }



  // What is near cells of another rank, it has to know.
  template <int dim>
  void
  Contact<dim>::tell_candidates(std::vector<Sides> &sides)
  {
    if (ranks_of_vertex.empty())
      return;
    const GridView<dim>                         grid = parts.nodes.view();
    std::map<unsigned int, std::vector<double>> told;
    std::vector<unsigned int>                   ranks;
    for (std::size_t k = 0; k < sides.size(); ++k)
      for (unsigned int s = 0; s < 2; ++s)
        for (const Candidate &candidate : sides[k][s].all)
          {
            const std::uint32_t cell =
              parts.bodies[candidate.body]->points.view().cell[candidate.point];
            ranks.clear();
            for (const std::uint32_t node : grid.cells[cell].node)
              if (const auto found =
                    ranks_of_vertex.find(node / Layout::stride);
                  found != ranks_of_vertex.end())
                ranks.insert(ranks.end(),
                             found->second.begin(),
                             found->second.end());
            std::sort(ranks.begin(), ranks.end());
            ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
            for (const unsigned int rank : ranks)
              {
                auto &to = told[rank];
                to.push_back(2. * k + s);
                for (int d = 0; d < dim; ++d)
                  {
                    to.push_back(candidate.place[d]);
                    to.push_back(candidate.normal[d]);
                    to.push_back(candidate.velocity[d]);
                  }
                for (const double number : {candidate.reach,
                                            candidate.width,
                                            candidate.mass,
                                            double(candidate.body),
                                            double(candidate.point)})
                  to.push_back(number);
              }
          }
    for (const auto &[rank, numbers] :
         dealii::Utilities::MPI::some_to_some(parts.grid.communicator, told))
      for (auto number = numbers.begin(); number != numbers.end();)
        {
          const auto side = static_cast<unsigned int>(*number++);
          Candidate  candidate;
          candidate.rank = rank;
          for (int d = 0; d < dim; ++d)
            {
              candidate.place[d]    = *number++;
              candidate.normal[d]   = *number++;
              candidate.velocity[d] = *number++;
            }
          candidate.reach = *number++;
          candidate.width = *number++;
          candidate.mass  = *number++;
          candidate.body  = static_cast<std::uint32_t>(*number++);
          candidate.point = static_cast<std::uint32_t>(*number++);
          sides[side / 2][side % 2].all.push_back(candidate);
        }
  }



  // Each rank adds what its points have of the places of others.
  template <int dim>
  template <int degree>
  std::vector<typename ContactImpulses<dim>::Peer>
  Contact<dim>::exchange_parts()
  {
    std::vector<typename ContactImpulses<dim>::Peer> result;
    if (ranks_of_vertex.empty())
      return result;
    std::map<unsigned int, typename ContactImpulses<dim>::Peer> peers;
    std::map<unsigned int, std::vector<double>>                 asked;
    for (auto &[rank, elsewhere] : parts_elsewhere)
      {
        peers[rank].own = std::move(elsewhere.places);
        asked[rank]     = std::move(elsewhere.numbers);
      }
    parts_elsewhere.clear();
    for (const auto &[rank, numbers] :
         dealii::Utilities::MPI::some_to_some(parts.grid.communicator, asked))
      for (auto number = numbers.begin(); number != numbers.end();)
        {
          peers[rank].parts.push_back(
            static_cast<std::uint32_t>(impulses.all().size()));
          auto &place = impulses.add_place();
          for (int d = 0; d < dim; ++d)
            place.normal[d] = *number++;
          place.least    = *number++;
          place.friction = *number++;
          place.mass     = *number++;
          place.is_own   = false;
          for (auto n = static_cast<unsigned int>(*number++); n > 0; --n)
            {
              Candidate candidate;
              candidate.body  = static_cast<std::uint32_t>(*number++);
              candidate.point = static_cast<std::uint32_t>(*number++);
              Vector arm;
              for (int d = 0; d < dim; ++d)
                arm[d] = *number++;
              const double weight = *number++;
              add_part<degree>(candidate, arm, weight);
            }
        }
    for (auto &[rank, peer] : peers)
      {
        peer.rank = rank;
        result.push_back(std::move(peer));
      }
    return result;
  }



  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_points(const std::array<unsigned int, 2> &pair,
                           Sides                             &sides,
                           const double                       step)
  {
    double widest = 0;
    for (Side &side : sides)
      for (const Candidate &candidate : side.all)
        widest = std::max({widest, candidate.reach, candidate.width});
    if (widest == 0)
      return;
    const double    spacing = 4 * widest;
    const Bins<dim> bins{1 / spacing};
    for (Side &side : sides)
      {
        for (std::uint32_t k = 0; k < side.all.size(); ++k)
          side.by_bin.emplace_back(Bins<dim>::key(bins.at(side.all[k].place)),
                                   k);
        std::sort(side.by_bin.begin(), side.by_bin.end());
      }
    // the smaller points meet all that the larger ones do
    const unsigned int acting = edge[pair[1]] < edge[pair[0]] ? 1 : 0;
    add_places<degree>(
      sides[acting], sides[1 - acting], spacing, law(pair[0], pair[1]), step);
  }



  template <int dim>
  template <int degree>
  void
  Contact<dim>::gather(const std::array<unsigned int, 2> &pair, Sides &sides)
  {
    const GridView<dim> grid = parts.nodes.view();
    for (const std::uint32_t vertex : marked)
      of_pair_at[vertex] = 0;
    marked.clear();
    for (const Neighbours &some : neighbours)
      for (unsigned int s = 0; s < 2; ++s)
        if (field_of(some.body) == pair[s])
          for (const std::uint32_t node : grid.cells[some.batch.cell].node)
            {
              of_pair_at[node / Layout::stride] |= 1 + s;
              marked.push_back(node / Layout::stride);
            }
    for_each_neighbour([&](const Neighbours     &some,
                           const PointView<dim> &points,
                           const double          inverse_density) {
      const unsigned int field = field_of(some.body);
      if (field != pair[0] && field != pair[1])
        return;
      const bool is_a    = field == pair[0];
      bool       is_near = false;
      for (const std::uint32_t node : grid.cells[some.batch.cell].node)
        is_near |= (of_pair_at[node / Layout::stride] & (is_a ? 2 : 1)) != 0 ||
                   (!ranks_of_vertex.empty() &&
                    ranks_of_vertex.count(node / Layout::stride) > 0);
      if (!is_near)
        return;
      const StressUpdate<dim>   &stress = *parts.bodies[some.body]->stress;
      CellFunctions<dim, degree> functions(grid, some.batch.cell);
      for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
        {
          functions.go_to(points, p);
          Vector normal;
          for (std::size_t c = some.first; c < some.last; ++c)
            {
              const Touch &touch = touches[corners[c].touch];
              if (touch.a == pair[0] && touch.b == pair[1])
                normal += corners[c].share * functions.value(corners[c].k) *
                          touch.normal;
            }
          const double length = normal.norm();
          if (!(length > 0))
            continue;
          Candidate candidate;
          candidate.normal = normal / (is_a ? length : -length);
          for (int d = 0; d < dim; ++d)
            {
              candidate.place[d]    = points.position[d][p];
              candidate.velocity[d] = points.velocity[d][p];
            }
          candidate.mass = points.mass[p];
          const double half_edge =
            half_edge_of<dim>(points.mass[p] * inverse_density);
          std::array<double, dim> across, along;
          for (int d = 0; d < dim; ++d)
            across[d] = candidate.normal[d];
          along.fill(0);
          if constexpr (dim == 2)
            along = {{-across[1], across[0]}};
          candidate.reach =
            (points.reach != nullptr ? points.reach[p] : half_edge) *
            stress.stretch_along(points, p, across);
          candidate.width = half_edge;
          if (dim == 2)
            candidate.width *= stress.stretch_along(points, p, along);
          candidate.body  = some.body;
          candidate.point = static_cast<std::uint32_t>(p);
          candidate.rank  = this_rank;
          sides[is_a ? 0 : 1].all.push_back(candidate);
        }
    });
  }



  // What side a has at its points, of both: weight * (v + grad v arm).
  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_part(const Candidate &candidate,
                         const Vector    &arm,
                         const double     weight)
  {
    const PointView<dim> points = parts.bodies[candidate.body]->points.view();
    CellFunctions<dim, degree> functions(parts.nodes.view(),
                                         points.cell[candidate.point]);
    functions.go_to(points, candidate.point);
    const unsigned int field = field_of(candidate.body);
    for (int k = 0; k < functions.n; ++k)
      {
        double slope = 0;
        for (int d = 0; d < dim; ++d)
          slope += arm[d] * functions.slope(k, d);
        impulses.add_share(field,
                           functions.node(k),
                           weight * (functions.value(k) + slope));
      }
  }



  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_places(const Side  &acting,
                           const Side  &other,
                           const double spacing,
                           const Law   &law,
                           const double step)
  {
    struct Facing
    {
      std::uint32_t candidate;
      double        gap, weight;
      Vector        along;
    };
    std::vector<Facing> facing;
    const Bins<dim>     bins{1 / spacing};
    constexpr int       n_rows = dim == 2 ? 3 : 9;
    for (const Candidate &p : acting.all)
      {
        if (p.rank != this_rank)
          continue;
        facing.clear();
        double     least_gap = 1e300;
        const auto bin       = bins.at(p.place);
        for (int row = 0; row < n_rows; ++row)
          {
            auto first = bin;
            first[0] -= 1;
            first[1] += row % 3 - 1;
            if (dim == 3)
              first[dim - 1] += row / 3 - 1;
            const std::uint64_t begin = Bins<dim>::key(first);
            for (auto k = std::lower_bound(other.by_bin.begin(),
                                           other.by_bin.end(),
                                           std::make_pair(begin, 0u));
                 k != other.by_bin.end() && k->first <= begin + 2;
                 ++k)
              {
                const Candidate &q        = other.all[k->second];
                const Vector     distance = q.place - p.place;
                const double     across   = distance * p.normal;
                if (across <= 0)
                  continue;
                const Vector along   = distance - across * p.normal;
                const double overlap = 1 - along.norm() / (p.width + q.width);
                if (overlap <= 0)
                  continue;
                const double gap = across - p.reach - q.reach;
                least_gap        = std::min(least_gap, gap);
                facing.push_back({k->second, gap, overlap, along});
              }
          }
        if (least_gap > spacing)
          continue;
        double sum = 0, gap = 0, approach = 0;
        Vector aside;
        for (Facing &q : facing)
          {
            q.weight *=
              std::max(0.,
                       1 - (q.gap - least_gap) / other.all[q.candidate].reach);
            sum += q.weight;
            gap += q.weight * q.gap;
            aside += q.weight * q.along;
            approach +=
              q.weight *
              ((p.velocity - other.all[q.candidate].velocity) * p.normal);
          }
        if (sum < 0.25)
          continue;
        gap /= sum;
        aside /= sum;
        approach = std::max(0., approach / sum);
        if (!may_press(gap, step * approach, p.reach))
          continue;
        const auto place_number =
          static_cast<std::uint32_t>(impulses.all().size());
        auto &place    = impulses.add_place();
        place.normal   = -p.normal;
        place.least    = least_growth(gap, p.reach) / step;
        place.friction = law.friction;
        place.mass     = p.mass;
        add_part<degree>(p, p.reach * p.normal, 1);
        for (const Facing &q : facing)
          {
            const Candidate &other_point = other.all[q.candidate];
            if (!(q.weight > 0))
              continue;
            const Vector arm    = -other_point.reach * p.normal - aside;
            const double weight = -q.weight / sum;
            if (other_point.rank == this_rank)
              add_part<degree>(other_point, arm, weight);
            else
              ask_for_part(place_number, other_point, arm, weight);
          }
      }
  }



  // The rank of the point is told of the place before its first part.
  template <int dim>
  void
  Contact<dim>::ask_for_part(const std::uint32_t place_number,
                             const Candidate    &candidate,
                             const Vector       &arm,
                             const double        weight)
  {
    PartsElsewhere &elsewhere = parts_elsewhere[candidate.rank];
    auto           &numbers   = elsewhere.numbers;
    if (elsewhere.places.empty() || elsewhere.places.back() != place_number)
      {
        const auto &place = impulses.all()[place_number];
        elsewhere.places.push_back(place_number);
        for (int d = 0; d < dim; ++d)
          numbers.push_back(place.normal[d]);
        numbers.insert(numbers.end(),
                       {place.least, place.friction, place.mass, 0.});
        elsewhere.n_parts = numbers.size() - 1;
      }
    numbers[elsewhere.n_parts] += 1;
    numbers.push_back(candidate.body);
    numbers.push_back(candidate.point);
    for (int d = 0; d < dim; ++d)
      numbers.push_back(arm[d]);
    numbers.push_back(weight);
  }



  template void
  Contact<2>::find_places(double);
  template void
  Contact<3>::find_places(double);
} // namespace limber
