// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/further_deformation.h>
#include <limber/materials/law_list.h>
#include <limber/points/cell_batch.h>
#include <limber/points/locate.h>
#include <limber/stress/assumed_trial.h>
#include <limber/stress/strain_projection.h>
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
        : xi(natural_place(points, cell, p))
      {
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

      std::array<double, dim>                xi;
      std::array<double, n>                  value;
      std::array<std::array<double, dim>, n> gradient;
    };



    template <int dim, class Law>
    class LawTrialStress final : public TrialStress<dim>
    {
      static constexpr int  n_nodes = 1 << dim;
      static constexpr int  n_dofs  = dim * n_nodes;
      static constexpr bool finite  = Law::finite_strain;
      static constexpr bool flows   = Law::is_plastic;
      using State                   = typename Law::template State<dim, double>;
      using Matrix                  = SquareMatrix<dim>;
      using Gradients = std::array<std::array<double, dim>, n_nodes>;
      using Work      = typename TrialStress<dim>::Work;

    public:
      LawTrialStress(const Law              &law,
                     const StrainProjection &projection,
                     const Frame             frame)
        : law(law)
        , projection(projection)
        , mean_volume(projection.kind == Projection::cell)
        , assumes(projection.kind == Projection::assumed_strain)
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
              // what yields is not linear in its strain
              if constexpr (finite && !flows)
                if (former != nullptr &&
                    strain(points, grid, former, batch, trial_before))
                  extrapolate(trial_before, trial);
              add_tangent(trial, response);
            }
          work(batch.cell, response);
        });
        return admissible;
      }

      AcceptedMotion
      accept(const PointView<dim> &points,
             const GridView<dim>  &grid,
             const double *const   displacement) const override
      {
        AcceptedMotion result;
        Trial          trial;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (!strain(points, grid, displacement, batch, trial))
            throw std::logic_error("no response to this displacement");
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            {
              const Motion &motion = trial.motions[p - batch.begin];
              keep(motion, points, p);
              if (initial)
                keep_deformation(assumes ?
                                   trial.assumed.points[p - batch.begin].F :
                                   motion.f,
                                 points,
                                 p);
              result.plastic_work += motion.volume * motion.plastic_work;
            }
          result.longest_way =
            std::max(result.longest_way, move(points, grid, trial.u, batch));
        });
        return result;
      }

      double
      young_modulus() const override
      {
        const double K = law.bulk_modulus, G = law.shear_modulus;
        return 9 * K * G / (3 * K + G);
      }

      double
      bulk_over_shear() const override
      {
        return mean_volume ? law.bulk_modulus / law.shear_modulus : 0;
      }

      // Flow whose strength follows the pressure makes volume as it is given
      // only where it is associated.
      bool
      has_symmetric_tangent() const override
      {
        return !flows || std::is_same_v<Law, J2>;
      }

    private:
      /** Of a point in a trial. */
      struct Motion
      {
        Gradients gradient;  // of the functions where forces act, 1/m
        Matrix    f;         // of the step, or F in the initial frame;
                             // where strain is assumed, as it is assumed
        double growth;       // of the volume by it, the point's own
        double volume;       // at the start, m^dim
        double former_ratio; // volume ratio that the growth belongs to
        State  state;
        State  start;            // where the law flows, before the step
        double acting       = 1; // growth that the state has followed
        double plastic_work = 0; // per volume at the start, Pa
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
        AssumedTrial<dim, finite>                    assumed;
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
        if (assumes && !assume(points, cell, batch, trial))
          return false;

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

      // Each point is deformed as its cell lets it; false as above.
      bool
      assume(const PointView<dim>    &points,
             const CellGeometry<dim> &cell,
             const CellBatch         &batch,
             Trial                   &trial) const
      {
        auto &assumed = trial.assumed;
        assumed.points.resize(trial.motions.size());
        for (std::size_t k = 0; k < trial.motions.size(); ++k)
          {
            const LinearFunctions<dim> functions(points, cell, batch.begin + k);
            assumed.points[k] = {trial.motions[k].f,
                                 functions.xi,
                                 trial.motions[k].volume,
                                 functions.gradient};
          }
        if (!assumed.finish(projection))
          return false;
        for (std::size_t k = 0; k < trial.motions.size(); ++k)
          {
            Motion &motion = trial.motions[k];
            motion.f       = assumed.deformation(k);
            motion.growth  = volume_ratio(motion.f);
            if (finite && !(motion.growth > 0))
              return false;
          }
        return true;
      }

      static double
      volume_ratio(const Matrix &f)
      {
        if constexpr (finite)
          return determinant<dim>(f);
        double result = 1;
        for (int d = 0; d < dim; ++d)
          result += f[d][d] - 1;
        return result;
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
        motion.growth   = volume_ratio(motion.f);
        if constexpr (!finite)
          return true;
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
        if constexpr (!flows)
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
        if constexpr (flows)
          {
            motion.start  = state;
            motion.acting = growth;
          }
        motion.plastic_work = law.template deform<dim>(motion.f, growth, state);
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
        if constexpr (flows)
          return 0; // found with the rates of the tangent
        else
          {
            const double J = motion.former_ratio;
            return finite ? J * J * law.volumetric_stiffness(J * growth) :
                            law.volumetric_stiffness(1.);
          }
      }



      // To the stress of the iterate before and its growth with the
      // displacements since, which is linear in them in the frame that moves
      // with the material.
      void
      extrapolate(const Trial &before, Trial &trial) const
      {
        static_assert(!flows);
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
      resist(Trial &trial, CellResponse<dim> &response) const
      {
        for (const Motion &motion : trial.motions)
          response.energy +=
            motion.volume * (law.template strain_energy<dim>(motion.state) +
                             motion.plastic_work);
        if (assumes)
          {
            trial.assumed.add_force(stress_on_assumed(trial), response.force);
            return;
          }
        for (const Motion &motion : trial.motions)
          {
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

      // First Piola and Kirchhoff's, Pa
      std::vector<Matrix>
      stress_on_assumed(const Trial &trial) const
      {
        std::vector<Matrix> result;
        for (const Motion &motion : trial.motions)
          {
            Matrix       stress = motion.stress;
            const double mean   = mean_stress(motion);
            for (int d = 0; d < dim; ++d)
              stress[d][d] += mean;
            if constexpr (finite)
              {
                stress = times<dim>(stress, cofactor<dim>(motion.f));
                for (auto &row : stress)
                  for (double &entry : row)
                    entry /= motion.growth;
              }
            result.push_back(stress);
          }
        return result;
      }

      // [d, e][k, l]: what the force along d by the gradient along e grows by
      // with the displacement along k by the gradient along l
      using Moduli =
        std::array<std::array<double, dim * dim>, std::size_t(dim *dim)>;

      /** What the stress of a point grows by, in the tangent. */
      struct Rates
      {
        // Lie derivative of the deviator by the strain along (k, l) at a given
        // volume: entry [d, e][k, l]
        Moduli deviator{};
        // of the slope of the energy, by growth and by strain at a given volume
        double curvature = 0;
        Matrix slope{};
        Matrix by_growth{}; // of the deviator
      };

      Rates
      rates_of(const Motion &motion) const
      {
        Rates result;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l <= k; ++l)
            {
              Matrix e{};
              e[k][l] += 0.5;
              e[l][k] += 0.5;
              Matrix rate{};
              if constexpr (flows)
                rate = by_strain(motion, e, result.slope[k][l]);
              else
                rate = law.template deviatoric_tangent<dim>(motion.state, e);
              result.slope[l][k] = result.slope[k][l];
              for (int c = 0; c < dim * dim; ++c)
                result.deviator[c][k * dim + l] =
                  result.deviator[c][l * dim + k] = rate[c / dim][c % dim];
            }
        if constexpr (flows)
          {
            const Motion more  = perturbed(motion, {}, difference),
                         less  = perturbed(motion, {}, -difference);
            const double scale = 1 / (2 * difference * motion.acting);
            result.curvature =
              (slope(more, more.acting) - slope(less, less.acting)) * scale;
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                result.by_growth[d][e] =
                  (more.stress[d][e] - less.stress[d][e]) * scale;
          }
        else
          result.curvature = curvature(motion, motion.growth);
        return result;
      }

      // Where a law flows its rates are central differences: the return map
      // knows many branches, and at the edge of one their mean is taken.
      static constexpr double difference = 1e-7;

      /** After f has grown by the strain e, the acting volume by a share. */
      Motion
      perturbed(const Motion &motion, const Matrix &e, const double share) const
      {
        Motion result = motion;
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            for (int b = 0; b < dim; ++b)
              result.f[c][d] += e[c][b] * motion.f[b][d];
        result.acting *= 1 + share;
        result.state = motion.start;
        law.template deform<dim>(result.f, result.acting, result.state);
        result.stress = rows_of<dim>(result.state.deviator);
        return result;
      }

      // Lie derivative of the deviator, and derivative of the slope
      Matrix
      by_strain(const Motion &motion,
                const Matrix &direction,
                double       &of_slope) const
      {
        Matrix e = direction, back = direction;
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            {
              e[c][d] *= difference;
              back[c][d] *= -difference;
            }
        const Motion more = perturbed(motion, e, 0),
                     less = perturbed(motion, back, 0);
        of_slope = (slope(more, more.acting) - slope(less, less.acting)) /
                   (2 * difference);
        const Matrix own = rows_of<dim>(motion.state.deviator);
        Matrix       result;
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            {
              result[c][d] =
                (more.stress[c][d] - less.stress[c][d]) / (2 * difference);
              for (int b = 0; b < dim; ++b)
                result[c][d] -=
                  direction[c][b] * own[b][d] + own[c][b] * direction[d][b];
            }
        return result;
      }

      // Simo and Hughes, 7.1 and 9.2: material part, stress on the change of
      // the gradients, and the curvature of the volumetric energy. Where flow
      // couples pressure and shear, the deviator follows the mean volume, and
      // the pressure of the cell the strains of its points.
      void
      add_tangent(Trial &trial, CellResponse<dim> &response) const
      {
        if (assumes)
          {
            std::vector<Moduli> moduli;
            for (const Motion &motion : trial.motions)
              moduli.push_back(
                moduli_of(motion, mean_stress(motion), rates_of(motion)));
            trial.assumed.add_tangent(
              stress_on_assumed(trial),
              [&](const std::size_t p, int d, int e, int f, int g) {
                return moduli[p][d * dim + e][f * dim + g];
              },
              response.tangent);
            return;
          }
        // derivatives of mean growth and, times the volume, of the slope
        std::array<double, n_dofs> &mean_growth = response.volume_row;
        std::array<double, n_dofs>  slope_of_cell{};
        std::array<double, n_dofs>  by_growth{}; // of the force
        double                      curvature_of_cell = trial.curvature;
        for (const Motion &motion : trial.motions)
          {
            const Rates rates = rates_of(motion);
            add_tangent(motion, mean_stress(motion), rates, response);
            const double weight =
              motion.volume / trial.volume * (finite ? motion.growth : 1.);
            for (int i = 0; i < n_nodes; ++i)
              for (int d = 0; d < dim; ++d)
                {
                  const int k = i * dim + d;
                  mean_growth[k] += weight * motion.gradient[i][d];
                  if constexpr (flows)
                    for (int e = 0; e < dim; ++e)
                      {
                        slope_of_cell[k] += motion.volume * rates.slope[d][e] *
                                            motion.gradient[i][e];
                        by_growth[k] += motion.volume * rates.by_growth[d][e] *
                                        motion.gradient[i][e];
                      }
                }
            if constexpr (flows)
              curvature_of_cell += motion.volume * rates.curvature;
          }
        if (!mean_volume)
          return;
        response.volume_stiffness = curvature_of_cell;
        if constexpr (flows)
          for (int k = 0; k < n_dofs; ++k)
            for (int l = 0; l < n_dofs; ++l)
              response.tangent[k * n_dofs + l] +=
                mean_growth[k] * slope_of_cell[l] +
                by_growth[k] * mean_growth[l];
      }

      Moduli
      moduli_of(const Motion &motion,
                const double  mean,
                const Rates  &rates) const
      {
        Moduli        a      = rates.deviator;
        const Matrix &s      = motion.stress;
        const double  growth = finite ? motion.growth : 1.;
        const double  volumetric =
          mean_volume ? 0 : rates.curvature * growth * growth;
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
              if constexpr (flows)
                if (!mean_volume)
                  for (int k = 0; k < dim; ++k)
                    {
                      a[k * dim + k][d * dim + e] += growth * rates.slope[d][e];
                      a[d * dim + e][k * dim + k] +=
                        growth * rates.by_growth[d][e];
                    }
            }
        return a;
      }

      void
      add_tangent(const Motion      &motion,
                  const double       mean,
                  const Rates       &rates,
                  CellResponse<dim> &response) const
      {
        constexpr int    n = dim * dim;
        const Moduli     a = moduli_of(motion, mean, rates);
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
      }

      static void
      keep_deformation(const Matrix         &F,
                       const PointView<dim> &points,
                       const std::size_t     p)
      {
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            points.deformation[d * dim + e][p] = F[d][e];
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
      const StrainProjection        projection;
      const bool                    mean_volume, assumes, initial;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<const TrialStress<dim>>
  make_trial_stress(const std::string         &name,
                    const std::vector<double> &values,
                    const Projection           kind,
                    const HourglassResponse    response,
                    const Frame                frame)
  {
    if (kind != Projection::none && kind != Projection::cell &&
        kind != Projection::assumed_strain)
      throw std::logic_error("no tangent of this projection");
    std::unique_ptr<const TrialStress<dim>> result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      if constexpr (Law::is_elastic || Law::is_plastic)
        {
          if (result || name != Law::name)
            return;
          std::array<double, Law::parameters.size()> own;
          if (values.size() != own.size())
            throw std::logic_error("wrong number of parameters for " + name);
          std::copy(values.begin(), values.end(), own.begin());
          if (Law::accepts(own))
            {
              if (Law::is_plastic && frame == Frame::initial)
                throw std::logic_error("no flow in the initial frame");
              const Law candidate_law(own);
              result = std::make_unique<LawTrialStress<dim, Law>>(
                candidate_law,
                strain_projection(candidate_law, kind, response),
                frame);
            }
        }
    });
    if (!result)
      throw std::logic_error("no law of a solid " + name);
    return result;
  }



  template std::unique_ptr<const TrialStress<2>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Projection,
                    HourglassResponse,
                    Frame);
  template std::unique_ptr<const TrialStress<3>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Projection,
                    HourglassResponse,
                    Frame);
} // namespace limber
