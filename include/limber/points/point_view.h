// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_point_view_h
#define limber_points_point_view_h

#include <limber/grid/grid_view.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace limber
{
  /**
   * Independent components of a stress deviator: xx, yy, xy in two
   * dimensions, xx, yy, xy, yz, zx in three; zz is minus the sum of xx and yy.
   */
  template <int dim>
  inline constexpr unsigned int n_deviator = dim == 2 ? 3 : 5;

  /** The largest number of history variables that a law may ask for. */
  inline constexpr unsigned int max_history = 12;

  /**
   * The domain over which the functions of a point are averaged
   * (domain_shape.h).
   */
  enum class DomainForm
  {
    none,           // the point itself
    box,            // fixed size (uGIMP)
    stretched_box,  // follows the stretch along the axes (cpGIMP)
    parallelepiped, // convected by F (CPDI)
    hexahedron      // with convected corners (CPDI2)
  };



  /** Products of different natural coordinates: xy; yz, zx, xy and xyz. */
  inline constexpr unsigned int
  n_twists(const unsigned int dim)
  {
    return (1u << dim) - dim - 1;
  }



  /**
   * Number of doubles per point for its domain: half edges along the axes of a
   * fixed box, otherwise the components of all half edge vectors, and of the
   * twists of a hexahedron (or quadrilateral).
   */
  inline constexpr unsigned int
  n_domain_components(const DomainForm form, const unsigned int dim)
  {
    return form == DomainForm::none       ? 0 :
           form == DomainForm::box        ? dim :
           form == DomainForm::hexahedron ? dim * (dim + n_twists(dim)) :
                                            dim * dim;
  }



  /**
   * The points of one body as the sweeps see them: one array per quantity,
   * sorted by cells except for points that have changed their cell since the
   * last sort. Arrays that the body does not need are null. Each array can be
   * read and written one pack beyond the last point.
   */
  template <int dim>
  struct PointView
  {
    std::size_t               size = 0;
    std::array<double *, dim> position{}; // m
    // Where shape functions are evaluated, m: the position, or with the initial
    // frame the reference position.
    std::array<double *, dim>             place{};
    std::array<double *, dim>             velocity{};         // m/s
    double                               *mass     = nullptr; // kg
    double                               *pressure = nullptr; // J p, Pa
    std::array<double *, n_deviator<dim>> deviator{};         // of J sigma, Pa
    std::array<double *, max_history>     history{}; // as the law defines them
    std::array<double *, dim * dim>       affine{};  // APIC, row-major, 1/s
    std::array<double *, dim> acceleration{};        // generalised-alpha, m/s^2
    // Half edges of the domain (domain_shape.h), m: component d of edge k at d
    // * dim + k, of fixed boxes those with d = k only; then the twists of a
    // hexahedron, component d of twist t at dim * (dim + t) + d
    DomainForm domain_form = DomainForm::none;
    std::array<double *, n_domain_components(DomainForm::hexahedron, dim)>
      domain{};
    // F, row-major, in the initial frame; else null
    std::array<double *, dim * dim> deformation{};
    // The volumetric variable of the law (J or the pressure): one of the arrays
    // above.
    double        *volumetric = nullptr;
    std::uint32_t *cell       = nullptr; // that contains the place
    double        *crossings  = nullptr; // cells entered since the start
    // For contact, at surface points: the distance from the point to the
    // surface in the undeformed state, m; 0 for other points (see reach_of())
    double *reach = nullptr;
    // For surface points of plastic bodies: b = F F^T since the start in the
    // order of dealii::SymmetricTensor; null if the law provides the stretch
    std::array<double *, dim *(dim + 1) / 2> stretch{};
    // Initial edges of the box that the point represents, along the axes, m
    std::array<double *, dim> edge{};

    /** Whether shape functions are evaluated at reference positions. */
    bool
    in_initial_frame() const
    {
      return deformation[0] != nullptr;
    }

    bool
    keeps_stretch() const
    {
      return stretch[0] != nullptr;
    }

    /** Whether functions are averaged over domains of the points. */
    bool
    has_domains() const
    {
      return domain_form != DomainForm::none;
    }

    /** Whether these are boxes along the axes (GIMP). */
    bool
    has_boxes() const
    {
      return domain_form == DomainForm::box ||
             domain_form == DomainForm::stretched_box;
    }
  };


  /** Natural coordinates of the place of a point in a cell. */
  template <int dim>
  inline std::array<double, dim>
  natural_place(const PointView<dim>    &points,
                const CellGeometry<dim> &cell,
                const std::size_t        p)
  {
    std::array<double, dim> xi;
    for (int d = 0; d < dim; ++d)
      xi[d] = (points.place[d][p] - cell.origin[d]) * cell.inverse_edge[d];
    return xi;
  }
} // namespace limber

#endif
