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

  /** Over what the functions of a point are averaged (convected.h). */
  enum class DomainForm
  {
    none,           // the point alone
    box,            // of fixed size
    stretched_box,  // that follows the stretch
    parallelepiped, // that is carried along
    hexahedron      // or quadrilateral, whose corners are carried along
  };



  /** Products of different natural coordinates: xy; yz, zx, xy and xyz. */
  inline constexpr unsigned int
  n_twists(const unsigned int dim)
  {
    return (1u << dim) - dim - 1;
  }



  /**
   * Numbers that a domain takes at each point: half edges along the axes of a
   * fixed box, else components of half edges that are carried along, and of the
   * twists of a hexahedron.
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
   * What the sweeps see of the points of one body: one array per quantity, in
   * the order of cells as far as the points have not moved on since the last
   * sort. Arrays that the body does not need are null. Every array can be
   * read and written one pack beyond the last point.
   */
  template <int dim>
  struct PointView
  {
    std::size_t               size = 0;
    std::array<double *, dim> position{}; // m
    // Where the functions of the grid are taken, m: the position, or where the
    // point was at the start if its body is computed in that frame.
    std::array<double *, dim>             place{};
    std::array<double *, dim>             velocity{};         // m/s
    double                               *mass     = nullptr; // kg
    double                               *pressure = nullptr; // J p, Pa
    std::array<double *, n_deviator<dim>> deviator{};         // of J sigma, Pa
    std::array<double *, max_history>     history{}; // meaning: the law's
    std::array<double *, dim * dim>       affine{};  // APIC, row-major, 1/s
    std::array<double *, dim> acceleration{}; // of generalised-alpha, m/s^2
    // Half edges of the domain (convected.h), m: component d of edge k at
    // d * dim + k, of fixed boxes those with d = k alone; behind them the
    // twists of a hexahedron, component d of twist t at dim * (dim + t) + d
    DomainForm domain_form = DomainForm::none;
    std::array<double *, n_domain_components(DomainForm::hexahedron, dim)>
      domain{};
    // F, row-major, in the frame of the initial configuration; else null
    std::array<double *, dim * dim> deformation{};
    // The variable that carries the volumetric history (of the law's choice):
    // one of the arrays above.
    double        *volumetric = nullptr;
    std::uint32_t *cell       = nullptr; // of the place
    double        *crossings  = nullptr; // cells entered since the start
    // Of a point at the surface of a body that may touch something: its
    // distance from that before it was stretched, m; 0 of others (see
    // reach_of())
    double *reach = nullptr;
    // Of such points of a body that flows: b of the deformation since the start
    // in the order of dealii::SymmetricTensor; null where the law knows it
    std::array<double *, dim *(dim + 1) / 2> stretch{};
    // Of what the point stands for, as it was at the start, along the axes, m
    std::array<double *, dim> edge{};

    /** Whether the functions of the grid are those of the initial places. */
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
