// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_loads_h
#define limber_time_loads_h

#include <limber/state/material_body.h>

#include <map>
#include <unordered_map>
#include <vector>

namespace limber
{
  /**
   * Body force formulas and loads on the initial faces of box bodies. Their
   * forces are kept apart from the internal ones so that their work is known;
   * a scene without such loads has none of this.
   *
   * A face load lives on the layer of points next to the face: each bears the
   * traction at its place on its share of the initial area, along the initial
   * normal, whatever the deformation (a dead load).
   */
  template <int dim>
  class ExternalLoads
  {
  public:
    ExternalLoads(const Problem<dim>                              &problem,
                  const BackgroundGrid<dim>                       &grid,
                  std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

    bool
    any() const;

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Add the forces at @p time to those of active nodes; collective. */
    void
    add(NodalFields<dim> &nodes, double time);

    /** Area by id of point for each face load, m^(dim-1), for checkpoints. */
    using Areas = std::vector<std::map<std::uint64_t, double>>;
    Areas
    areas() const;
    void
    restore(const Areas &areas);

    /** The sum of the forces on a node since the last add(), N. */
    dealii::Tensor<1, dim>
    on_node(std::uint32_t node) const;

  private:
    struct FaceLayer
    {
      const FaceLoad<dim> *load;
      MaterialBody<dim>   *body;
      // Area by id of point, m^(dim-1); the same on all ranks.
      std::unordered_map<std::uint64_t, double>   area;
      std::vector<std::pair<std::size_t, double>> here; // point, area
      unsigned long order = 0; // of the points, when `here` was made
    };

    FaceLayer
    find_layer(const FaceLoad<dim> &load, MaterialBody<dim> &body) const;
    void
    add_body_force(const MaterialBody<dim> &body, double time);
    void
    add_face_load(FaceLayer &layer, double time);
    void
    give(const PointView<dim>         &points,
         std::size_t                   p,
         const dealii::Tensor<1, dim> &force);

    const Problem<dim>                              &problem;
    const BackgroundGrid<dim>                       &grid;
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies;
    std::vector<FaceLayer>                           layers;
    LazyArray<double>                                forces; // dim per node, N
    RecordExchange                                   exchange{dim};
  };
} // namespace limber

#endif
