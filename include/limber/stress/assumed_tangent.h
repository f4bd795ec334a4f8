// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_assumed_tangent_h
#define limber_stress_assumed_tangent_h

#include <limber/stress/assumed_trial.h>

#include <vector>

namespace limber
{
  /**
   * The second derivative of the energy of an AssumedTrial by the nodal
   * displacements: of the law, in 'add_material', and of F_a and J_a, in
   * 'add_turning' and 'add_volume'.
   */
  template <int dim, bool finite_strain>
  class AssumedTangent : public AssumedTrial<dim, finite_strain>
  {
    using Trial = AssumedTrial<dim, finite_strain>;

  public:
    using Trial::deformation;
    using Trial::n_dofs;
    using Trial::n_nodes;
    using Trial::n_spins;
    using Trial::points;
    using Trial::volume_ratio;
    using typename Trial::Axis;
    using typename Trial::Matrix;
    using typename Trial::Stress;

    /** What it takes of the volume ratio at finite strain, Pa: derivatives of
     * dW/dJ_a by J_a and by displacement gradients in the present configuration
     * of the point, and of the Kirchhoff stress by J_a. */
    struct VolumeRates
    {
      double curvature = 0;
      Matrix by_strain{}, of_stress{};
    };

    /**
     * Add the tangent with respect to nodal displacements, n_dofs rows. @p
     * moduli (p, d, e, f, g) is the derivative of the Kirchhoff stress (d, e),
     * work conjugate to gradients, by the displacement gradient (f, g) in the
     * present configuration of the point, at finite strain with J_a fixed.
     */
    template <class Moduli>
    void
    add_tangent(const std::vector<Stress>      &stress,
                const Moduli                   &moduli,
                const std::vector<VolumeRates> &rates,
                double *const                   tangent)
    {
      meet(stress);
      vary();
      for (std::size_t p = 0; p < points.size(); ++p)
        add_material(p, moduli, rates[p], tangent);
      if constexpr (finite_strain)
        {
          add_turning(tangent);
          add_volume(stress, tangent);
        }
    }

  private:
    using Trial::assume;
    using Trial::back;
    using Trial::contract;
    using Trial::divided;
    using Trial::means_of;
    using Trial::meet;
    using Trial::of_volume;
    using Trial::operation;
    using Trial::pull;
    using Trial::pull_of_spins;
    using Trial::spin;
    using Trial::stress_of_mean;
    using Trial::trace;
    using Trial::turned;
    using Trial::volume;
    using typename Trial::Means;

    /** R^T dF of a point for a unit displacement of degree of freedom k. */
    Matrix
    turned_back(const std::size_t p, const int k) const
    {
      Matrix result;
      for (int c = 0; c < dim; ++c)
        for (int e = 0; e < dim; ++e)
          result[c][e] = component_of(k, c) * points[p].gradient[k / dim][e];
      return result;
    }

    /** Component c of R^T times the direction of degree of freedom k. */
    double
    component_of(const int k, const int c) const
    {
      if constexpr (finite_strain)
        return operation->rotation[k % dim][c];
      else
        return c == k % dim;
    }

    /** Derivatives of mean, spin and A G by each degree of freedom. */
    void
    vary()
    {
      turning.resize(n_spins * points.size());
      for (int a = 0; a < n_spins; ++a)
        {
          const auto spun = [&](const std::size_t p) {
            return times<dim>(spin(a), operation->turned_back(points[p].F));
          };
          const Means means = means_of(spun);
          for (std::size_t p = 0; p < points.size(); ++p)
            turning[a * points.size() + p] = assume(spun(p), means, p);
        }
      changes.clear();
      for (int a = 0; a < n_spins; ++a)
        for (std::size_t p = 0; p < points.size(); ++p)
          changes.push_back(change_by_spin(a, p));

      varied.resize(n_dofs * points.size());
      own.resize(n_dofs * points.size());
      traces.resize(n_dofs * points.size());
      // unit displacements along each direction: R^T dF is a product of this
      // row of R and the gradient of the node, and so are its means
      std::array<Means, n_nodes> of_nodes{};
      for (int i = 0; i < n_nodes; ++i)
        of_nodes[i] = means_of([&](const std::size_t p) {
          Matrix rows;
          for (int d = 0; d < dim; ++d)
            rows[d] = points[p].gradient[i];
          return rows;
        });
      for (int k = 0; k < n_dofs; ++k)
        {
          Means means;
          for (int c = 0; c < dim; ++c)
            for (int e = 0; e < dim; ++e)
              {
                const double component = component_of(k, c);
                const Means &of_node   = of_nodes[k / dim];
                means.mean[c][e]       = component * of_node.mean[c][e];
                means.torsion[c][e]    = component * of_node.torsion[c][e];
                means.bending[c][e]    = component * of_node.bending[c][e];
              }
          mean[k] = means.mean;
          if constexpr (finite_strain)
            {
              Axis axis;
              for (int a = 0; a < n_spins; ++a)
                axis[a] = contract(spin(a), mean[k]);
              axes[k]        = divided(axis);
              mean_change[k] = change_of_stretch(k);
              change_of_volume[k] =
                contract(cofactor<dim>(operation->stretch), mean_change[k]);
            }
          for (std::size_t p = 0; p < points.size(); ++p)
            {
              Matrix &total              = varied[k * points.size() + p];
              total                      = assume(turned_back(p, k), means, p);
              own[k * points.size() + p] = total;
              double &change_of_trace    = traces[k * points.size() + p];
              change_of_trace            = trace(total);
              for (int a = 0; a < n_spins; ++a)
                {
                  change_of_trace -=
                    axes[k][a] * trace(turning[a * points.size() + p]);
                  const Matrix &change = changes[a * points.size() + p];
                  for (int d = 0; d < dim; ++d)
                    for (int e = 0; e < dim; ++e)
                      total[d][e] += axes[k][a] * change[d][e];
                }
            }
        }
    }

