// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/interpolation/linear.h>
#include <limber/time/loads.h>

namespace limber
{
  template <int dim>
  ExternalLoads<dim>::ExternalLoads(
    const Problem<dim>                              &problem,
    const BackgroundGrid<dim>                       &grid,
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
    : problem(problem)
    , grid(grid)
    , bodies(bodies)
  {
    for (const FaceLoad<dim> &load : problem.loads.faces)
      for (auto &body : bodies)
        if (body->description.name == load.body)
          layers.push_back(find_layer(load, *body));
    reinit();
  }



  template <int dim>
  bool
  ExternalLoads<dim>::any() const
  {
    return problem.loads.body_force || !layers.empty();
  }



  template <int dim>
  void
  ExternalLoads<dim>::reinit()
  {
    if (any())
      forces.reinit(grid.n_nodes() * dim);
  }



  template <int dim>
  typename ExternalLoads<dim>::Areas
  ExternalLoads<dim>::areas() const
  {
    Areas result;
    for (const FaceLayer &layer : layers)
      result.emplace_back(layer.area.begin(), layer.area.end());
    return result;
  }



  template <int dim>
  void
  ExternalLoads<dim>::restore(const Areas &areas)
  {
    AssertDimension(areas.size(), layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i)
      layers[i].area = {areas[i].begin(), areas[i].end()};
  }



  template <int dim>
  typename ExternalLoads<dim>::FaceLayer
  ExternalLoads<dim>::find_layer(const FaceLoad<dim> &load,
                                 MaterialBody<dim>   &body) const
  {
    FaceLayer          layer{&load, &body, {}, {}, 0};
    const unsigned int normal = load.face / 2;
    const auto         box    = body.description.shape->bounding_box();
    const double       face =
      load.face % 2 == 0 ? box.first[normal] : box.second[normal];

    // Areas are those of a regular lattice.
    const std::string where = "Face load " + load.name;
    if (body.description.placement != Placement::regular)
      throw InputError("'" + where + "' acts on body '" + load.body +
                       "', whose points are not placed regularly, so that "
                       "their shares of the face are unknown. Set 'Placement "
                       "= regular' in section 'Body " +
                       load.body + "'.");
    std::vector<std::pair<std::uint64_t, double>> own;
    const PointView<dim>                          points = body.points.view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const auto &cell = grid.geometry[points.cell[p]];
        double      area = 1, spacing = 0;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double part = 1 / (cell.inverse_edge[d] *
                                     body.description.points_per_cell_edge[d]);
            if (d == normal)
              spacing = part;
            else
              area *= part;
          }
        if (std::abs(points.position[normal][p] - face) < spacing)
          own.emplace_back(body.points.id(p), area);
      }
    for (const auto &part :
         dealii::Utilities::MPI::all_gather(grid.communicator, own))
      layer.area.insert(part.begin(), part.end());

    if (layer.area.empty())
      throw InputError("'" + where + "' finds no point of body '" + load.body +
                       "' within one spacing of its face. Usually the box is "
                       "thinner than a spacing; enlarge it, or set more "
                       "'Points per cell edge', for instance 4.");

    // The layer stands for the whole face also where the box does not end on
    // the edges of cells.
    double total = 0, exact = 1;
    for (const auto &[id, area] : layer.area)
      total += area;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != normal)
        exact *= box.second[d] - box.first[d];
    for (auto &[id, area] : layer.area)
      area *= exact / total;
    return layer;
  }



  template <int dim>
  void
  ExternalLoads<dim>::give(const PointView<dim>         &points,
                           const std::size_t             p,
                           const dealii::Tensor<1, dim> &force)
  {
    using Kernel        = Linear<dim>;
    const auto &cell    = grid.geometry[points.cell[p]];
    auto        weights = broadcast<typename Kernel::Nodes>(1.);
    for (int d = 0; d < dim; ++d)
      weights *= Kernel::weights(d,
                                 (points.position[d][p] - cell.origin[d]) *
                                   cell.inverse_edge[d]);
    for (int i = 0; i < Kernel::n_nodes; ++i)
      for (int d = 0; d < dim; ++d)
        forces[cell.node[i] / NodeLayout<dim>::stride * dim + d] +=
          weights[i] * force[d];
  }



  template <int dim>
  void
  ExternalLoads<dim>::add_body_force(const MaterialBody<dim> &body,
                                     const double             time)
  {
    const PointView<dim> points = body.points.view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        dealii::Point<dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = points.position[d][p];
        give(points,
             p,
             points.mass[p] * problem.loads.body_force->vector(place, time));
      }
  }



  template <int dim>
  void
  ExternalLoads<dim>::add_face_load(FaceLayer &layer, const double time)
  {
    const MaterialPoints<dim> &carrier = layer.body->points;
    if (layer.order != carrier.order())
      {
        layer.here.clear();
        for (std::size_t p = 0; p < carrier.size(); ++p)
          {
            const auto found = layer.area.find(carrier.id(p));
            if (found != layer.area.end())
              layer.here.emplace_back(p, found->second);
          }
        layer.order = carrier.order();
      }

    const FaceLoad<dim> &load   = *layer.load;
    const PointView<dim> points = carrier.view();
    for (const auto &[p, area] : layer.here)
      {
        dealii::Point<dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = points.position[d][p];
        dealii::Tensor<1, dim> traction;
        if (load.is_pressure)
          traction[load.face / 2] =
            load.formula.value(place, time) * (load.face % 2 == 0 ? 1 : -1);
        else
          traction = load.formula.vector(place, time);
        give(points, p, area * traction);
      }
  }



  template <int dim>
  void
  ExternalLoads<dim>::add(NodalFields<dim> &nodes, const double time)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        forces[node * dim + d] = 0;
    if (problem.loads.body_force)
      for (const auto &body : bodies)
        add_body_force(*body, time);
    for (FaceLayer &layer : layers)
      add_face_load(layer, time);

    // As for the nodes themselves: hanging nodes give to their masters.
    for (const HangingNode &hanging : grid.hanging_nodes)
      for (int d = 0; d < dim; ++d)
        {
          double &from = forces[hanging.node * dim + d];
          for (const auto &[master, weight] : hanging.masters)
            forces[master * dim + d] += weight * from;
          from = 0;
        }
    exchange.start(nodes.node_plan(), forces.data(), 0, dim);
    exchange.finish(forces.data());

    for (const std::uint32_t node : nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        nodes.record(node)[NodeLayout<dim>::force + d] +=
          forces[node * dim + d];
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ExternalLoads<dim>::on_node(const std::uint32_t node) const
  {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = forces[node * dim + d];
    return result;
  }



  template class ExternalLoads<2>;
  template class ExternalLoads<3>;
} // namespace limber
