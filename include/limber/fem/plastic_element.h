// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_plastic_element_h
#define limber_fem_plastic_element_h

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_dgq.h>

#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/fem/element_fields.h>
#include <limber/fem/solid_element.h>
#include <limber/materials/flow_rates.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  /**
   * Element for elastoplastic laws. A quadrature point stores F and the
   * projected volume ratio j of the end of the step before, and the state of
   * the law there; in a step the law is deformed by the increment f = F F_n^-1,
   * with j / j_n for its volume, and returns to its yield surface at the end
   * (return mapping), as material points do in steps by Newton's method
   * (stress/trial_stress.h). With the treatment of such a point replaced by the
   * projection of the element the two discretisations share every line of the
   * law.
   */
  template <int dim, class Law>
  class PlasticElement final : public SolidElement<dim>
  {
    using Values = typename SolidElement<dim>::Values;
    using State  = typename Law::template State<dim, double>;
    using Vector = dealii::Tensor<1, dim>;
    using Matrix = dealii::Tensor<2, dim>;

  public:
    PlasticElement(const Law         &law,
                   const Body<dim>   &body,
                   const unsigned int n_modes)
      : law(law)
      , body(body)
      , n_modes(n_modes)
    {
      static_assert(Law::is_plastic && Law::finite_strain);
      if (law.depends_on_rate())
        throw InputError(
          "The material '" + body.law + "' in section 'Body " + body.name +
          "' flows at a rate, which the finite element reference does not "
          "know: its steps are those of equilibrium. Set 'Viscosity' or 'Limit "
          "friction angle' of the material to 0, or compare with a finer run.");
      this->finite_strain       = true;
      this->density             = law.density;
      this->pressure_wave_speed = std::sqrt(
        (law.bulk_modulus + 4. / 3. * law.shear_modulus) / law.density);
      this->shear_wave_speed = std::sqrt(law.shear_modulus / law.density);
    }

    // Layout: F by rows, j, pressure, deviator, history variables
    unsigned int
    n_memory() const override
    {
      return dim * dim + 2 + std::tuple_size_v<Deviator<dim, double>> +
             Law::template n_history<dim>;
    }

    // With pressure-dependent yielding the tangent is symmetric only for an
    // associated flow rule.
    bool
    has_symmetric_tangent() const override
    {
      return std::is_same_v<Law, J2>;
    }

    void
    begin(const Values &values, double *memory) const override
    {
      const auto variables = variables_of(body.law, body.material);
      for (const unsigned int q : values.quadrature_point_indices())
        {
          Point point;
          for (int d = 0; d < dim; ++d)
            point.F[d][d] = 1;
          point.state = law.template initialise<dim>(0);
          for (const auto &[k, formula] : body.initial_state)
            {
              const auto   place = values.quadrature_point(q);
              const double value = formula.value(place, 0);
              if (!(value >= variables[k].lowest))
                throw InputError("The variable " +
                                 in_quotes(variables[k].name) + " of body " +
                                 in_quotes(body.name) + " is " + brief(value) +
                                 " at the place " + to_text(place) +
                                 " by its 'Initial state', where it is at "
                                 "least " +
                                 brief(variables[k].lowest) +
                                 ". Usually a formula has the wrong sign. "
                                 "Correct it there.");
              point.state.history[index_of_variable<dim, Law>(k)] = value;
            }
          write(point, memory + q * n_memory());
        }
    }

    bool
    compute(const Values               &values,
            const std::vector<double>  &u,
            dealii::Vector<double>     &forces,
            dealii::FullMatrix<double> *tangent,
            const std::vector<double> * /*former*/,
            const double *memory) const override
    {
      const FieldProjection<dim> projection(values, n_modes);
      std::vector<Trial>         trials;
      if (!deform(values, u, memory, projection, trials))
        return false;

      forces               = 0;
      const unsigned int n = u.size();
      Tangent            derivative(n, projection);
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Trial        &trial = trials[q];
          std::vector<Vector> gradient(n); // of the deformed body
          for (unsigned int i = 0; i < n; ++i)
            gradient[i] = values.shape_grad(i, q) * trial.deformation.inverse;
          const auto   s    = tensor_of<dim>(trial.end.deviator);
          const double mean = trial.conjugate * trial.deformation.J; // -J p
          const double dV   = projection.weights[q];
          for (unsigned int i = 0; i < n; ++i)
            {
              const unsigned int c = component(values, i);
              forces[i] += dV * ((s * gradient[i])[c] + mean * gradient[i][c]);
            }
          if (tangent != nullptr)
            derivative.add(
              values, q, gradient, s, mean, trial.deformation.J, rates(trial));
        }
      if (tangent != nullptr)
        derivative.finish(*tangent);
      return true;
    }

    std::vector<MaterialState>
    states(const Values &values,
           const Values &places,
           const std::vector<double> & /*u*/,
           const double *memory) const override
    {
      std::vector<MaterialState> own;
      for (const unsigned int q : values.quadrature_point_indices())
        own.push_back(
          material_state<dim>(law, read(memory + q * n_memory()).state));
      if (&values == &places)
        return own;
      const dealii::FE_DGQArbitraryNodes<dim> through_points(
        dealii::QGauss<1>(values.get_fe().degree + 1));
      std::vector<MaterialState> result;
      for (const auto &place : places.get_quadrature().get_points())
        {
          MaterialState state;
          state.volume_ratio = 0;
          for (unsigned int q = 0; q < own.size(); ++q)
            {
              const double share = through_points.shape_value(q, place);
              state.volume_ratio += share * own[q].volume_ratio;
              state.pressure += share * own[q].pressure;
              state.stress += share * own[q].stress;
              state.strain_energy += share * own[q].strain_energy;
              for (unsigned int k = 0; k < state.variables.size(); ++k)
                state.variables[k] += share * own[q].variables[k];
            }
          result.push_back(state);
        }
      return result;
    }

    double
    accept(const Values              &values,
           const std::vector<double> &u,
           double                    *memory) const override
    {
      const FieldProjection<dim> projection(values, n_modes);
      std::vector<Trial>         trials;
      if (!deform(values, u, memory, projection, trials))
        throw std::logic_error("no response to this displacement");
      double work = 0; // J
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Trial &trial = trials[q];
          write({trial.deformation.gradient, trial.ratio, trial.end},
                memory + q * n_memory());
          work += projection.weights[q] * trial.plastic_work;
        }
      return work;
    }

  private:
    /** The stored state of a quadrature point. */
    struct Point
    {
      SquareMatrix<dim> F{};
      double            ratio = 1; // j
      State             state;
    };



    /** The trial state of a quadrature point within a step. */
    struct Trial
    {
      Deformation<dim>  deformation;
      double            ratio;        // j
      double            former_ratio; // at the beginning of the step
      SquareMatrix<dim> f;            // of the step
      State             start, end;
      double            conjugate;    // p, of the element, Pa
      double            plastic_work; // Pa
    };



    /** Algorithmic moduli: derivatives of the stress at a point by strain and
     * j. */
    struct Rates
    {
      FlowRates<dim> of_step;
      Matrix         slope, by_ratio; // of U' by strain, of s by j, Pa
      double         curvature;       // U'', Pa
    };



    /**
     * Consistent tangent, the derivative of the forces. The projected ratio has
     * the derivative D_j = M^-1 B_j in its modes; without modes each point has
     * its own ratio.
     */
    class Tangent
    {
    public:
      Tangent(const unsigned int n, const FieldProjection<dim> &projection)
        : n(n)
        , projection(projection)
        , local(n, n)
        , volume(projection.n_modes, n)
        , by_ratio(projection.n_modes, n)
        , slope(projection.n_modes, n)
        , curvature(projection.n_modes, projection.n_modes)
      {}

      void
      add(const Values              &values,
          const unsigned int         q,
          const std::vector<Vector> &gradient,
          const Matrix              &s,
          const double               mean,
          const double               J,
          const Rates               &rates)
      {
        const double                       dV = projection.weights[q];
        dealii::FullMatrix<double>         strain(dim * dim, n);
        std::vector<std::array<double, 3>> of(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            const unsigned int c = component(values, i);
            for (unsigned int d = 0; d < dim; ++d)
              strain(c * dim + d, i) = gradient[i][d];
            of[i] = {{J * gradient[i][c],
                      (rates.by_ratio * gradient[i])[c],
                      (rates.slope * gradient[i])[c]}};
          }
        dealii::FullMatrix<double> stress(dim * dim, n);
        for (unsigned int c = 0; c < dim * dim; ++c)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int k = 0; k < dim * dim; ++k)
              stress(c, i) += rates.of_step.deviator[c][k] * strain(k, i);

        for (unsigned int j = 0; j < n; ++j)
          {
            const unsigned int b         = component(values, j);
            const Vector       on_change = s * gradient[j];
            for (unsigned int i = 0; i < n; ++i)
              {
                const unsigned int a     = component(values, i);
                double             value = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  value += gradient[i][d] * stress(a * dim + d, j);
                value += mean * (gradient[i][a] * gradient[j][b] -
                                 gradient[i][b] * gradient[j][a]);
                if (a == b)
                  value += gradient[i] * on_change;
                if (projection.n_modes == 0)
                  value += of[i][1] * of[j][0] +
                           of[i][0] * (rates.curvature * of[j][0] + of[j][2]);
                local(i, j) += dV * value;
              }
          }
        for (unsigned int m = 0; m < projection.n_modes; ++m)
          {
            const double share = dV * projection.modes(q, m);
            for (unsigned int i = 0; i < n; ++i)
              {
                volume(m, i) += share * of[i][0];
                by_ratio(m, i) += share * of[i][1];
                slope(m, i) += share * of[i][2];
              }
            for (unsigned int l = 0; l < projection.n_modes; ++l)
              curvature(m, l) +=
                share * rates.curvature * projection.modes(q, l);
          }
      }

      void
      finish(dealii::FullMatrix<double> &result)
      {
        result.copy_from(local);
        if (projection.n_modes == 0)
          return;
        dealii::FullMatrix<double> ratio(projection.n_modes, n);
        projection.inverse_mass.mmult(ratio, volume);
        curvature.mmult(slope, ratio, true);
        ratio.Tmmult(result, slope, true);
        by_ratio.Tmmult(result, ratio, true);
      }

    private:
      const unsigned int          n;
      const FieldProjection<dim> &projection;
      dealii::FullMatrix<double>  local;
      dealii::FullMatrix<double>  volume, by_ratio, slope, curvature; // moments
    };



    Point
    read(const double *from) const
    {
      Point point;
      for (auto &row : point.F)
        for (double &entry : row)
          entry = *from++;
      point.ratio          = *from++;
      point.state.pressure = *from++;
      for (double &entry : point.state.deviator)
        entry = *from++;
      for (double &entry : point.state.history)
        entry = *from++;
      return point;
    }

    void
    write(const Point &point, double *to) const
    {
      for (const auto &row : point.F)
        to = std::copy(row.begin(), row.end(), to);
      *to++ = point.ratio;
      *to++ = point.state.pressure;
      to =
        std::copy(point.state.deviator.begin(), point.state.deviator.end(), to);
      std::copy(point.state.history.begin(), point.state.history.end(), to);
    }

    /** False where the element is inverted at any point. */
    bool
    deform(const Values               &values,
           const std::vector<double>  &u,
           const double               *memory,
           const FieldProjection<dim> &projection,
           std::vector<Trial>         &trials) const
    {
      std::vector<double> ratios;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          Trial &trial      = trials.emplace_back();
          trial.deformation = deformation<dim>(values, q, u, true);
          if (!(trial.deformation.J > 0))
            return false;
          ratios.push_back(trial.deformation.J);
        }
      ratios = projection.project(ratios);

      std::vector<double> conjugate;
      for (unsigned int q = 0; q < ratios.size(); ++q)
        {
          if (!(ratios[q] > 0))
            return false;
          Trial       &trial  = trials[q];
          const Point  point  = read(memory + q * n_memory());
          const auto   cof    = cofactor<dim>(point.F); // det F_n F_n^-T
          const double former = determinant<dim>(point.F);
          trial.f             = {};
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              for (int c = 0; c < dim; ++c)
                trial.f[d][e] +=
                  trial.deformation.gradient[d][c] * cof[e][c] / former;
          trial.ratio        = ratios[q];
          trial.former_ratio = point.ratio;
          trial.start = trial.end = point.state;
          trial.plastic_work =
            law.template deform<dim>(trial.f,
                                     trial.ratio / trial.former_ratio,
                                     trial.end);
          conjugate.push_back(-trial.end.pressure / trial.ratio);
        }
      conjugate = projection.project(conjugate);
      for (unsigned int q = 0; q < ratios.size(); ++q)
        trials[q].conjugate = conjugate[q];
      return true;
    }

    Rates
    rates(const Trial &trial) const
    {
      const double former = trial.former_ratio;
      Rates        result{
        flow_rates<dim, Law>(law, trial.start, trial.f, trial.ratio / former),
        {},
        {},
        0};
      result.curvature = result.of_step.curvature / (former * former);
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            result.slope[d][e]    = result.of_step.slope[d][e] / former;
            result.by_ratio[d][e] = result.of_step.by_growth[d][e] / former;
          }
      return result;
    }

    const FurtherDeformation<Law> law;
    const Body<dim>               body;
    const unsigned int            n_modes;
  };
} // namespace limber

#endif