    /** S_a A(G) - A(S_a G) */
    Matrix
    change_by_spin(const int a, const std::size_t p) const
    {
      Matrix result =
        times<dim>(spin(a), operation->turned_back(deformation(p)));
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result[d][e] -= turning[a * points.size() + p][d][e];
      return result;
    }

    // Second derivative of the energy by F_a and J_a
    template <class Moduli>
    void
    add_material(const std::size_t  p,
                 const Moduli      &moduli,
                 const VolumeRates &rates,
                 double *const      tangent) const
    {
      // the variation of F_a as a gradient in the present configuration
      std::array<Matrix, n_dofs> gradient;
      for (int k = 0; k < n_dofs; ++k)
        {
          gradient[k] = operation->turned(varied[k * points.size() + p]);
          if constexpr (finite_strain)
            gradient[k] = times_inverse<dim>(gradient[k], deformation(p));
        }
      for (int k = 0; k < n_dofs; ++k)
        {
          Matrix row{};
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              for (int f = 0; f < dim; ++f)
                for (int g = 0; g < dim; ++g)
                  row[f][g] += gradient[k][d][e] * moduli(p, d, e, f, g);
          for (int l = 0; l < n_dofs; ++l)
            tangent[k * n_dofs + l] +=
              points[p].volume * contract(row, gradient[l]);
        }
      if constexpr (finite_strain)
        {
          const double ratio = volume_ratio(p) / operation->volume;
          std::array<double, n_dofs> change, stress, slope;
          for (int k = 0; k < n_dofs; ++k)
            {
              change[k] = operation->volume * (traces[k * points.size() + p] -
                                               trace(mean_change[k])) +
                          ratio * change_of_volume[k];
              stress[k] = contract(rates.of_stress, gradient[k]);
              slope[k]  = contract(rates.by_strain, gradient[k]) +
                         rates.curvature * change[k];
            }
          for (int k = 0; k < n_dofs; ++k)
            for (int l = 0; l < n_dofs; ++l)
              tangent[k * n_dofs + l] +=
                points[p].volume *
                (change[k] * slope[l] + stress[k] * change[l]);
        }
    }

    // The stress of the volume ratio times the second derivative of J_a, but
    // for that of A G and U, which is in add_turning(). With u = delta U, c =
    // cof U : u and b = delta(A G), by primes with l, it is
    //   c' tr(b) + c tr(b') - c tr(u') - c' tr(u)
    //   + (1 + tr X) (d cof U / dU : u') : u.
    void
    add_volume(const std::vector<Stress> &stress, double *const tangent) const
    {
      std::array<double, n_dofs> sums{};
      for (int k = 0; k < n_dofs; ++k)
        for (std::size_t p = 0; p < points.size(); ++p)
          sums[k] += points[p].volume * stress[p].of_volume *
                     (traces[k * points.size() + p] - trace(mean_change[k]));
      for (int l = 0; l < n_dofs; ++l)
        {
          const Matrix area =
            change_of_cofactor(operation->stretch, mean_change[l]);
          for (int k = 0; k < n_dofs; ++k)
            tangent[k * n_dofs + l] +=
              change_of_volume[l] * sums[k] + change_of_volume[k] * sums[l] +
              of_volume[1] * contract(area, mean_change[k]);
        }
    }

    /** The change of cof(a) with b, linear in b. */
    static Matrix
    change_of_cofactor(const Matrix &a, const Matrix &b)
    {
      Matrix result = cofactor<dim>(b);
      if constexpr (dim == 3)
        {
          Matrix both = a;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              both[d][e] += b[d][e];
          const Matrix of_both = cofactor<dim>(both), of_a = cofactor<dim>(a);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              result[d][e] = of_both[d][e] - of_a[d][e] - result[d][e];
        }
      return result;
    }

