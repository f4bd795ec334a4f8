// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/points/part_inside.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limber
{
  namespace
  {
    template <int dim>
    double
    volume_of(const Corners<dim> &box)
    {
      double volume = 1;
      for (int d = 0; d < dim; ++d)
        volume *= box.second[d] - box.first[d];
      return volume;
    }



    /**
     * Sums up volume, first and second moments of pieces, about a near centre.
     */
    template <int dim>
    class MomentsAbout
    {
    public:
      explicit MomentsAbout(const dealii::Point<dim> &centre)
        : centre(centre)
      {}

      /** Add a piece with its volume, centroid and second moments about it. */
      void
      add(const double                           volume,
          const dealii::Point<dim>              &place,
          const dealii::SymmetricTensor<2, dim> &spread)
      {
        const dealii::Tensor<1, dim> arm = place - centre;
        sum.volume += volume;
        moment += volume * arm;
        sum.spread += volume * (spread + symmetrize(outer_product(arm, arm)));
      }

      PartInside<dim>
      part() const
      {
        PartInside<dim> result = sum;
        if (result.volume > 0)
          {
            const dealii::Tensor<1, dim> arm = moment / result.volume;
            result.centroid                  = centre + arm;
            result.spread                    = result.spread / result.volume -
                            symmetrize(outer_product(arm, arm));
          }
        return result;
      }

    private:
      const dealii::Point<dim> centre;
      PartInside<dim>          sum;
      dealii::Tensor<1, dim>   moment;
    };



    /**
     * Add the part of a small box, given by its centre and edges, on the inner
     * side of a plane (signed distance at the centre): 2^(dim-1) Gauss rods
     * along the main direction of the normal, clipped where the plane meets
     * their axes.
     */
    template <int dim>
    void
    add_cut_box(const dealii::Point<dim>     &centre,
                const dealii::Tensor<1, dim> &edges,
                const SignedDistance<dim>    &plane,
                MomentsAbout<dim>            &sum)
    {
      unsigned int along  = 0;
      double       volume = 1;
      for (unsigned int d = 0; d < dim; ++d)
        {
          volume *= edges[d];
          if (std::abs(plane.normal[d]) > std::abs(plane.normal[along]))
            along = d;
        }
      const double                         slope = plane.normal[along];
      static const dealii::QGauss<dim - 1> axes(2);
      for (unsigned int q = 0; q < axes.size(); ++q)
        {
          dealii::Point<dim> place = centre;
          for (unsigned int d = 0, k = 0; d < dim; ++d)
            if (d != along)
              place[d] += (axes.point(q)[k++] - 0.5) * edges[d];
          const double value =
            plane.value + plane.normal * (place - centre); // on the axis
          const double share =
            slope == 0 ?
              (value < 0 ? 1. : 0.) :
              std::clamp(0.5 - value / std::abs(slope) / edges[along], 0., 1.);
          if (share == 0)
            continue;
          // the part at the inner end
          place[along] -=
            std::copysign(0.5 * (1 - share) * edges[along], slope);
          dealii::SymmetricTensor<2, dim> spread;
          spread[along][along] =
            share * share * edges[along] * edges[along] / 12;
          sum.add(axes.weight(q) * share * volume, place, spread);
        }
    }



    /**
     * Add the parts of a box inside a shape with a signed distance: the box is
     * divided into n^dim equal ones, and those with corners on both sides are
     * clipped by a plane.
     */
    template <int dim>
    void
    add_pieces(const Shape<dim>   &shape,
               const Corners<dim> &box,
               const unsigned int  n,
               MomentsAbout<dim>  &sum)
    {
      dealii::Tensor<1, dim> edges = (box.second - box.first) / n;
      const auto             lattice =
        [&](const unsigned int per_edge, const double shift, const auto &work) {
          const unsigned int n_all =
            dim == 2 ? per_edge * per_edge : per_edge * per_edge * per_edge;
          for (unsigned int i = 0; i < n_all; ++i)
            {
              dealii::Point<dim>            place = box.first;
              std::array<unsigned int, dim> index;
              for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= per_edge)
                {
                  index[d] = rest % per_edge;
                  place[d] += (index[d] + shift) * edges[d];
                }
              work(index, place);
            }
        };
      std::vector<char> corner_is_inside;
      lattice(n + 1, 0, [&](const auto &, const dealii::Point<dim> &place) {
        corner_is_inside.push_back(shape.contains(place));
      });
      double                          volume = 1;
      dealii::SymmetricTensor<2, dim> spread;
      for (unsigned int d = 0; d < dim; ++d)
        {
          volume *= edges[d];
          spread[d][d] = edges[d] * edges[d] / 12;
        }
      lattice(n, 0.5, [&](const auto &index, const dealii::Point<dim> &place) {
        unsigned int n_inside = 0;
        for (unsigned int a = 0; a < 1u << dim; ++a)
          {
            unsigned int number = 0;
            for (unsigned int d = dim; d-- > 0;)
              number = number * (n + 1) + index[d] + (a >> d & 1);
            n_inside += corner_is_inside[number];
          }
        if (n_inside == 1u << dim)
          sum.add(volume, place, spread);
        else if (n_inside > 0 || shape.contains(place))
          add_cut_box(place, edges, *shape.signed_distance(place), sum);
      });
    }
  } // namespace



  template <int dim>
  PartInside<dim>
  inside_of(const Shape<dim> &shape, const Corners<dim> &box)
  {
    const double volume = volume_of<dim>(box);
    if (auto part = shape.inside_of(box))
      {
        // Round-off of decimal fractions: no sliver.
        if (part->volume <= 1e-6 * volume)
          part->volume = 0;
        return *part;
      }

    // second moments of a box n times smaller along each edge
    const auto spread_of_box = [&](const unsigned int n) {
      dealii::SymmetricTensor<2, dim> result;
      for (int d = 0; d < dim; ++d)
        {
          const double edge = (box.second[d] - box.first[d]) / n;
          result[d][d]      = edge * edge / 12;
        }
      return result;
    };

    using Geometry      = dealii::GeometryInfo<dim>;
    const auto place_at = [&](const dealii::Point<dim> &xi) {
      dealii::Point<dim> place = box.first;
      for (int d = 0; d < dim; ++d)
        place[d] += xi[d] * (box.second[d] - box.first[d]);
      return place;
    };

    // Whether a surface may intersect the box although corners and centre are
    // all on one side, as a thin sheet or the tip of a corner: its distance is
    // less than half the diagonal.
    const dealii::Point<dim> centre =
      box.first + 0.5 * (box.second - box.first);
    const auto distance = shape.signed_distance(centre);
    const bool is_near  = distance && std::abs(distance->value) <=
                                       0.5 * box.first.distance(box.second);

    unsigned int n_inside = 0;
    for (unsigned int i = 0; i < Geometry::vertices_per_cell; ++i)
      n_inside += shape.contains(place_at(Geometry::unit_cell_vertex(i)));
    if (!is_near &&
        n_inside == (shape.contains(centre) ? Geometry::vertices_per_cell : 0))
      return {n_inside > 0 ? volume : 0., centre, spread_of_box(1)};

    MomentsAbout<dim>      sum(centre);
    constexpr unsigned int fine = dim == 2 ? 16 : 8;
    if (distance)
      add_pieces(shape, box, fine, sum);
    else
      {
        static const dealii::QIterated<dim> samples(dealii::QMidpoint<1>(),
                                                    fine);
        for (unsigned int q = 0; q < samples.size(); ++q)
          {
            const dealii::Point<dim> place = place_at(samples.point(q));
            if (shape.contains(place))
              sum.add(samples.weight(q) * volume, place, spread_of_box(fine));
          }
      }
    // Volumes below one sub-box count as zero: very light points fly off.
    PartInside<dim> result = sum.part();
    if (result.volume < volume / (dim == 2 ? 256 : 512))
      result.volume = 0;
    return result;
  }



  template PartInside<2>
  inside_of(const Shape<2> &, const Corners<2> &);
  template PartInside<3>
  inside_of(const Shape<3> &, const Corners<3> &);
} // namespace limber
