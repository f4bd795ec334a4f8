// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/farthest_place.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    /** The centre of part @p index of a box in n_parts^dim equal ones. */
    template <int dim>
    Point<dim>
    centre_of_part(const Corners<dim> &box,
                   const unsigned int  n_parts,
                   std::size_t         index)
    {
      Point<dim> place;
      for (unsigned int d = 0; d < dim; ++d, index /= n_parts)
        place[d] = box.first[d] + (index % n_parts + 0.5) / n_parts *
                                    (box.second[d] - box.first[d]);
      return place;
    }



    /**
     * The farthest place along n that rays from the centres of the parts of a
     * box find, and its n . place.
     */
    template <int dim>
    struct Farthest
    {
      Point<dim> place;
      double     reach = -1e300; // n . place, m

      void
      look(const Shape<dim>     &shape,
           const Tensor<1, dim> &n,
           const Corners<dim>   &box,
           const unsigned int    n_parts)
      {
        const double stride  = box.first.distance(box.second) / n_parts;
        const auto   n_all   = std::size_t(std::pow(n_parts, dim) + 0.5);
        double       highest = reach - 2 * stride;
        // Centres that are far behind others along n need no ray.
        std::vector<Point<dim>> inside;
        for (std::size_t i = 0; i < n_all; ++i)
          if (const Point<dim> centre = centre_of_part(box, n_parts, i);
              n * centre > highest - 2 * stride && shape.contains(centre))
            {
              inside.push_back(centre);
              highest = std::max<double>(highest, n * centre);
            }
        for (const Point<dim> &centre : inside)
          if (n * centre > highest - 2 * stride)
            {
              const Point<dim> end =
                centre + way_out(shape, centre, n, stride) * n;
              if (n * end > reach)
                {
                  place = end;
                  reach = n * end;
                }
            }
      }
    };
  } // namespace



  template <int dim>
  std::optional<Point<dim>>
  farthest_place(const Shape<dim> &shape, const Tensor<1, dim> &n)
  {
    const Corners<dim> all = shape.bounding_box();
    Point<dim>         corner;
    for (unsigned int d = 0; d < dim; ++d)
      corner[d] = n[d] > 0 ? all.second[d] : all.first[d];
    if (shape.contains(corner))
      return corner;

    constexpr unsigned int n_coarse = dim == 2 ? 256 : 64, n_fine = 8;
    Farthest<dim>          farthest;
    farthest.look(shape, n, all, n_coarse);
    if (farthest.reach < -1e299)
      return std::nullopt;
    // Then refine around the best place, in ever smaller boxes, which finds
    // sharp corners of the shape and smooth maxima alike.
    for (double part = 4. / n_coarse; part > 1e-10; part /= 2)
      {
        Corners<dim> around;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double half = 0.5 * part * (all.second[d] - all.first[d]);
            around.first[d]   = farthest.place[d] - half;
            around.second[d]  = farthest.place[d] + half;
          }
        farthest.look(shape, n, around, n_fine);
      }
    return farthest.place;
  }



  template <int dim>
  double
  way_out(const Shape<dim>     &shape,
          const Point<dim>     &place,
          const Tensor<1, dim> &n,
          const double          stride)
  {
    double inside = 0, outside = stride;
    while (shape.contains(place + outside * n))
      {
        inside = outside;
        outside += stride;
      }
    while (outside - inside > 1e-13 * stride)
      {
        const double middle = 0.5 * (inside + outside);
        if (middle <= inside || middle >= outside)
          break;
        (shape.contains(place + middle * n) ? inside : outside) = middle;
      }
    return inside;
  }



  template std::optional<Point<2>>
  farthest_place(const Shape<2> &, const Tensor<1, 2> &);
  template std::optional<Point<3>>
  farthest_place(const Shape<3> &, const Tensor<1, 3> &);
  template double
  way_out(const Shape<2> &, const Point<2> &, const Tensor<1, 2> &, double);
  template double
  way_out(const Shape<3> &, const Point<3> &, const Tensor<1, 3> &, double);
} // namespace limber