    // Geometric stiffness, the stress times the second derivative of F_a: with
    // spins S and T by k and l, primes for what belongs to l,
    //   R^T dW/dF_a : [T delta(A G) + S (A(g') - A(T G))]
    //   - Q : [T g + S (g' - T G)] - M : [T <g> + S (<g'> - T U)] - dS' t,
    // where the axial vector of the spin changes by
    //   H dw' = axis(-T <g>) - dH' w,   dH' = tr(dU') 1 - dU',
    //   dU' = <g'> - T U.
    void
    add_turning(double *const tangent) const
    {
      std::array<Axis, n_dofs> by_spin{};
      std::array<Axis, 3>      by_spins{};
      for (std::size_t p = 0; p < points.size(); ++p)
        for (int b = 0; b < n_spins; ++b)
          {
            // P^ : S_b X = S_b^T P^ : X
            const Matrix stress = transpose_times<dim>(spin(b), turned[p]),
                         given  = transpose_times<dim>(spin(b), back[p]);
            const double V      = points[p].volume;
            const Matrix force  = operation->turned(given);
            for (int k = 0; k < n_dofs; ++k)
              {
                double sum = contract(stress, own[k * points.size() + p]);
                for (int e = 0; e < dim; ++e)
                  sum -= force[k % dim][e] * points[p].gradient[k / dim][e];
                by_spin[k][b] += V * sum;
              }
            for (int a = 0; a < n_spins; ++a)
              {
                by_spins[a][b] +=
                  V * contract(stress, changes[a * points.size() + p]);
                by_spins[b][a] +=
                  V *
                  (contract(given,
                            times<dim>(spin(a),
                                       operation->turned_back(points[p].F))) -
                   contract(stress, turning[a * points.size() + p]));
              }
          }

      for (int b = 0; b < n_spins; ++b)
        {
          const Matrix given = transpose_times<dim>(spin(b), stress_of_mean);
          for (int k = 0; k < n_dofs; ++k)
            by_spin[k][b] -= contract(given, mean[k]);
          for (int a = 0; a < n_spins; ++a)
            by_spins[b][a] +=
              contract(given, times<dim>(spin(a), operation->stretch));
        }

      const Matrix             puller = pull_of_spins();
      std::array<Axis, n_dofs> by_axis{};
      for (int k = 0; k < n_dofs; ++k)
        for (int b = 0; b < n_spins; ++b)
          by_axis[k][b] = contract(puller, times<dim>(spin(b), mean[k]));

      for (int l = 0; l < n_dofs; ++l)
        {
          const auto turn = change_of_inertia(l);
          for (int k = 0; k < n_dofs; ++k)
            {
              double entry = 0;
              for (int a = 0; a < n_spins; ++a)
                {
                  entry += axes[l][a] * (by_spin[k][a] + by_axis[k][a]) +
                           axes[k][a] * (by_spin[l][a] + turn[a]);
                  for (int b = 0; b < n_spins; ++b)
                    entry += axes[k][a] * by_spins[a][b] * axes[l][b];
                }
              tangent[k * n_dofs + l] += entry;
            }
        }
    }

    /** delta U = <g> - S U by degree of freedom k. */
    Matrix
    change_of_stretch(const int k) const
    {
      Matrix result = mean[k];
      for (int a = 0; a < n_spins; ++a)
        {
          const Matrix turned = times<dim>(spin(a), operation->stretch);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              result[d][e] -= axes[k][a] * turned[d][e];
        }
      return result;
    }

    /** H^-1 t times the derivative of H by degree of freedom l. */
    Axis
    change_of_inertia(const int l) const
    {
      const Matrix &stretch         = mean_change[l];
      const double  trace_of_change = trace(stretch);
      Axis          result;
      for (int a = 0; a < n_spins; ++a)
        {
          result[a] = trace_of_change * pull[a];
          if constexpr (dim == 3)
            for (int b = 0; b < n_spins; ++b)
              result[a] -= stretch[a][b] * pull[b];
        }
      return result;
    }

    // By degree of freedom: mean of g, axial vector of the spin; for each point
    // A(g) and the variation of A G
    std::array<Matrix, n_dofs> mean;
    std::array<Axis, n_dofs>   axes{};
    std::vector<Matrix>        own, varied;
    std::vector<double>        traces; // of the variation of A G alone
    // Of U, and of det U
    std::array<Matrix, n_dofs> mean_change;
    std::array<double, n_dofs> change_of_volume{};
    std::vector<Matrix>        turning; // A(S_a G)
    std::vector<Matrix>        changes; // S_a A(G) - A(S_a G)
  };
} // namespace limber

#endif
