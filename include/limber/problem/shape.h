// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_shape_h
#define limber_problem_shape_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <limber/base/functions.h>

#include <memory>
#include <optional>
#include <utility>

namespace limber
{
  class Parameters;
  class Section;



  /** Lower and upper corner of a box along the axes. */
  template <int dim>
  using Corners = std::pair<dealii::Point<dim>, dealii::Point<dim>>;



  /** Signed distance of a place from the surface of a shape (level set). */
  template <int dim>
  struct SignedDistance
  {
    double value = 0; // m, negative inside
    // Outward, of length 1: the gradient of the distance where it has one
    dealii::Tensor<1, dim> normal;
  };



  /** Moments of the part of a cell or box inside a shape. */
  template <int dim>
  struct PartInside
  {
    double             volume = 0; // m^dim
    dealii::Point<dim> centroid;
    // Mean of (x - centroid) (x - centroid)^T, m^2
    dealii::SymmetricTensor<2, dim> spread;
  };



  /** The region of a body at the start, or of an obstacle; closed, that is, its
   * boundary belongs to it. */
  template <int dim>
  class Shape
  {
  public:
    virtual ~Shape() = default;

    virtual bool
    contains(const dealii::Point<dim> &point) const = 0;

    /** A box around the whole shape, as tight as is cheaply known. */
    virtual Corners<dim>
    bounding_box() const = 0;

    /** Volume, m^dim; empty unless there is a formula for it. */
    virtual std::optional<double>
    exact_volume() const
    {
      return std::nullopt;
    }

    /** The part of a box along the axes inside the shape; empty unless there is
     * a formula for it. */
    virtual std::optional<PartInside<dim>>
    inside_of(const Corners<dim> &) const
    {
      return std::nullopt;
    }

    /** Whether it is a body of revolution about an axis, of unit length,
     * through a place; in two dimensions about z. */
    virtual bool
    is_round_about(const dealii::Point<dim> & /*place*/,
                   const dealii::Tensor<1, 3> & /*axis*/) const
    {
      return false;
    }

    /** Empty for shapes that cannot tell. */
    virtual std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &) const
    {
      return std::nullopt;
    }
  };



  /** Where the scene describes a shape, and what it may refer to. */
  template <int dim>
  struct ShapeSections
  {
    const Section      &owner;   // has the entry 'Shape'
    const Section      &details; // has the measures
    const Constants    &constants;
    const Corners<dim> &grid;
  };
} // namespace limber

#endif
