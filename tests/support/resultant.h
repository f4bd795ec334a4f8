// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_resultant_h
#define limber_tests_support_resultant_h

#include <support/scene_run.h>

#include <map>

namespace limber
{
  template <int dim>
  dealii::Point<dim>
  place_of_node(const CellGeometry<dim> &cell, const unsigned int i)
  {
    dealii::Point<dim> place;
    for (int d = 0; d < dim; ++d)
      place[d] = cell.origin[d] + (i >> d & 1 ? 1 / cell.inverse_edge[d] : 0);
    return place;
  }



  /** Force, and moment about the origin, of what the nodes have got. */
  template <int dim>
  struct Resultant
  {
    dealii::Tensor<1, dim> force;
    dealii::Tensor<2, dim> moment; // sum of x_i (x) f_i

    Resultant() = default;

    Resultant(SceneRun<dim> &run, ExternalLoads<dim> &loads)
    {
      loads.add(run.nodes, /*time=*/0);
      std::map<std::uint32_t, dealii::Point<dim>> places;
      for (const CellGeometry<dim> &cell : run.grid.geometry)
        for (unsigned int i = 0; i < cell.node.size(); ++i)
          places[cell.node[i] / NodeLayout<dim>::stride] =
            place_of_node(cell, i);
      for (const std::uint32_t node : run.nodes.active_nodes())
        {
          force += loads.on_node(0, node);
          moment += outer_product(places.at(node), loads.on_node(0, node));
        }
    }

    explicit Resultant(SceneRun<dim> &run)
    {
      ExternalLoads<dim> loads(run.problem, run.grid, run.bodies);
      *this = Resultant(run, loads);
    }
  };



  /** Give all nodes the velocity L x, 1/s times m, and re-mapped twice that. */
  template <int dim>
  void
  set_nodal_velocity(SceneRun<dim> &run, const dealii::Tensor<2, dim> &gradient)
  {
    using Layout = NodeLayout<dim>;
    for (const unsigned int slot : {Layout::velocity, Layout::remapped})
      for (const CellGeometry<dim> &cell : run.grid.geometry)
        for (unsigned int i = 0; i < cell.node.size(); ++i)
          {
            const auto v = gradient * place_of_node(cell, i);
            for (int d = 0; d < dim; ++d)
              run.nodes.view().nodes[cell.node[i] + slot + d] =
                (slot == Layout::remapped ? 2 : 1) * v[d];
          }
  }
} // namespace limber

#endif
