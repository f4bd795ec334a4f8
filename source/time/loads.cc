// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/point_support.h>
#include <limber/time/contact.h>
#include <limber/time/loads.h>
#include <limber/time/point_deformation.h>
#include <limber/time/surface_closure.h>

namespace limber
{
  namespace
  {
    template <int dim>
    dealii::Point<dim>
    position(const PointView<dim> &points, const std::size_t p)
    {
      dealii::Point<dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = points.position[d][p];
      return result;
    }



  } // namespace



  template <int dim>
  ExternalLoads<dim>::ExternalLoads(
    const Problem<dim>                              &problem,
    const BackgroundGrid<dim>                       &grid,
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
    CutCells<dim> *const                             cut_cells)
    : problem(problem)
    , grid(grid)
    , bodies(bodies)
    , hydrostatic(problem, grid, bodies, cut_cells)
    , forces(n_nodal_fields(problem))
  {
    for (const FaceLoad<dim> &load : problem.loads.faces)
      for (auto &body : bodies)
        if (body->description.name == load.body)
          faces.emplace_back(load, *body, grid);
    reinit();
  }



  template <int dim>
  bool
  ExternalLoads<dim>::any() const
  {
    return problem.loads.body_force || !faces.empty() || hydrostatic.any();
  }



  template <int dim>
  void
  ExternalLoads<dim>::reinit()
  {
    if (any())
      for (LazyArray<double> &of_field : forces)
        of_field.reinit(grid.nodes().n() * dim);
    if (hydrostatic.any())
      hydrostatic.reinit();
    exchange_pieces();
  }



  template <int dim>
  void
  ExternalLoads<dim>::exchange_pieces()
  {
    for (LoadedFace<dim> &face : faces)
      face.exchange();
  }



  template <int dim>
  typename ExternalLoads<dim>::Pieces
  ExternalLoads<dim>::pieces() const
  {
    Pieces result;
    for (const LoadedFace<dim> &face : faces)
      result.push_back(face.all_pieces());
    return result;
  }



  template <int dim>
  void
  ExternalLoads<dim>::restore(const Pieces &pieces)
  {
    AssertDimension(pieces.size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
      faces[i].restore(pieces[i]);
  }



  template <int dim>
  typename ExternalLoads<dim>::Pieces
  ExternalLoads<dim>::detached_pieces() const
  {
    Pieces result;
    for (const LoadedFace<dim> &face : faces)
      result.push_back(face.detached_pieces());
    return result;
  }



  template <int dim>
  void
  ExternalLoads<dim>::attach(const Pieces &detached)
  {
    AssertDimension(detached.size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
      faces[i].attach(detached[i]);
  }



  template <int dim>
  void
  ExternalLoads<dim>::add_body_force(const MaterialBody<dim> &body,
                                     const double             time)
  {
    const PointView<dim> points   = body.points.view();
    LazyArray<double>   &of_nodes = forces[body.description.nodal_field];
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const dealii::Point<dim>     place = problem.loads.body_force_at_start ?
                                               body.points.reference_position(p) :
                                               position(points, p);
        const dealii::Tensor<1, dim> force =
          points.mass[p] * problem.loads.body_force->vector(place, time);
        const Support<dim> at = support_of_point<dim>(grid.view(), points, p);
        for (int i = 0; i < at.n; ++i)
          for (int d = 0; d < dim; ++d)
            of_nodes[at.node[i] * dim + d] += at.value[i] * force[d];
      }
  }



  // A uniform b needs no sweep over points: sum_p m_p N_i b = m_i b.
  template <int dim>
  void
  ExternalLoads<dim>::add_uniform_force(const NodalFields<dim> &nodes,
                                        const unsigned int      field,
                                        const double            time)
  {
    const dealii::Tensor<1, dim> force =
      problem.loads.body_force->vector({}, time);
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double mass = nodes.record(field, node)[NodeLayout<dim>::mass];
        for (int d = 0; d < dim; ++d)
          forces[field][node * dim + d] += mass * force[d];
      }
  }



