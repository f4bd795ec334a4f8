// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/shape_volume.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    /** A lattice of equal, nearly cubic boxes over a larger one. */
    template <int dim>
    struct BoxLattice
    {
      explicit BoxLattice(const Corners<dim> &box)
        : lower(box.first)
      {
        constexpr double n_boxes = dim == 2 ? 4096 : 32768;
        double           volume  = 1;
        for (unsigned int d = 0; d < dim; ++d)
          volume *= box.second[d] - box.first[d];
        const double wanted = std::pow(volume / n_boxes, 1. / dim);
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double length = box.second[d] - box.first[d];
            // even a thin box gets several layers
            n[d]    = std::clamp(std::lround(length / wanted), 8l, 4096l);
            edge[d] = length / n[d];
          }
      }

      dealii::Point<dim>
      place(const std::array<double, dim> &index) const
      {
        dealii::Point<dim> result = lower;
        for (unsigned int d = 0; d < dim; ++d)
          result[d] += index[d] * edge[d];
        return result;
      }

      dealii::Point<dim>      lower;
      std::array<long, dim>   n;
      std::array<double, dim> edge;
    };



    /** Call @p work with each of n^dim (or n_0 n_1 ...) indices. */
    template <int dim, class Work>
    void
    for_each_index(const std::array<long, dim> &n, const Work &work)
    {
      std::array<long, dim> index{};
      const long            depth = dim == 3 ? n[dim - 1] : 1;
      for (long k = 0; k < depth; ++k)
        for (long j = 0; j < n[1]; ++j)
          for (long i = 0; i < n[0]; ++i)
            {
              index[0] = i;
              index[1] = j;
              if (dim == 3)
                index[dim - 1] = k;
              work(index);
            }
    }



    /** The volume fraction of a box of the lattice inside, by sampling. */
    template <int dim>
    double
    share_inside(const Shape<dim>            &shape,
                 const BoxLattice<dim>       &lattice,
                 const std::array<long, dim> &box)
    {
      constexpr long        fine = dim == 2 ? 8 : 4;
      std::array<long, dim> n;
      n.fill(fine);
      double inside = 0, all = 0;
      for_each_index<dim>(n, [&](const std::array<long, dim> &part) {
        std::array<double, dim> index;
        for (unsigned int d = 0; d < dim; ++d)
          index[d] = box[d] + (part[d] + 0.5) / fine;
        inside += shape.contains(lattice.place(index));
        all += 1;
      });
      return inside / all;
    }


    /** Whether the corners of the boxes are inside, each tested once. */
    template <int dim>
    std::vector<char>
    corners_inside(const Shape<dim> &shape, const BoxLattice<dim> &lattice)
    {
      std::array<long, dim> n = lattice.n;
      for (long &corners : n)
        ++corners;
      std::vector<char> result;
      for_each_index<dim>(n, [&](const std::array<long, dim> &corner) {
        std::array<double, dim> index;
        std::copy(corner.begin(), corner.end(), index.begin());
        result.push_back(shape.contains(lattice.place(index)));
      });
      return result;
    }



    /** The number of the lattice's corner at a corner of a box. */
    template <int dim>
    long
    corner_of(const BoxLattice<dim>       &lattice,
              const std::array<long, dim> &box,
              const unsigned int           i)
    {
      long corner = 0;
      for (int d = dim - 1; d >= 0; --d)
        corner = corner * (lattice.n[d] + 1) + box[d] + (i >> d & 1);
      return corner;
    }



    template <int dim>
    dealii::Point<dim>
    centre_of(const BoxLattice<dim> &lattice, const std::array<long, dim> &box)
    {
      std::array<double, dim> centre;
      for (unsigned int d = 0; d < dim; ++d)
        centre[d] = box[d] + 0.5;
      return lattice.place(centre);
    }



    /**
     * The part of a box that holds the shape, as far as corners and centres of
     * a lattice tell, and a box of the lattice around it: the bounding box of a
     * formula may be that of the whole grid. The whole box if none is inside.
     */
    template <int dim>
    Corners<dim>
    tightened(const Shape<dim> &shape, const Corners<dim> &box)
    {
      const BoxLattice<dim>   lattice(box);
      const std::vector<char> is_inside = corners_inside(shape, lattice);
      std::array<long, dim>   first     = lattice.n, last{};
      for_each_index<dim>(lattice.n, [&](const std::array<long, dim> &index) {
        bool any = shape.contains(centre_of<dim>(lattice, index));
        for (unsigned int i = 0; i < 1u << dim; ++i)
          any = any || is_inside[corner_of<dim>(lattice, index, i)];
        if (any)
          for (unsigned int d = 0; d < dim; ++d)
            {
              first[d] = std::min(first[d], std::max(index[d] - 1, 0l));
              last[d] = std::max(last[d], std::min(index[d] + 2, lattice.n[d]));
            }
      });
      if (last[0] == 0)
        return box;
      std::array<double, dim> lower, upper;
      std::copy(first.begin(), first.end(), lower.begin());
      std::copy(last.begin(), last.end(), upper.begin());
      return {lattice.place(lower), lattice.place(upper)};
    }



    /** The number of boxes of the lattice inside, with fractions. */
    template <int dim>
    double
    count_boxes(const Shape<dim> &shape, const BoxLattice<dim> &lattice)
    {
      const std::vector<char> is_inside = corners_inside(shape, lattice);
      double                  boxes     = 0;
      for_each_index<dim>(lattice.n, [&](const std::array<long, dim> &box) {
        int n_inside = 0;
        for (unsigned int i = 0; i < 1u << dim; ++i)
          n_inside += is_inside[corner_of<dim>(lattice, box, i)];
        const int agree =
          shape.contains(centre_of<dim>(lattice, box)) ? 1 << dim : 0;
        boxes += n_inside == agree ? n_inside > 0 :
                                     share_inside<dim>(shape, lattice, box);
      });
      return boxes;
    }
  } // namespace



  template <int dim>
  double
  counted_volume(const Shape<dim> &shape)
  {
    const BoxLattice<dim> lattice(tightened(shape, shape.bounding_box()));
    double                volume = count_boxes(shape, lattice);
    for (const double edge : lattice.edge)
      volume *= edge;
    return volume;
  }



  template <int dim>
  double
  shape_volume(const Shape<dim> &shape)
  {
    const auto exact = shape.exact_volume();
    return exact ? *exact : counted_volume(shape);
  }



  template <int dim>
  VolumeInside<dim>
  volume_inside(const PointView<dim> &points,
                const double          density,
                const Shape<dim>     &shape)
  {
    const Corners<dim> box = shape.bounding_box();
    VolumeInside<dim>  result;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        dealii::Point<dim> place;
        bool               may_be = true;
        for (int d = 0; d < dim; ++d)
          {
            place[d] = points.position[d][p];
            may_be &= place[d] >= box.first[d] && place[d] <= box.second[d];
          }
        if (!may_be || !shape.contains(place))
          continue;
        const double volume = points.mass[p] / density;
        result.volume += volume;
        result.moment += volume * place;
      }
    return result;
  }



  template double
  shape_volume(const Shape<2> &);
  template double
  shape_volume(const Shape<3> &);
  template double
  counted_volume(const Shape<2> &);
  template double
  counted_volume(const Shape<3> &);
  template VolumeInside<2>
  volume_inside(const PointView<2> &, double, const Shape<2> &);
  template VolumeInside<3>
  volume_inside(const PointView<3> &, double, const Shape<3> &);
} // namespace limber
