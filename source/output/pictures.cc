// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/support.h>
#include <limber/materials/law_list.h>
#include <limber/output/pictures.h>
#include <limber/output/point_stress.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace limber
{
  namespace
  {
    /** A body as the fields of its points need it. */
    template <int dim>
    struct SeenBody
    {
      const MaterialBody<dim> &body;
      const PointView<dim>     points;
      const PointStress<dim>  &stress;
      const unsigned int       number;
      // By named variable that is drawn: an array of its values, or null
      const std::vector<const double *> variables;
    };



    template <int dim>
    dealii::Point<dim>
    place_of(const PointView<dim> &points, const std::size_t p)
    {
      dealii::Point<dim> place;
      for (int d = 0; d < dim; ++d)
        place[d] = points.position[d][p];
      return place;
    }



    /** A field that a scene may name, and how it is filled for a point. */
    template <int dim>
    struct PointField
    {
      const char  *name, *unit;
      unsigned int n_components;
      void (*fill)(const SeenBody<dim> &, const std::size_t p, double *values);
    };



    template <int dim>
    void
    fill_displacement(const SeenBody<dim> &seen,
                      const std::size_t    p,
                      double *const        values)
    {
      const dealii::Tensor<1, dim> displacement =
        place_of(seen.points, p) - seen.body.points.reference_position(p);
      for (int d = 0; d < dim; ++d)
        values[d] = displacement[d];
    }



    template <int dim>
    void
    fill_velocity(const SeenBody<dim> &seen,
                  const std::size_t    p,
                  double *const        values)
    {
      for (int d = 0; d < dim; ++d)
        values[d] = seen.points.velocity[d][p];
    }



    template <int dim>
    void
    fill_pressure(const SeenBody<dim> &seen,
                  const std::size_t    p,
                  double *const        values)
    {
      *values = seen.stress.pressure(p);
    }



    template <int dim>
    void
    fill_point_pressure(const SeenBody<dim> &seen,
                        const std::size_t    p,
                        double *const        values)
    {
      *values = seen.stress.point_pressure(p);
    }



    void
    fill_matrix(const dealii::SymmetricTensor<2, 3> &deviator,
                const double                         pressure,
                double *const                        values)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          values[3 * i + j] = deviator[i][j] - (i == j ? pressure : 0);
    }



    template <int dim>
    void
    fill_stress(const SeenBody<dim> &seen,
                const std::size_t    p,
                double *const        values)
    {
      fill_matrix(seen.stress.deviator(p), seen.stress.pressure(p), values);
    }



    template <int dim>
    void
    fill_point_stress(const SeenBody<dim> &seen,
                      const std::size_t    p,
                      double *const        values)
    {
      fill_matrix(seen.stress.point_deviator(p),
                  seen.stress.point_pressure(p),
                  values);
    }



    /** Equivalent stress by von Mises. */
    template <int dim>
    void
    fill_equivalent_stress(const SeenBody<dim> &seen,
                           const std::size_t    p,
                           double *const        values)
    {
      *values = std::sqrt(1.5) * seen.stress.deviator(p).norm();
    }



    template <int dim>
    void
    fill_volume_ratio(const SeenBody<dim> &seen,
                      const std::size_t    p,
                      double *const        values)
    {
      *values = seen.stress.volume_ratio(p);
    }



    template <int dim>
    void
    fill_mass(const SeenBody<dim> &seen,
              const std::size_t    p,
              double *const        values)
    {
      *values = seen.points.mass[p];
    }



    template <int dim>
    void
    fill_body(const SeenBody<dim> &seen,
              const std::size_t,
              double *const values)
    {
      *values = seen.number;
    }



    /** The words of 'Output/Fields' and what they mean. */
    template <int dim>
    const std::vector<PointField<dim>> &
    point_fields()
    {
      static const std::vector<PointField<dim>> fields = {
        {"displacement", "m", dim, fill_displacement<dim>},
        {"velocity", "m/s", dim, fill_velocity<dim>},
        {"pressure", "Pa", 1, fill_pressure<dim>},
        {"stress", "Pa", 9, fill_stress<dim>},
        {"equivalent stress", "Pa", 1, fill_equivalent_stress<dim>},
        {"volume ratio", "", 1, fill_volume_ratio<dim>},
        {"mass", "kg", 1, fill_mass<dim>},
        {"point pressure", "Pa", 1, fill_point_pressure<dim>},
        {"point stress", "Pa", 9, fill_point_stress<dim>},
        {"body", "", 1, fill_body<dim>}};
      return fields;
    }



    /** 'none' chooses nothing. */
    template <int dim>
    std::vector<PointField<dim>>
    chosen_fields(const std::vector<std::string> &names)
    {
      std::vector<PointField<dim>> result;
      for (const std::string &name : names)
        {
          if (name == "none")
            continue;
          const auto field =
            std::find_if(point_fields<dim>().begin(),
                         point_fields<dim>().end(),
                         [&](const auto &known) { return known.name == name; });
          if (field != point_fields<dim>().end())
            result.push_back(*field);
        }
      return result;
    }



    /** The chosen fields that are named variables of laws. */
    std::vector<std::string>
    chosen_variables(const std::vector<std::string> &names)
    {
      const auto               known = names_of_variables();
      std::vector<std::string> result;
      for (const std::string &name : names)
        if (std::find(known.begin(), known.end(), name) != known.end())
          result.push_back(name);
      return result;
    }



    /** By name: where the body stores it; null where it does not. */
    template <int dim>
    std::vector<const double *>
    arrays_of(const MaterialBody<dim>        &body,
              const std::vector<std::string> &names)
    {
      std::vector<const double *> result(names.size(), nullptr);
      const auto                  own =
        variables_of(body.description.law, body.description.material);
      for (unsigned int i = 0; i < names.size(); ++i)
        for (unsigned int k = 0; k < own.size(); ++k)
          if (own[k].name == names[i])
            result[i] = body.variable(k);
      return result;
    }



    template <int dim>
    void
    add_body(const SeenBody<dim>                &seen,
             const std::vector<PointField<dim>> &fields,
             Picture<0, dim>                    &picture)
    {
      std::array<double, 9> values{};
      for (std::size_t p = 0; p < seen.points.size; ++p)
        {
          auto &patch       = picture.patches.emplace_back();
          patch.patch_index = picture.patches.size() - 1;
          patch.vertices[0] = place_of(seen.points, p);
          patch.data.reinit(picture.fields.names.size(), 1);
          unsigned int component = 0;
          for (const PointField<dim> &field : fields)
            {
              field.fill(seen, p, values.data());
              for (unsigned int k = 0; k < field.n_components; ++k)
                patch.data(component++, 0) = values[k];
            }
          for (const double *const array : seen.variables)
            patch.data(component++, 0) = array == nullptr ? 0 : array[p];
        }
    }
  } // namespace



  template <int dim>
  Picture<0, dim>
  draw_points(const State<dim> &state)
  {
    auto fields = chosen_fields<dim>(state.problem.output.fields);
    // The picture of a failed run may not have been planned for.
    for (const auto &body : state.bodies)
      if (!body->points.has_reference())
        fields.erase(std::remove_if(fields.begin(),
                                    fields.end(),
                                    [](const PointField<dim> &field) {
                                      return field.fill ==
                                             fill_displacement<dim>;
                                    }),
                     fields.end());
    Picture<0, dim> picture;
    for (const PointField<dim> &field : fields)
      picture.fields.add(field.name, field.unit, field.n_components);
    const auto variables = chosen_variables(state.problem.output.fields);
    for (const std::string &name : variables)
      picture.fields.add(name, "", 1);

    std::size_t n = 0;
    for (const auto &body : state.bodies)
      n += body->points.size();
    picture.patches.reserve(n);

    PointStress<dim> stress(state);
    for (unsigned int b = 0; b < state.bodies.size(); ++b)
      {
        const MaterialBody<dim> &body = *state.bodies[b];
        stress.compute(body);
        add_body<dim>(
          {body, body.points.view(), stress, b, arrays_of(body, variables)},
          fields,
          picture);
      }
    return picture;
  }



  namespace
  {
    /** A patch per owned cell with its corners; values still to come. */
    template <int dim>
    void
    add_cells(const BackgroundGrid<dim> &grid, Picture<dim, dim> &picture)
    {
      picture.patches.resize(grid.n_owned_cells());
      for (unsigned int c = 0; c < picture.patches.size(); ++c)
        {
          auto                    &patch = picture.patches[c];
          const CellGeometry<dim> &cell  = grid.geometry[c];
          patch.patch_index              = c;
          patch.n_subdivisions           = 1;
          patch.reference_cell = dealii::ReferenceCells::get_hypercube<dim>();
          patch.data.reinit(picture.fields.names.size(), 1 << dim);
          for (unsigned int i = 0; i < 1 << dim; ++i)
            for (int d = 0; d < dim; ++d)
              patch.vertices[i][d] =
                cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];
        }
    }



    template <int dim>
    bool
    is_projected(const MaterialBody<dim> &body)
    {
      return body.stress->treatment().kind != Treatment::none;
    }



    /** Mass, kg, and velocity, m/s, at a node over all velocity fields (of
     * bodies in contact). */
    template <int dim>
    std::pair<double, std::array<double, dim>>
    motion_of(const State<dim> &state, const std::uint32_t node)
    {
      using Layout                   = NodeLayout<dim>;
      const double            mass   = state.nodes.mass(node);
      std::array<double, dim> result = {};
      for (unsigned int f = 0; mass > 0 && f < state.nodes.n_fields(); ++f)
        {
          const double *const record = state.nodes.record(f, node);
          for (int d = 0; d < dim; ++d)
            result[d] +=
              record[Layout::mass] / mass * record[Layout::velocity + d];
        }
      return {mass, result};
    }



    /** Mass and velocity, the first 1 + dim components, at corners of cells. */
    template <int dim>
    void
    add_nodal_values(const State<dim> &state, Picture<dim, dim> &picture)
    {
      const GridView<dim> grid = state.grid.view();
      for (unsigned int c = 0; c < picture.patches.size(); ++c)
        for (unsigned int i = 0; i < 1 << dim; ++i)
          {
            const CellGeometry<dim> &cell = grid.cells[c];
            std::array<double, dim>  corner;
            for (int d = 0; d < dim; ++d)
              corner[d] = cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];
            const Support<dim> at   = support_at<dim, false>(grid, c, corner);
            auto              &data = picture.patches[c].data;
            for (int k = 0; k < at.n; ++k)
              {
                const auto [mass, velocity] = motion_of(state, at.node[k]);
                data(0, i) += at.value[k] * mass;
                for (int d = 0; d < dim; ++d)
                  data(1 + d, i) += at.value[k] * velocity[d];
              }
          }
    }
  } // namespace



  template <int dim>
  Picture<dim, dim>
  draw_grid(const State<dim> &state)
  {
    Picture<dim, dim> picture;
    picture.fields.add("mass", "kg", 1);
    picture.fields.add("velocity", "m/s", dim);
    if (state.grid.has_levels())
      picture.fields.add("level", "", 1);
    unsigned int component = picture.fields.names.size();
    for (const auto &body : state.bodies)
      if (is_projected(*body))
        {
          picture.fields.add("pressure of " + body->description.name, "Pa", 1);
          picture.fields.add("volume ratio of " + body->description.name,
                             "",
                             1);
        }
    add_cells(state.grid, picture);
    add_nodal_values(state, picture);
    if (state.grid.has_levels())
      for (unsigned int c = 0; c < picture.patches.size(); ++c)
        for (unsigned int i = 0; i < 1 << dim; ++i)
          picture.patches[c].data(1 + dim, i) = state.grid.level_of(c);

    PointStress<dim> stress(state);
    for (const auto &body : state.bodies)
      if (is_projected(*body))
        {
          stress.compute(*body);
          for (unsigned int c = 0; c < picture.patches.size(); ++c)
            {
              const CellPressure mean = stress.in_cell(c);
              for (unsigned int i = 0; i < 1 << dim; ++i)
                {
                  auto &data = picture.patches[c].data;
                  data(component, i) =
                    stress.is_nodal() ?
                      stress.at_node(state.grid.geometry[c].node[i] /
                                     NodeLayout<dim>::stride) :
                      mean.mean_pressure();
                  data(component + 1, i) = mean.mean_volume_ratio();
                }
            }
          component += 2;
        }
    return picture;
  }



  template Picture<0, 2>
  draw_points(const State<2> &);
  template Picture<0, 3>
  draw_points(const State<3> &);
  template Picture<2, 2>
  draw_grid(const State<2> &);
  template Picture<3, 3>
  draw_grid(const State<3> &);
} // namespace limber
