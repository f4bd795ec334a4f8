// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_shapes_h
#define limber_problem_shapes_h

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <limber/base/functions.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace limber
{
  /** Lower and upper corner of a box along the axes. */
  template <int dim>
  using Corners = std::pair<dealii::Point<dim>, dealii::Point<dim>>;



  /** The region that a body fills at the start; boundaries belong to it. */
  template <int dim>
  class Shape
  {
  public:
    virtual ~Shape() = default;

    virtual bool
    contains(const dealii::Point<dim> &point) const = 0;

    /** A box that holds the whole shape, as tight as is cheaply known. */
    virtual Corners<dim>
    bounding_box() const = 0;

    /** m^dim, where a formula gives it. */
    virtual std::optional<double>
    exact_volume() const
    {
      return std::nullopt;
    }
  };



  /**
   * A quadrilateral or hexahedron: the image of the unit cell under the map
   * that is linear along each of its edges. Corners and faces are counted in
   * deal.II's order, in natural coordinates xi in [0, 1]. Only such shapes
   * have faces that may bear loads.
   */
  template <int dim>
  class BlockShape : public Shape<dim>
  {
  public:
    using Vertices = std::array<dealii::Point<dim>,
                                dealii::GeometryInfo<dim>::vertices_per_cell>;

    explicit BlockShape(const Vertices &vertices);

    /** The place of natural coordinates. */
    dealii::Point<dim>
    place(const dealii::Point<dim> &xi) const;

    /** d x_i / d xi_j, m. */
    dealii::Tensor<2, dim>
    jacobian(const dealii::Point<dim> &xi) const;

    /** Volume of a box in natural coordinates, exact, m^dim. */
    double
    volume(const Corners<dim> &part) const;

    bool
    contains(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

    const Vertices vertices;
  };



  /** A block between two corners, along the axes. */
  template <int dim>
  class BoxShape : public BlockShape<dim>
  {
  public:
    BoxShape(const dealii::Point<dim> &lower, const dealii::Point<dim> &upper);

    bool
    contains(const dealii::Point<dim> &point) const override;

    const dealii::Point<dim> lower, upper;
  };



  /** Disc in two dimensions, ball in three. */
  template <int dim>
  class BallShape : public Shape<dim>
  {
  public:
    BallShape(const dealii::Point<dim> &centre, const double radius);

    bool
    contains(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    dealii::Point<dim> centre;
    double             radius;
  };



  /**
   * Circular cylinder along an axis of coordinates, from @p lower to @p upper
   * on it. Scenes offer it in three dimensions only.
   */
  template <int dim>
  class CylinderShape : public Shape<dim>
  {
  public:
    CylinderShape(const unsigned int        axis,
                  const dealii::Point<dim> &centre,
                  const double              radius,
                  const double              lower,
                  const double              upper);

    bool
    contains(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    unsigned int       axis;
    dealii::Point<dim> centre; // its component along the axis is not used
    double             radius, lower, upper;
  };



  /** Where a formula of x, y (, z) is positive, within a box. */
  template <int dim>
  class FormulaShape : public Shape<dim>
  {
  public:
    FormulaShape(const Formula<dim> &inside, const Corners<dim> &box);

    bool
    contains(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

  private:
    Formula<dim>  inside;
    BoxShape<dim> box;
  };



  /** Everything that lies in at least one of the parts. */
  template <int dim>
  class UnionShape : public Shape<dim>
  {
  public:
    explicit UnionShape(
      const std::vector<std::shared_ptr<const Shape<dim>>> &parts);

    bool
    contains(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

  private:
    std::vector<std::shared_ptr<const Shape<dim>>> parts;
  };
} // namespace limber

#endif