  template <int dim>
  void
  ExternalLoads<dim>::add_face_load(LoadedFace<dim> &face, const double time)
  {
    const FaceLoad<dim> &load     = face.load;
    const PointView<dim> points   = face.body.points.view();
    LazyArray<double>   &of_nodes = forces[face.body.description.nodal_field];
    SurfaceClosure<dim>  surface(face.centre_at_start());
    const bool           is_closed = face.is_closed();
    if (is_closed)
      {
        for (const auto &[p, piece] : face.here())
          surface.add(position(points, p) + piece->arm, piece->area_vector());
        surface.finish(grid.communicator);
      }
    for (const auto &[p, piece] : face.here())
      {
        const dealii::Point<dim> place = position(points, p) + piece->arm;
        dealii::Tensor<1, dim>   area  = piece->area_vector();
        if (is_closed)
          area += surface.change(place, area);
        const dealii::Tensor<1, dim> force =
          load.is_pressure ?
            -load.formula.value(place, time) * area :
            piece->area * load.formula.vector(piece->reference, time);
        const Support<dim> at =
          support_of_piece(grid.view(), points, p, *piece);
        for (int i = 0; i < at.n; ++i)
          for (int d = 0; d < dim; ++d)
            of_nodes[at.node[i] * dim + d] += at.value[i] * force[d];
      }
  }



  template <int dim>
  void
  ExternalLoads<dim>::deform(NodalFields<dim>                   &nodes,
                             const StressSweep                  &what,
                             const std::vector<DualDomain<dim>> &mean_gradients)
  {
    for (LoadedFace<dim> &face : faces)
      {
        const PointView<dim> points = face.body.points.view();
        for (const auto &[p, piece] : face.here())
          {
            const dealii::Tensor<2, dim> change =
              change_of_deformation(nodes,
                                    points,
                                    face.body.description.nodal_field,
                                    p,
                                    what,
                                    mean_gradients);
            piece->arm += change * piece->arm;
            for (auto &edge : piece->edges)
              edge += change * edge;
          }
      }
  }



  template <int dim>
  void
  ExternalLoads<dim>::look_at_cells(const NodalFields<dim> &nodes)
  {
    if (hydrostatic.any())
      hydrostatic.find(nodes);
  }



  template <int dim>
  void
  ExternalLoads<dim>::add(NodalFields<dim> &nodes,
                          const double      time,
                          const bool        followers)
  {
    for (LazyArray<double> &of_nodes : forces)
      for (const std::uint32_t node : nodes.active_nodes())
        for (int d = 0; d < dim; ++d)
          of_nodes[node * dim + d] = 0;
    const auto &body_force = problem.loads.body_force;
    const bool  varies     = problem.loads.body_force_varies();
    if (varies && (followers || problem.loads.body_force_at_start))
      for (const auto &body : bodies)
        add_body_force(*body, time);
    for (LoadedFace<dim> &face : faces)
      if (followers || !face.load.is_pressure)
        add_face_load(face, time);

    for (unsigned int field = 0; field < forces.size(); ++field)
      {
        if (varies || !faces.empty())
          complete(nodes, forces[field]);
        if (body_force && !varies)
          add_uniform_force(nodes, field, time);
        if (hydrostatic.any())
          hydrostatic.add(nodes, field, forces[field]);
        for (const std::uint32_t node : nodes.active_nodes())
          for (int d = 0; d < dim; ++d)
            nodes.record(field, node)[NodeLayout<dim>::force + d] +=
              forces[field][node * dim + d];
      }
  }



  // Add hanging nodes to their masters and sum over ranks, as nodal records.
  template <int dim>
  void
  ExternalLoads<dim>::complete(const NodalFields<dim> &nodes,
                               LazyArray<double>      &of_nodes)
  {
    for (const HangingNode &hanging : grid.nodes().hanging)
      for (int d = 0; d < dim; ++d)
        {
          double &from = of_nodes[hanging.node * dim + d];
          for (const auto &[master, weight] : hanging.masters)
            of_nodes[master * dim + d] += weight * from;
          from = 0;
        }
    exchange.start(nodes.node_plan(), of_nodes.data(), 0, dim);
    exchange.finish(of_nodes.data());
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ExternalLoads<dim>::on_node(const unsigned int  field,
                              const std::uint32_t node) const
  {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = forces[field][node * dim + d];
    return result;
  }



  template class ExternalLoads<2>;
  template class ExternalLoads<3>;
} // namespace limber
