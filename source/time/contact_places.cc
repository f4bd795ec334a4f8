// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/grid/node_vector.h>
#include <limber/state/stretch.h>
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>

#include <algorithm>
#include <cmath>
#include <map>

/**
 * @file Contact points ("places") of bodies in a step: which points face each
 * other, the gap between them, and the nodes and coefficients of their relative
 * velocity.
 */
namespace limber
{
  namespace
  {
    // Steps after which the stretch of bodies is updated. It only selects the
    // points to look at, with a margin for half as much again.
    constexpr unsigned int steps_of_a_stretch = 32;
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
          sides.resize(parting.size());
          for (Sides &both : sides)
            for (auto &side : both)
              side.clear();
          for (const Group &group : groups)
            gather<n>(group);
          tell_candidates();
          for (std::size_t k = 0; k < parting.size(); ++k)
            add_points<n>(parting[k], sides[k], step);
          impulses.finish_adding(exchange_parts<n>());
        }
    });
  }



  // Contact at nodes, for linear functions. All ranks that hold a node do the
  // same with it.
  template <int dim>
  void
  Contact<dim>::add_nodes()
  {
    for (std::size_t t = 0; t < contact_nodes.size(); ++t)
      if (const ContactNode &contact = contact_nodes[t];
          points_touch[t] &&
          law(contact.a, contact.b).law == ContactLaw::separate)
        {
          const double a = parts.nodes.record(contact.a,
                                              contact.node)[Layout::mass],
                       b = parts.nodes.record(contact.b,
                                              contact.node)[Layout::mass];
          auto &place    = impulses.add_place();
          for (int d = 0; d < dim; ++d)
            place.normal[d] = -faces[t].normal[d];
          place.friction = law(contact.a, contact.b).friction;
          place.mass     = a * b / (a + b);
          place.is_own   = parts.nodes.owns(contact.node);
          impulses.add_share(contact.a, contact.node, 1);
          impulses.add_share(contact.b, contact.node, -1);
        }
    impulses.finish_adding_nodes();
  }



  // Send points near cells of another rank to it.
  template <int dim>
  void
  Contact<dim>::tell_candidates()
  {
    if (ranks_of_vertex.empty())
      return;
    std::map<unsigned int, std::vector<double>> told;
    std::vector<unsigned int>                   ranks;
    for (std::size_t k = 0; k < sides.size(); ++k)
      for (unsigned int s = 0; s < 2; ++s)
        for (const Candidate &candidate : sides[k][s])
          {
            const std::uint32_t cell =
              points[candidate.body].cell[candidate.point];
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
         exchange_records(told, parts.grid.communicator))
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
          sides[side / 2][side % 2].push_back(candidate);
        }
  }



  // Each rank adds the shares that its points have in contact points of other
  // ranks.
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
         exchange_records(asked, parts.grid.communicator))
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
          finish_part<degree>();
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
                           const Sides                       &both,
                           const double                       step)
  {
    double widest = 0;
    for (const auto &side : both)
      for (const Candidate &candidate : side)
        widest = std::max({widest, candidate.reach, candidate.width});
    // contact points are at the smaller points, which find all facing ones
    const unsigned int acting = edge[pair[1]] < edge[pair[0]] ? 1 : 0;
    if (both[acting].empty() || both[1 - acting].empty())
      return;
    const double spacing = 4 * widest;
    bins.fill(both[1 - acting], spacing);
    add_places<degree>(
      both[acting], both[1 - acting], spacing, law(pair[0], pair[1]), step);
  }



  // Largest stretch normal to the surface of a body's points in contact.
  template <int dim>
  double
  Contact<dim>::stretch_of(const Group &group)
  {
    Stretch &stretch = stretches[group.body];
    if (stretch.age++ % steps_of_a_stretch == 0)
      {
        stretch.largest = 1;
        for (std::size_t k = group.first; k < group.last; ++k)
          stretch.largest =
            std::max(stretch.largest,
                     stretch_along(*parts.bodies[group.body],
                                   points[group.body],
                                   batches[k].batch.begin,
                                   vector_in<dim>(
                                     faces[corners[batches[k].first].slot / 2]
                                       .normal.data())));
      }
    return stretch.largest;
  }



  // List the points of a body near others as candidates, with contact normals
  // interpolated from the nodes.
  template <int dim>
  template <int degree>
  void
  Contact<dim>::gather(const Group &group)
  {
    const PointView<dim>    &of_body         = points[group.body];
    const MaterialBody<dim> &body            = *parts.bodies[group.body];
    const unsigned int       field           = field_of(group.body);
    const double             stretch         = stretch_of(group);
    const double             inverse_density = 1 / body.stress->density();
    double                   largest_reach   = 0; // of those that may be met
    for (const auto &pair : parting)
      for (unsigned int s = 0; s < 2; ++s)
        if (pair[s] == field)
          largest_reach = std::max(largest_reach, reach[pair[1 - s]]);
    for (std::size_t b = group.first; b < group.last; ++b)
      {
        const MeetingBatch &some = batches[b];
        near.clear();
        list_near_points<dim>(of_body,
                              some,
                              corners.data(),
                              inverse_density,
                              faces.data(),
                              stretch,
                              largest_reach,
                              near);
        CellFunctions<dim, degree> functions(grid, some.batch.cell);
        for (const std::uint32_t p : near)
          {
            functions.go_to(of_body, p);
            for (std::size_t k = 0; k < parting.size(); ++k)
              {
                const auto &pair = parting[k];
                if (field != pair[0] && field != pair[1])
                  continue;
                const bool is_a = field == pair[0];
                Vector     normal;
                for (std::uint32_t c = some.first; c < some.last; ++c)
                  {
                    const MeetingCorner &corner = corners[c];
                    const ContactNode &contact = contact_nodes[corner.slot / 2];
                    if (contact.a != pair[0] || contact.b != pair[1])
                      continue;
                    const double weight =
                      corner.share * functions.value(corner.k);
                    const auto &of_node = faces[corner.slot / 2].normal;
                    for (int d = 0; d < dim; ++d)
                      normal[d] += weight * of_node[d];
                  }
                const double length = normal.norm();
                if (!(length > 0))
                  continue;
                Candidate candidate;
                candidate.normal = normal / (is_a ? length : -length);
                for (int d = 0; d < dim; ++d)
                  {
                    candidate.place[d]    = of_body.position[d][p];
                    candidate.velocity[d] = of_body.velocity[d][p];
                  }
                candidate.mass = of_body.mass[p];
                const double half_edge =
                  half_edge_of<dim>(candidate.mass * inverse_density);
                candidate.reach =
                  reach_of(of_body, p, half_edge) *
                  stretch_along(body, of_body, p, candidate.normal);
                candidate.width = half_edge;
                if constexpr (dim == 2)
                  candidate.width *=
                    stretch_along(body,
                                  of_body,
                                  p,
                                  dealii::cross_product_2d(candidate.normal));
                candidate.body  = group.body;
                candidate.point = p;
                candidate.rank  = this_rank;
                sides[k][is_a ? 0 : 1].push_back(candidate);
              }
          }
      }
  }



  // Add weight * (v + grad v arm) at a point to the coefficients of a contact
  // point. Points of one cell see the same nodes and are summed up first.
  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_part(const Candidate &candidate,
                         const Vector    &arm,
                         const double     weight)
  {
    const PointView<dim>      &of_body = points[candidate.body];
    const std::uint32_t        cell    = of_body.cell[candidate.point];
    const unsigned int         field   = field_of(candidate.body);
    CellFunctions<dim, degree> functions(grid, cell);
    if (cell != part.cell || field != part.field)
      {
        finish_part<degree>();
        part.cell  = cell;
        part.field = field;
        std::fill_n(part.shares.begin(), functions.n, 0.);
        std::fill_n(part.sizes.begin(), functions.n, 0.);
      }
    functions.go_to(of_body, candidate.point);
    functions.add_at_end_of(arm, weight, part.shares.data(), part.sizes.data());
  }



  template <int dim>
  template <int degree>
  void
  Contact<dim>::finish_part()
  {
    if (part.cell == Part::no_cell)
      return;
    impulses.add_shares(part.field,
                        CellFunctions<dim, degree>::nodes_of(grid, part.cell),
                        part.shares.data(),
                        part.sizes.data());
    part.cell = Part::no_cell;
  }



  // Whether another point lies in front of q, so that q is not at the surface:
  // its gap is larger by more than the extent of that point, however thin.
  template <int dim>
  bool
  Contact<dim>::is_covered(const Facing                 &q,
                           const std::vector<Candidate> &other) const
  {
    const double width = other[q.candidate].width;
    for (const Facing &front : facing)
      {
        const Candidate &in_front = other[front.candidate];
        const double     aside    = std::max(width, in_front.width);
        if (q.gap - front.gap > in_front.reach &&
            (q.along - front.along).norm_square() < aside * aside)
          return true;
      }
    return false;
  }



  // Contact points at the acting points: their gap to the facing points of the
  // other body, and the coefficients of the relative velocity (see Contact).
  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_places(const std::vector<Candidate> &acting,
                           const std::vector<Candidate> &other,
                           const double                  spacing,
                           const Law                    &law,
                           const double                  step)
  {
    const auto flows = [this](const Candidate &candidate) {
      return parts.bodies[candidate.body]->description.is_plastic;
    };
    for (const Candidate &p : acting)
      {
        if (p.rank != this_rank)
          continue;
        facing.clear();
        double least_gap = 1e300;
        for (const std::uint32_t k : bins.around(p.place))
          {
            const Candidate &q        = other[k];
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
            facing.push_back({k, gap, overlap, along});
          }
        if (least_gap > spacing)
          continue;
        double sum = 0, gap = 0, approach = 0, flowing = 0;
        Vector aside;
        for (Facing &q : facing)
          {
            q.weight *=
              std::max(0., 1 - (q.gap - least_gap) / other[q.candidate].reach);
            if (q.weight > 0 && is_covered(q, other))
              q.weight = 0;
            sum += q.weight;
            gap += q.weight * q.gap;
            if (flows(other[q.candidate]))
              flowing += q.weight * other[q.candidate].reach;
            aside += q.weight * q.along;
            approach += q.weight *
                        ((p.velocity - other[q.candidate].velocity) * p.normal);
          }
        if (sum < 0.25) // p is past the end of the other body
          continue;
        gap /= sum;
        aside /= sum;
        approach = std::max(0., approach / sum);
        if (!may_press(gap, step * approach, p.reach))
          continue;
        flowing /= sum;
        if (flows(p))
          flowing += p.reach;
        const double left       = share_left(gap, flowing);
        const auto   reach_left = [&](const Candidate &candidate) {
          return (flows(candidate) ? left : 1) * candidate.reach;
        };
        const auto place_number =
          static_cast<std::uint32_t>(impulses.all().size());
        auto &place    = impulses.add_place();
        place.normal   = -p.normal;
        place.least    = least_growth(gap, p.reach) / step;
        place.friction = law.friction;
        place.mass     = p.mass;
        add_part<degree>(p, reach_left(p) * p.normal, 1);
        for (const Facing &q : facing)
          {
            const Candidate &other_point = other[q.candidate];
            if (!(q.weight > 0))
              continue;
            const Vector arm    = -reach_left(other_point) * p.normal - aside;
            const double weight = -q.weight / sum;
            if (other_point.rank == this_rank)
              add_part<degree>(other_point, arm, weight);
            else
              ask_for_part(place_number, other_point, arm, weight);
          }
        finish_part<degree>();
      }
  }



  // Before the first part for a rank, the contact point itself is recorded.
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
