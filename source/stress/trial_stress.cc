// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/further_deformation.h>
#include <limber/materials/law_list.h>
#include <limber/points/cell_batch.h>
#include <limber/points/locate.h>
#include <limber/stress/trial_stress.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace limber
{
  namespace
  {
    /** Values and gradients (1/m) of the linear functions at a point. */
    template <int dim>
    struct LinearFunctions
    {
      static constexpr int n = 1 << dim;

      LinearFunctions(const PointView<dim>    &points,
                      const CellGeometry<dim> &cell,
                      const std::size_t        p)
      {
        const auto xi = natural_place(points, cell, p);
        for (int i = 0; i < n; ++i)
          {
            std::array<double, dim> factor;
            value[i] = 1;
            for (int d = 0; d < dim; ++d)
              {
                factor[d] = (i >> d & 1) != 0 ? xi[d] : 1 - xi[d];
                value[i] *= factor[d];
              }
            for (int d = 0; d < dim; ++d)
              {
                gradient[i][d] = (i >> d & 1) != 0 ? cell.inverse_edge[d] :
                                                     -cell.inverse_edge[d];
                for (int e = 0; e < dim; ++e)
                  if (e != d)
                    gradient[i][d] *= factor[e];
              }
          }
      }

      std::array<double, n>                  value;
      std::array<std::array<double, dim>, n> gradient;
    };



    template <int dim, class Law>
    class LawTrialStress final : public TrialStress<dim>
    {
      static constexpr int  n_nodes = 1 << dim;
      static constexpr int  n_dofs  = dim * n_nodes;
      static constexpr bool finite  = Law::finite_strain;
      using State                   = typename Law::template State<dim, double>;
      using Matrix                  = SquareMatrix<dim>;
      using Gradients = std::array<std::array<double, dim>, n_nodes>;
      using Work      = typename TrialStress<dim>::Work;

    public:
      LawTrialStress(const Law &law, const bool mean_volume, const Frame frame)
        : law(law)
        , mean_volume(mean_volume)
        , initial(frame == Frame::initial)
      {}

      bool
      respond(const PointView<dim> &points,
              const GridView<dim>  &grid,
              const double *const   displacement,
              const double *const   former,
              const bool            with_tangent,
              const Work           &work) const override
      {
        bool              admissible = true;
        CellResponse<dim> response;
        Trial             trial, trial_before;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (!admissible)
            return;
          admissible = strain(points, grid, displacement, batch, trial);
          if (!admissible)
            return;
          response = {};
          resist(trial, response);
          if (with_tangent)
            {
              if (finite && former != nullptr &&
                  strain(points, grid, former, batch, trial_before))
                extrapolate(trial_before, trial);
              add_tangent(trial, response);
            }
          work(batch.cell, response);
        });
        return admissible;
      }

      double
      accept(const PointView<dim> &points,
             const GridView<dim>  &grid,
             const double *const   displacement) const override
      {
        double longest = 0;
        Trial  trial;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (!strain(points, grid, displacement, batch, trial))
            throw std::logic_error("no response to this displacement");
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            keep(trial.motions[p - batch.begin], points, p);
          longest = std::max(longest, move(points, grid, trial.u, batch));
        });
        return longest;
      }

      double
      young_modulus() const override
      {
        const double K = law.bulk_modulus, G = law.shear_modulus;
        return 9 * K * G / (3 * K + G);
      }

    private:
      /** Of a point in a trial. */
      struct Motion
      {
        Gradients gradient;     // of the functions where forces act, 1/m
        Matrix    f;            // of the step, or F in the initial frame
        double    growth;       // of the volume by it, the point's own
        double    volume;       // at the start, m^dim
        double    former_ratio; // volume ratio that the growth belongs to
        State     state;
        // In the tangent: rows of the deviator, and derivative of the energy by
        // the growth that acts, per volume at the start, Pa
        Matrix stress;
        double slope;
      };

      /** Of the points of a cell. */
      struct Trial
      {
        std::array<std::array<double, dim>, n_nodes> u; // of the nodes, m
        std::vector<Motion>                          motions;
        double volume = 0;               // of all at the start, m^dim
        double slope = 0, curvature = 0; // of the energy, by mean growth, J
      };



      // Kinematics and states; false where a point is turned inside out.
      bool
      strain(const PointView<dim> &points,
             const GridView<dim>  &grid,
             const double *const   displacement,
             const CellBatch      &batch,
             Trial                &trial) const
      {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        for (int i = 0; i < n_nodes; ++i)
          std::copy_n(displacement + std::size_t(cell.node[i]) /
                                       NodeLayout<dim>::stride * dim,
                      dim,
                      trial.u[i].begin());

        trial.motions.resize(batch.end - batch.begin);
        trial.volume       = 0;
        double mean_growth = 0;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            Motion &motion = trial.motions[p - batch.begin];
            if (!deform(points, cell, p, trial.u, motion))
              return false;
            trial.volume += motion.volume;
            mean_growth += motion.volume * motion.growth;
          }
        mean_growth /= trial.volume;

        trial.slope = trial.curvature = 0;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            Motion      &motion = trial.motions[p - batch.begin];
            const double growth = mean_volume ? mean_growth : motion.growth;
            set_state(points, p, growth, motion);
            if (mean_volume)
              {
                trial.slope += motion.volume * slope(motion, growth);
                trial.curvature += motion.volume * curvature(motion, growth);
              }
            motion.slope  = slope(motion, growth);
            motion.stress = rows_of<dim>(motion.state.deviator);
          }
        if (mean_volume)
          for (Motion &motion : trial.motions)
            motion.slope = trial.slope / trial.volume;
        return true;
      }

      bool
      deform(const PointView<dim>                               &points,
             const CellGeometry<dim>                            &cell,
             const std::size_t                                   p,
             const std::array<std::array<double, dim>, n_nodes> &u,
             Motion                                             &motion) const
      {
        const LinearFunctions<dim> functions(points, cell, p);
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            {
              double &entry = motion.f[d][e];
              entry = initial ? points.deformation[d * dim + e][p] : d == e;
              for (int i = 0; i < n_nodes; ++i)
                entry += u[i][d] * functions.gradient[i][e];
            }
        motion.volume   = points.mass[p] / law.density;
        motion.gradient = functions.gradient;
        if constexpr (!finite)
          {
            motion.growth = 1;
            for (int d = 0; d < dim; ++d)
              motion.growth += motion.f[d][d] - 1;
            return true;
          }
        motion.growth = determinant<dim>(motion.f);
        if (!(motion.growth > 0))
          return false;
        const Matrix cof = cofactor<dim>(motion.f); // det(f) f^-T
        for (int i = 0; i < n_nodes; ++i)
          for (int d = 0; d < dim; ++d)
            {
              double &entry = motion.gradient[i][d];
              entry         = 0;
              for (int e = 0; e < dim; ++e)
                entry += cof[d][e] * functions.gradient[i][e];
              entry /= motion.growth;
            }
        return true;
      }

      void
      set_state(const PointView<dim> &points,
                const std::size_t     p,
                const double          growth,
                Motion               &motion) const
      {
        State &state = motion.state;
        if (initial)
          {
            motion.former_ratio = 1;
            state = law.template at_deformation<dim>(motion.f, growth);
            return;
          }
        state.pressure = points.pressure[p];
        for (unsigned int k = 0; k < state.deviator.size(); ++k)
          state.deviator[k] = points.deviator[k][p];
        for (unsigned int k = 0; k < state.history.size(); ++k)
          state.history[k] = points.history[k][p];
        motion.former_ratio = law.template volume_ratio<dim>(state);
        law.template deform<dim>(motion.f, growth, state);
      }

      // Of the volumetric energy, by the growth that acts; both are per volume
      // at the start. J p = - J dU/dJ.
      static double
      slope(const Motion &motion, const double growth)
      {
        return finite ? -motion.state.pressure / growth :
                        -motion.state.pressure;
      }

      double
      curvature(const Motion &motion, const double growth) const
      {
        const double J = motion.former_ratio;
        return finite ? J * J * law.volumetric_stiffness(J * growth) :
                        law.volumetric_stiffness(1.);
      }



      // To the stress of the iterate before and its growth with the
      // displacements since, which is linear in them in the frame that moves
      // with the material.
      void
      extrapolate(const Trial &before, Trial &trial) const
      {
        double slope_of_cell = before.slope, mean_growth = 0;
        for (std::size_t k = 0; k < trial.motions.size(); ++k)
          {
            const Motion &from  = before.motions[k];
            Motion       &to    = trial.motions[k];
            const Matrix  cof   = cofactor<dim>(from.f);
            Matrix        way   = {}; // f f_before^-1
            double        trace = -dim;
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                for (int c = 0; c < dim; ++c)
                  way[d][e] += to.f[d][c] * cof[e][c] / from.growth;
            Matrix strain;
            for (int d = 0; d < dim; ++d)
              {
                trace += way[d][d];
                for (int e = 0; e < dim; ++e)
                  strain[d][e] = 0.5 * (way[d][e] + way[e][d]) - (d == e);
              }
            Matrix       stress = rows_of<dim>(from.state.deviator);
            const Matrix rate =
              law.template deviatoric_tangent<dim>(from.state, strain);
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                stress[d][e] += rate[d][e];
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                {
                  double entry = 0;
                  for (int c = 0; c < dim; ++c)
                    for (int b = 0; b < dim; ++b)
                      entry += way[d][c] * stress[c][b] * way[e][b];
                  to.stress[d][e] = entry;
                }
            if (mean_volume)
              mean_growth += from.volume / before.volume * from.growth * trace;
            else
              to.slope = slope(from, from.growth) +
                         curvature(from, from.growth) * from.growth * trace;
          }
        if (mean_volume)
          {
            slope_of_cell += before.curvature * mean_growth;
            for (Motion &to : trial.motions)
              to.slope = slope_of_cell / trial.volume;
          }
      }

      // The first derivative of the energy. Where volumes are averaged, it goes
      // by the mean growth, whose derivative is the mean of growth * gradient.
      void
      resist(const Trial &trial, CellResponse<dim> &response) const
      {
        for (const Motion &motion : trial.motions)
          {
            response.energy +=
              motion.volume * law.template strain_energy<dim>(motion.state);
            const Matrix &s    = motion.stress;
            const double  mean = mean_stress(motion);
            for (int i = 0; i < n_nodes; ++i)
              for (int d = 0; d < dim; ++d)
                {
                  double force = mean * motion.gradient[i][d];
                  for (int e = 0; e < dim; ++e)
                    force += s[d][e] * motion.gradient[i][e];
                  response.force[i * dim + d] += motion.volume * force;
                }
          }
      }

      // Kirchhoff, that of the points of the cell, as it acts at this one, Pa.
      static double
      mean_stress(const Motion &motion)
      {
        return motion.slope * (finite ? motion.growth : 1.);
      }

      // Simo and Hughes, 7.1 and 9.2: material part, stress on the change of
      // the gradients, and the curvature of the volumetric energy.
      void
      add_tangent(const Trial &trial, CellResponse<dim> &response) const
      {
        std::array<double, n_dofs> mean_growth{}; // its derivative
        for (const Motion &motion : trial.motions)
          {
            const double own =
              mean_volume ? 0 :
                            curvature(motion, motion.growth) *
                              (finite ? motion.growth * motion.growth : 1.);
            add_tangent(motion, mean_stress(motion), own, response);
            const double weight =
              motion.volume / trial.volume * (finite ? motion.growth : 1.);
            for (int i = 0; i < n_nodes; ++i)
              for (int d = 0; d < dim; ++d)
                mean_growth[i * dim + d] += weight * motion.gradient[i][d];
          }
        if (mean_volume)
          for (int k = 0; k < n_dofs; ++k)
            for (int l = 0; l < n_dofs; ++l)
              response.tangent[k * n_dofs + l] +=
                trial.curvature * mean_growth[k] * mean_growth[l];
      }

      void
      add_tangent(const Motion      &motion,
                  const double       mean,
                  const double       volumetric,
                  CellResponse<dim> &response) const
      {
        // a[d, e][k, l]: what the force along d by the gradient along e grows
        // by with the displacement along k by the gradient along l
        constexpr int                                     n = dim * dim;
        std::array<std::array<double, n>, std::size_t(n)> a{};
        const Matrix                                     &s = motion.stress;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l <= k; ++l)
            {
              Matrix e{};
              e[k][l] += 0.5;
              e[l][k] += 0.5;
              const Matrix rate =
                law.template deviatoric_tangent<dim>(motion.state, e);
              for (int c = 0; c < n; ++c)
                a[c][k * dim + l] = a[c][l * dim + k] = rate[c / dim][c % dim];
            }
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            {
              a[d * dim + d][e * dim + e] += volumetric;
              if constexpr (finite)
                {
                  a[d * dim + d][e * dim + e] += mean;
                  a[d * dim + e][e * dim + d] -= mean;
                  for (int k = 0; k < dim; ++k)
                    a[k * dim + d][k * dim + e] += s[d][e];
                }
            }

        const Gradients &g = motion.gradient;
        for (int i = 0; i < n_nodes; ++i)
          for (int d = 0; d < dim; ++d)
            {
              std::array<double, n> row{};
              for (int e = 0; e < dim; ++e)
                for (int c = 0; c < n; ++c)
                  row[c] += motion.volume * g[i][e] * a[d * dim + e][c];
              double *const out =
                &response.tangent[std::size_t(i * dim + d) * n_dofs];
              for (int j = 0; j < n_nodes; ++j)
                for (int k = 0; k < dim; ++k)
                  for (int l = 0; l < dim; ++l)
                    out[j * dim + k] += row[k * dim + l] * g[j][l];
            }
      }



      void
      keep(const Motion         &motion,
           const PointView<dim> &points,
           const std::size_t     p) const
      {
        points.pressure[p] = motion.state.pressure;
        for (unsigned int k = 0; k < motion.state.deviator.size(); ++k)
          points.deviator[k][p] = motion.state.deviator[k];
        for (unsigned int k = 0; k < motion.state.history.size(); ++k)
          points.history[k][p] = motion.state.history[k];
        if (initial)
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              points.deformation[d * dim + e][p] = motion.f[d][e];
      }

      double
      move(const PointView<dim>                               &points,
           const GridView<dim>                                &grid,
           const std::array<std::array<double, dim>, n_nodes> &u,
           const CellBatch                                    &batch) const
      {
        const CellGeometry<dim> &cell    = grid.cells[batch.cell];
        double                   longest = 0;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            const LinearFunctions<dim> functions(points, cell, p);
            for (int d = 0; d < dim; ++d)
              {
                double way = 0;
                for (int i = 0; i < n_nodes; ++i)
                  way += functions.value[i] * u[i][d];
                points.position[d][p] += way;
                longest =
                  std::max(longest, std::abs(way) * cell.inverse_edge[d]);
              }
          }
        if (!initial)
          locate(points, grid, batch.cell, batch.begin, batch.end);
        return longest;
      }

      const FurtherDeformation<Law> law;
      const bool                    mean_volume, initial;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<const TrialStress<dim>>
  make_trial_stress(const std::string         &name,
                    const std::vector<double> &values,
                    const Projection           kind,
                    const Frame                frame)
  {
    if (kind != Projection::none && kind != Projection::cell)
      throw std::logic_error("no tangent of this projection");
    std::unique_ptr<const TrialStress<dim>> result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      if constexpr (Law::is_elastic)
        {
          if (result || name != Law::name)
            return;
          std::array<double, Law::parameters.size()> own;
          if (values.size() != own.size())
            throw std::logic_error("wrong number of parameters for " + name);
          std::copy(values.begin(), values.end(), own.begin());
          if (Law::accepts(own))
            result = std::make_unique<LawTrialStress<dim, Law>>(
              Law(own), kind == Projection::cell, frame);
        }
    });
    if (!result)
      throw std::logic_error("no elastic law " + name);
    return result;
  }



  template std::unique_ptr<const TrialStress<2>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Projection,
                    Frame);
  template std::unique_ptr<const TrialStress<3>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Projection,
                    Frame);
} // namespace limber
