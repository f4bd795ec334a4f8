// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_block_h
#define limber_problem_block_h

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/tensor.h>

#include <limber/problem/shape.h>

#include <array>

namespace limber
{
  /**
   * A quadrilateral or hexahedron: the image of the unit cell under the
   * multilinear map. Corners and faces are counted in deal.II's order, in
   * natural coordinates xi in [0, 1]. Only such shapes have faces that may bear
   * loads.
   */
  template <int dim>
  class BlockShape : public Shape<dim>
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "block", *section = "Block";
    static constexpr const char *text =
      "quadrilateral or hexahedron, by its corners";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    using Vertices = std::array<dealii::Point<dim>,
                                dealii::GeometryInfo<dim>::vertices_per_cell>;

    explicit BlockShape(const Vertices &vertices);

    /** Map from natural coordinates. */
    dealii::Point<dim>
    place(const dealii::Point<dim> &xi) const;

    /** Jacobian matrix d x_i / d xi_j, m. */
    dealii::Tensor<2, dim>
    jacobian(const dealii::Point<dim> &xi) const;

    /** Exact volume of a box in natural coordinates, m^dim. */
    double
    volume(const Corners<dim> &part) const;

    bool
    contains(const dealii::Point<dim> &point) const override;

    /** In the plane; nothing in space. */
    std::optional<PartInside<dim>>
    inside_of(const Corners<dim> &box) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

    const Vertices vertices;
  };
} // namespace limber

#endif
