// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/fem/element_fields.h>
#include <limber/fem/plastic_element.h>
#include <limber/materials/law_list.h>

#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    MaterialState
    unknown_state()
    {
      constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
      MaterialState    state;
      state.volume_ratio = state.pressure = state.strain_energy = nothing;
      for (unsigned int k = 0; k < state.stress.n_independent_components; ++k)
        state.stress.access_raw_entry(k) = nothing;
      return state;
    }



    template <int dim, class Law>
    class LawElement : public SolidElement<dim>
    {
      using Values = typename SolidElement<dim>::Values;
      using Tensor = dealii::Tensor<1, dim>;

    public:
      LawElement(const Law &law, const unsigned int n_modes)
        : law(law)
        , n_modes(n_modes)
      {
        this->finite_strain       = Law::finite_strain;
        this->density             = law.density;
        this->pressure_wave_speed = std::sqrt(
          (law.bulk_modulus + 4. / 3. * law.shear_modulus) / law.density);
        this->shear_wave_speed = std::sqrt(law.shear_modulus / law.density);
      }

      bool
      compute(const Values               &values,
              const std::vector<double>  &u,
              dealii::Vector<double>     &forces,
              dealii::FullMatrix<double> *tangent,
              const std::vector<double>  *former,
              const double *) const override
      {
        const unsigned int            n = u.size();
        const FieldProjection<dim>    projection(values, n_modes);
        std::vector<Deformation<dim>> deformations;
        if (!deform(values, u, deformations))
          return false;

        const auto          ratio = projection.project(ratios(deformations));
        std::vector<double> conjugate;
        std::vector<typename Law::template State<dim, double>> states;
        for (unsigned int q = 0; q < ratio.size(); ++q)
          {
            if (Law::finite_strain && !(ratio[q] > 0))
              return false;
            states.push_back(
              law.template at_deformation<dim>(deformations[q].gradient,
                                               ratio[q]));
            conjugate.push_back(slope_of_energy(states.back(), ratio[q]));
          }
        conjugate = projection.project(conjugate);
        const std::vector<double> in_tangent =
          Law::finite_strain && tangent != nullptr && former != nullptr ?
            extrapolate(values, projection, *former, u) :
            conjugate;

        forces = 0;
        if (tangent != nullptr)
          *tangent = 0;
        dealii::FullMatrix<double> volume_moments(projection.n_modes, n);
        std::vector<Tensor>        gradient(n); // of the deformed body
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double dV = projection.weights[q];
            for (unsigned int i = 0; i < n; ++i)
              gradient[i] = values.shape_grad(i, q) * deformations[q].inverse;

            const auto   s    = tensor_of<dim>(states[q].deviator);
            const double J    = Law::finite_strain ? deformations[q].J : 1;
            const double mean = conjugate[q] * J; // mean Kirchhoff stress
            for (unsigned int i = 0; i < n; ++i)
              {
                const unsigned int c = component(values, i);
                forces[i] +=
                  dV * ((s * gradient[i])[c] + mean * gradient[i][c]);
                for (unsigned int m = 0; m < projection.n_modes; ++m)
                  volume_moments(m, i) +=
                    dV * projection.modes(q, m) * J * gradient[i][c];
              }
            if (tangent != nullptr)
              add_tangent(values,
                          dV,
                          states[q],
                          s,
                          in_tangent[q] * J,
                          gradient,
                          *tangent);
            if (tangent != nullptr && projection.n_modes == 0)
              {
                const double k =
                  dV * law.volumetric_stiffness(ratio[q]) * J * J;
                for (unsigned int i = 0; i < n; ++i)
                  for (unsigned int j = 0; j < n; ++j)
                    (*tangent)(i, j) += k * gradient[i][component(values, i)] *
                                        gradient[j][component(values, j)];
              }
          }
        if (tangent != nullptr && projection.n_modes > 0)
          add_projected_tangent(projection, ratio, volume_moments, *tangent);
        return true;
      }

      std::vector<MaterialState>
      states(const Values              &values,
             const Values              &places,
             const std::vector<double> &u,
             const double *) const override
      {
        const FieldProjection<dim>    projection(values, n_modes);
        std::vector<Deformation<dim>> own, there;
        deform(values, u, own);
        deform(places, u, there);
        const std::vector<double> ratio =
          n_modes == 0 ?
            ratios(there) :
            projection.evaluate(projection.modes_at(places),
                                projection.coefficients(ratios(own)));

        std::vector<MaterialState> result(ratio.size());
        for (unsigned int q = 0; q < ratio.size(); ++q)
          {
            // The law is undefined where a corner is inverted, even if the
            // quadrature points are not.
            if (Law::finite_strain && !(there[q].J > 0 && ratio[q] > 0))
              {
                result[q] = unknown_state();
                continue;
              }
            const auto state =
              law.template at_deformation<dim>(there[q].gradient, ratio[q]);
            result[q] = material_state<dim>(law, state);
          }
        return result;
      }

    private:
      /** Deformation at all points; false if the element is inverted at any. */
      static bool
      deform(const Values                  &values,
             const std::vector<double>     &u,
             std::vector<Deformation<dim>> &result)
      {
        bool admissible = true;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            result.push_back(
              deformation<dim>(values, q, u, Law::finite_strain));
            admissible &= !Law::finite_strain || result.back().J > 0;
          }
        return admissible;
      }

      static std::vector<double>
      ratios(const std::vector<Deformation<dim>> &deformations)
      {
        std::vector<double> result;
        for (const auto &d : deformations)
          result.push_back(d.J);
        return result;
      }

      /** p at u, linearised about other displacements (see compute()). */
      std::vector<double>
      extrapolate(const Values               &values,
                  const FieldProjection<dim> &projection,
                  const std::vector<double>  &former,
                  const std::vector<double>  &u) const
      {
        std::vector<Deformation<dim>> deformations;
        deform(values, former, deformations);
        const auto ratio = projection.project(ratios(deformations));

        std::vector<double> growth(ratio.size());
        for (unsigned int q = 0; q < growth.size(); ++q)
          for (unsigned int i = 0; i < u.size(); ++i)
            growth[q] += deformations[q].J * (u[i] - former[i]) *
                         (values.shape_grad(i, q) *
                          deformations[q].inverse)[component(values, i)];
        growth = projection.project(growth);

        std::vector<double> result;
        for (unsigned int q = 0; q < ratio.size(); ++q)
          result.push_back(
            slope_of_energy(law.template at_deformation<dim>(
                              deformations[q].gradient, ratio[q]),
                            ratio[q]) +
            law.volumetric_stiffness(ratio[q]) * growth[q]);
        return projection.project(result);
      }

      /** dU/dJ: minus the Cauchy pressure, which is that of the law at small
       * strains. */
      static double
      slope_of_energy(const typename Law::template State<dim, double> &state,
                      const double                                     J)
      {
        return -state.pressure / (Law::finite_strain ? J : 1);
      }

      void
      add_tangent(const Values                                    &values,
                  const double                                     dV,
                  const typename Law::template State<dim, double> &state,
                  const dealii::Tensor<2, dim>                    &s,
                  const double                                     mean,
                  const std::vector<Tensor>                       &gradient,
                  dealii::FullMatrix<double> &tangent) const
      {
        const unsigned int n = gradient.size();
        for (unsigned int j = 0; j < n; ++j)
          {
            const unsigned int b = component(values, j);
            SquareMatrix<dim>  e{};
            for (unsigned int d = 0; d < dim; ++d)
              {
                e[b][d] += 0.5 * gradient[j][d];
                e[d][b] += 0.5 * gradient[j][d];
              }
            const auto   rate = law.template deviatoric_tangent<dim>(state, e);
            const Tensor stress_gradient = s * gradient[j];
            for (unsigned int i = 0; i < n; ++i)
              {
                const unsigned int a     = component(values, i);
                double             value = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  value += rate[a][d] * gradient[i][d];
                if (Law::finite_strain)
                  {
                    value += mean * (gradient[i][a] * gradient[j][b] -
                                     gradient[i][b] * gradient[j][a]);
                    if (a == b)
                      value += gradient[i] * stress_gradient;
                  }
                tangent(i, j) += dV * value;
              }
          }
      }

      /** Volumetric stiffness after static condensation of j and p: B^T M^-1 H
       * M^-1 B with B the moments of dJ and H those of U''. */
      void
      add_projected_tangent(const FieldProjection<dim>       &projection,
                            const std::vector<double>        &ratio,
                            const dealii::FullMatrix<double> &moments,
                            dealii::FullMatrix<double>       &tangent) const
      {
        const unsigned int         n = n_modes;
        dealii::FullMatrix<double> stiffness(n, n), left(n, n), middle(n, n);
        for (unsigned int q = 0; q < ratio.size(); ++q)
          for (unsigned int k = 0; k < n; ++k)
            for (unsigned int l = 0; l < n; ++l)
              stiffness(k, l) +=
                projection.weights[q] * law.volumetric_stiffness(ratio[q]) *
                projection.modes(q, k) * projection.modes(q, l);
        projection.inverse_mass.mmult(left, stiffness);
        left.mmult(middle, projection.inverse_mass);
        tangent.triple_product(middle, moments, moments, true, false);
      }

      const Law          law;
      const unsigned int n_modes;
    };



    template <int dim>
    unsigned int
    n_modes_of(const ReferenceElement kind)
    {
      switch (kind)
        {
          case ReferenceElement::q1_p0_p0:
            return 1;
          case ReferenceElement::q2_p1_p1:
            return dim + 1;
          default:
            return 0;
        }
    }
  } // namespace



  template <int dim>
  std::unique_ptr<const SolidElement<dim>>
  make_solid_element(const Body<dim> &body, const ReferenceElement kind)
  {
    std::unique_ptr<const SolidElement<dim>> result;
    const auto                               find = [&](auto *const law) {
      using Law = std::remove_pointer_t<decltype(law)>;
      if (body.law != Law::name || result != nullptr)
        return;
      std::array<double, Law::parameters.size()> values;
      if (body.material.size() != values.size())
        return;
      std::copy(body.material.begin(), body.material.end(), values.begin());
      if (!Law::accepts(values))
        return;
      if constexpr (Law::is_elastic)
        result = std::make_unique<LawElement<dim, Law>>(Law(values),
                                                        n_modes_of<dim>(kind));
      else if constexpr (Law::is_plastic)
        result =
          std::make_unique<PlasticElement<dim, Law>>(Law(values),
                                                     body,
                                                     n_modes_of<dim>(kind));
    };
    for_each_law(find);
    if (result == nullptr)
      throw InputError(
        "The material '" + body.law + "' in section 'Body " + body.name +
        "' has no finite element reference: elements that move with the "
        "material do not last in a liquid. Compare with a finer run, or set 'Material = neo hookean'.");
    return result;
  }



  template std::unique_ptr<const SolidElement<2>>
  make_solid_element(const Body<2> &, const ReferenceElement);
  template std::unique_ptr<const SolidElement<3>>
  make_solid_element(const Body<3> &, const ReferenceElement);
} // namespace limber
