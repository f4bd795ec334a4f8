// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>

#include <deal.II/numerics/rtree.h>

#include <limber/base/exceptions.h>
#include <limber/fem/solid_samples.h>
#include <limber/problem/read_problem.h>
#include <limber/simulation/reference_fields.h>
#include <limber/study/field_source.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

    template <int dim>
    PointArrays<dim>
    unknown_fields(const double                           time,
                   const std::vector<dealii::Point<dim>> &places)
    {
      PointArrays<dim> result;
      result.time  = time;
      result.place = places;
      dealii::Tensor<1, dim> unknown;
      std::array<double, 6>  unknown_stress;
      for (unsigned int d = 0; d < dim; ++d)
        unknown[d] = not_known;
      unknown_stress.fill(not_known);
      result.displacement.assign(places.size(), unknown);
      result.velocity.assign(places.size(), unknown);
      result.pressure.assign(places.size(), not_known);
      result.stress.assign(places.size(), unknown_stress);
      return result;
    }



    std::vector<double>
    times_of(const std::vector<std::pair<double, std::string>> &files)
    {
      std::vector<double> result;
      for (const auto &file : files)
        result.push_back(file.first);
      return result;
    }



    const std::string &
    file_at(const std::vector<std::pair<double, std::string>> &files,
            const double                                       time)
    {
      return std::min_element(files.begin(),
                              files.end(),
                              [&](const auto &a, const auto &b) {
                                return std::abs(a.first - time) <
                                       std::abs(b.first - time);
                              })
        ->second;
    }



    /** Fields from files at some times. */
    template <int dim>
    class FileSource : public FieldSource<dim>
    {
    public:
      FileSource(const std::string &folder,
                 const std::string &series,
                 const std::string &kind)
        : folder(folder)
        , files(find_point_arrays(folder, series))
        , kind(kind)
      {}

      std::string
      description() const override
      {
        return kind + " in " + folder;
      }

      std::vector<double>
      times() const override
      {
        return times_of(files);
      }

    protected:
      const std::string                                 folder;
      const std::vector<std::pair<double, std::string>> files;

    private:
      const std::string kind;
    };



    template <int dim>
    class ReferenceSource : public FileSource<dim>
    {
    public:
      explicit ReferenceSource(const std::string &folder)
        : FileSource<dim>(folder, "nodes", "finite elements")
        , problem(read_problem<dim>(SceneFile(folder + "/parameters.prm")))
        , model(problem, MPI_COMM_SELF)
      {}

      PointArrays<dim>
      evaluate(const double                           time,
               const std::vector<dealii::Point<dim>> &places) override
      {
        NodalVector u = model.make_vector(), v = model.make_vector();
        const auto  nodal =
          read_reference_fields(file_at(this->files, time), model, u, v);
        const auto samples = sample_at(model, places, u, v);
        // with plasticity stresses are stored at nodes only
        const auto stresses = model.element->n_memory() > 0 ?
                                interpolate_at(model, places, nodal) :
                                std::vector<NodalStress>();
        auto       result   = unknown_fields(time, places);
        for (std::size_t p = 0; p < places.size(); ++p)
          if (samples[p].inside)
            {
              const MaterialState &state = samples[p].material;
              const auto          &s     = state.stress;
              result.displacement[p]     = samples[p].displacement;
              result.velocity[p]         = samples[p].velocity;
              result.pressure[p]         = state.pressure;
              result.stress[p]           = {
                          {s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[2][0]}};
              if (stresses.empty())
                continue;
              result.pressure[p] = stresses[p][0];
              std::copy_n(stresses[p].begin() + 1, 6, result.stress[p].begin());
            }
        return result;
      }

      // At the nodes alone errors may be far smaller than between them.
      PointArrays<dim>
      at_own_places(const double time) override
      {
        std::vector<dealii::Point<dim>> places;
        std::vector<double>             masses;
        auto values = model.shape_values(model.quadrature);
        for (const auto &cell : model.dof_handler.active_cell_iterators())
          {
            values.reinit(cell);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                places.push_back(values.quadrature_point(q));
                masses.push_back(model.element->density * values.JxW(q));
              }
          }
        auto result = evaluate(time, places);
        result.mass = std::move(masses);
        return result;
      }

    private:
      const Problem<dim>    problem;
      const SolidModel<dim> model;
    };



    template <int dim>
    class RunSource : public FileSource<dim>
    {
    public:
      explicit RunSource(const std::string &folder)
        : FileSource<dim>(folder, "points", "material points")
      {}

      PointArrays<dim>
      evaluate(const double                           time,
               const std::vector<dealii::Point<dim>> &places) override
      {
        const auto arrays = read_point_arrays<dim>(file_at(this->files, time));
        std::vector<std::pair<dealii::Point<dim>, std::size_t>> entries;
        for (std::size_t p = 0; p < arrays.size(); ++p)
          entries.emplace_back(arrays.place[p], p);
        const auto tree   = dealii::pack_rtree(entries);
        auto       result = unknown_fields(time, places);
        if (arrays.size() < n_neighbours)
          return result;
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            std::vector<std::size_t> near;
            for (auto it = tree.qbegin(
                   boost::geometry::index::nearest(places[p], n_neighbours));
                 it != tree.qend();
                 ++it)
              near.push_back(it->second);
            const auto weights = weights_at(places[p], near, arrays.place);
            dealii::Tensor<1, dim> u, v;
            double                 pressure = 0;
            std::array<double, 6>  stress{};
            for (unsigned int k = 0; k < near.size(); ++k)
              {
                u += weights[k] * arrays.displacement[near[k]];
                v += weights[k] * arrays.velocity[near[k]];
                pressure += weights[k] * arrays.pressure[near[k]];
                for (unsigned int c = 0; c < 6; ++c)
                  stress[c] += weights[k] * arrays.stress[near[k]][c];
              }
            result.displacement[p] = u;
            result.velocity[p]     = v;
            result.pressure[p]     = pressure;
            result.stress[p]       = stress;
          }
        return result;
      }

      PointArrays<dim>
      at_own_places(const double time) override
      {
        return read_point_arrays<dim>(file_at(this->files, time));
      }

    private:
      /** Twice as many neighbours as a linear fit needs. */
      static constexpr unsigned int n_neighbours = dim == 2 ? 8 : 16;

      // Square of the distance, over the mean one, below which a point counts
      // as at the place
      static constexpr double interpolating = 1e-8;

      /**
       * Weights of the neighbours' values for the value at @p place of a moving
       * least squares fit by a plane, weighted with the inverse square of the
       * distance: at a point it has the value of that point.
       */
      static std::vector<double>
      weights_at(const dealii::Point<dim>              &place,
                 const std::vector<std::size_t>        &near,
                 const std::vector<dealii::Point<dim>> &places)
      {
        const unsigned int n    = near.size();
        double             mean = 0;
        for (const std::size_t p : near)
          mean += places[p].distance(place) / n;
        if (mean == 0)
          return std::vector<double>(n, 1. / n);

        dealii::FullMatrix<double> rows(n, dim + 1), normal(dim + 1, dim + 1);
        std::vector<double>        share(n);
        for (unsigned int k = 0; k < n; ++k)
          {
            const auto from = (places[near[k]] - place) / mean;
            share[k]        = 1 / (interpolating + from.norm_square());
            rows(k, 0)      = 1;
            for (unsigned int d = 0; d < dim; ++d)
              rows(k, d + 1) = from[d];
            for (unsigned int i = 0; i <= dim; ++i)
              for (unsigned int j = 0; j <= dim; ++j)
                normal(i, j) += share[k] * rows(k, i) * rows(k, j);
          }
        // collinear points do not determine a slope across their line:
        // regularised to zero slope
        for (unsigned int i = 1; i <= dim; ++i)
          normal(i, i) += 1e-10 * normal(0, 0);
        normal.gauss_jordan();
        std::vector<double> result(n);
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int j = 0; j <= dim; ++j)
            result[k] += share[k] * normal(0, j) * rows(k, j);
        return result;
      }
    };



    template <int dim>
    class ExactSource : public FieldSource<dim>
    {
    public:
      explicit ExactSource(const Problem<dim> &problem)
        : exact(problem.exact)
      {}

      std::string
      description() const override
      {
        return "the exact solution of the scene";
      }

      std::vector<double>
      times() const override
      {
        return {};
      }

      PointArrays<dim>
      evaluate(const double                           time,
               const std::vector<dealii::Point<dim>> &places) override
      {
        auto result = unknown_fields(time, places);
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            if (!exact.displacement.empty())
              result.displacement[p] =
                exact.displacement.vector(places[p], time);
            if (!exact.velocity.empty())
              result.velocity[p] = exact.velocity.vector(places[p], time);
            if (!exact.pressure.empty())
              result.pressure[p] = exact.pressure.value(places[p], time);
          }
        return result;
      }

      PointArrays<dim>
      at_own_places(const double time) override
      {
        return unknown_fields<dim>(time, {});
      }

    private:
      const ExactSolution<dim> exact;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_reference_source(const std::string &folder)
  {
    return std::make_unique<ReferenceSource<dim>>(folder);
  }



  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_run_source(const std::string &folder)
  {
    return std::make_unique<RunSource<dim>>(folder);
  }



  template <int dim>
  std::unique_ptr<FieldSource<dim>>
  make_exact_source(const Problem<dim> &problem)
  {
    const ExactSolution<dim> &exact = problem.exact;
    if (exact.displacement.empty() && exact.velocity.empty() &&
        exact.pressure.empty())
      throw InputError("The scene of the run has no exact solution: section "
                       "'Exact solution' is empty. Usually a folder was meant "
                       "instead of the word 'exact'. Set "
                       "'Exact solution/Displacement', or name a folder.");
    return std::make_unique<ExactSource<dim>>(problem);
  }



  template std::unique_ptr<FieldSource<2>>
  make_reference_source(const std::string &);
  template std::unique_ptr<FieldSource<3>>
  make_reference_source(const std::string &);
  template std::unique_ptr<FieldSource<2>>
  make_run_source(const std::string &);
  template std::unique_ptr<FieldSource<3>>
  make_run_source(const std::string &);
  template std::unique_ptr<FieldSource<2>>
  make_exact_source(const Problem<2> &);
  template std::unique_ptr<FieldSource<3>>
  make_exact_source(const Problem<3> &);
} // namespace limber
