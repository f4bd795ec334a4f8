// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_assumed_trial_h
#define limber_stress_assumed_trial_h

#include <limber/interpolation/assumed_deformation.h>

#include <optional>
#include <vector>

namespace limber
{
  /**
   * The assumed strain of the points of a cell in a trial
   * (assumed_deformation.h), and what Newton's method needs of it: first and
   * second derivative of the energy sum V W(F_a) by the nodal displacements.
   * Rotated back with the cell, G = R^T F and A G = R^T F_a vary by
   *
   *   delta (A G) = A(g) + S A(G) - A(S G),   g = R^T delta F,
   *
   * where S = R^T delta R is the spin with the axial vector H^-1 axis(<g>),
   * H = tr(U) 1 - U. With P^, Q = A P^, M of assumed_deformation.h and the
   * torque t_a = sum V Q : S_a G + M : S_a U about each axis a, the force is
   * sum V Q : g + M : <g> minus the axial vector of the spin times t, since
   * dW/dF_a : R S A(G) = 0 by symmetry of the stress. The second derivatives
   * of F_a and J_a are in 'add_turning' and 'add_volume'.
   *
   * Degrees of freedom node by node, as in CellResponse.
   */
  template <int dim, bool finite_strain>
  class AssumedTrial
  {
  public:
    static constexpr int n_nodes = 1 << dim;
    static constexpr int n_dofs  = dim * n_nodes;
    static constexpr int n_spins = !finite_strain ? 0 : dim == 2 ? 1 : 3;
    using Vector                 = std::array<double, dim>;
    using Matrix                 = SmallMatrix<dim, double>;
    using Gradients              = std::array<Vector, n_nodes>;
    // In 2d only the first counts: GCC 12 loses sums in arrays of one
    using Axis = std::array<double, 3>;

    /** Input of a point: its own F, position and volume. */
    struct Point
    {
      Matrix    F;
      Vector    xi;       // natural coordinates in the cell
      double    volume;   // at the start, m^dim
      Gradients gradient; // of the functions, 1/m
    };

    std::vector<Point> points;

    /** Stress of a point: dW/dF_a with the volume ratio J_a fixed, and at
     * finite strain dW/dJ_a, Pa; for small strain the former is all. */
    struct Stress
    {
      Matrix of_deformation;
      double of_volume = 0;
    };

    /** What it takes of the volume ratio at finite strain, Pa: derivatives of
     * dW/dJ_a by J_a and by displacement gradients in the present configuration
     * of the point, and of the Kirchhoff stress by J_a. */
    struct VolumeRates
    {
      double curvature = 0;
      Matrix by_strain{}, of_stress{};
    };

    /**
     * After all points were set; false if the mean F of the cell is inverted.
     */
    bool
    finish(const StrainTreatment &treatment)
    {
      operation.emplace(treatment);
      volume = 0;
      for (const Point &point : points)
        {
          operation->add(point.F, point.xi, point.volume);
          volume += point.volume;
        }
      operation->finish();
      if constexpr (!finite_strain)
        return true;
      else
        return determinant<dim>(operation->rotation) > 0;
    }

    /** F_a */
    Matrix
    deformation(const std::size_t p) const
    {
      return operation->turned(operation->evaluate(points[p].F, points[p].xi));
    }

    /** J_a */
    double
    volume_ratio(const std::size_t p) const
    {
      return operation->volume_ratio(
        operation->evaluate(points[p].F, points[p].xi));
    }

    /** The derivatives of J_a of the points in the direction of changes of
     * their F. */
    std::vector<double>
    change_of_volume_ratios(const std::vector<Matrix> &change)
    {
      static_assert(finite_strain);
      const Matrix &U       = operation->stretch;
      const auto    back_by = [&](const std::size_t p) {
        return operation->turned_back(change[p]);
      };
      const Means means = means_of(back_by);
      invert_inertia();
      Axis axis{};
      for (int a = 0; a < n_spins; ++a)
        axis[a] = contract(spin(a), means.first);
      axis = divided(axis);
      Matrix S{};
      for (int a = 0; a < n_spins; ++a)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            S[d][e] += axis[a] * spin(a)[d][e];

      // of A G and U, but for the turn of A G
      const auto moved = [&](const std::size_t p) {
        Matrix       result = back_by(p);
        const Matrix spun = times<dim>(S, operation->turned_back(points[p].F));
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            result[d][e] -= spun[d][e];
        return result;
      };
      const Means         means_moved = means_of(moved);
      const Matrix        of_stretch  = means_moved.first; // <g> - S U
      const double        of_volume   = contract(cofactor<dim>(U), of_stretch);
      std::vector<double> result(points.size());
      for (std::size_t p = 0; p < points.size(); ++p)
        result[p] =
          operation->volume *
            (trace(assume(moved(p), means_moved, p)) - trace(of_stretch)) +
          volume_ratio(p) / operation->volume * of_volume;
      return result;
    }

    /** Add the nodal force (N) of the stress of the points. */
    void
    add_force(const std::vector<Stress> &stress, double *const force)
    {
      meet(stress);
      Gradients mean_gradient{};
      for (std::size_t p = 0; p < points.size(); ++p)
        {
          const Matrix Q = operation->turned(back[p]);
          for (int i = 0; i < n_nodes; ++i)
            for (int d = 0; d < dim; ++d)
              {
                const auto &gradient = points[p].gradient[i];
                double      sum      = 0;
                for (int e = 0; e < dim; ++e)
                  sum += Q[d][e] * gradient[e];
                force[i * dim + d] += points[p].volume * sum;
                mean_gradient[i][d] += points[p].volume / volume * gradient[d];
              }
        }
      if constexpr (finite_strain)
        {
          Matrix of_mean = pull_of_spins();
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              of_mean[d][e] = stress_of_mean[d][e] - of_mean[d][e];
          of_mean = operation->turned(of_mean);
          for (int i = 0; i < n_nodes; ++i)
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                force[i * dim + d] += of_mean[d][e] * mean_gradient[i][e];
        }
    }

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
    using Means = std::pair<Matrix, Matrix>; // mean and, in 3d, torsion

    static double
    contract(const Matrix &a, const Matrix &b)
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result += a[d][e] * b[d][e];
      return result;
    }

    /** The spin about axis a; S_a : X is twice the axial vector of X. */
    static Matrix
    spin(const int a)
    {
      Matrix result{};
      if constexpr (dim == 2)
        {
          result[1][0] = 1;
          result[0][1] = -1;
        }
      else
        {
          const int b = (a + 1) % 3, c = (a + 2) % 3;
          result[c][b] = 1;
          result[b][c] = -1;
        }
      return result;
    }

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

    /** Means of a field over the points, field(p). */
    template <class Field>
    Means
    means_of(const Field &field) const
    {
      Means result{};
      for (std::size_t p = 0; p < points.size(); ++p)
        {
          const Matrix X = field(p);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              {
                const double share = points[p].volume / volume * X[d][e];
                result.first[d][e] += share;
                if constexpr (dim == 3)
                  if (d != e)
                    {
                      const int f = 3 - d - e;
                      result.second[d][e] +=
                        share * (points[p].xi[f] - operation->centroid[f]) *
                        operation->inverse_variance[f];
                    }
              }
        }
      return result;
    }

    /** (A X)_p */
    Matrix
    assume(const Matrix &X, const Means &means, const std::size_t p) const
    {
      return operation->assume(X, means.first, means.second, points[p].xi);
    }

    /** The spins about all axes, each times its pull. */
    Matrix
    pull_of_spins() const
    {
      Matrix result{};
      for (int a = 0; a < n_spins; ++a)
        {
          const Matrix S = spin(a);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              result[d][e] += pull[a] * S[d][e];
        }
      return result;
    }

    /** Rotated stress P^, Q = A P^, M, and H^-1 times the torque. */
    void
    meet(const std::vector<Stress> &stress)
    {
      turned.resize(points.size());
      back.resize(points.size());
      of_volume = {};
      for (std::size_t p = 0; p < points.size(); ++p)
        {
          turned[p] = operation->turned_back(stress[p].of_deformation);
          back[p]   = turned[p];
          if constexpr (finite_strain)
            {
              const double share = points[p].volume * stress[p].of_volume;
              of_volume[0] += share;
              of_volume[1] += share * volume_ratio(p) / operation->volume;
              for (int d = 0; d < dim; ++d)
                back[p][d][d] += stress[p].of_volume * operation->volume;
            }
        }
      if constexpr (finite_strain)
        {
          stress_of_mean = cofactor<dim>(operation->stretch);
          for (int d = 0; d < dim; ++d)
            {
              for (int e = 0; e < dim; ++e)
                stress_of_mean[d][e] *= of_volume[1];
              stress_of_mean[d][d] -= of_volume[0] * operation->volume;
            }
        }
      const Means means =
        means_of([&](const std::size_t p) { return back[p]; });
      for (std::size_t p = 0; p < points.size(); ++p)
        back[p] = assume(back[p], means, p);
      if constexpr (finite_strain)
        {
          invert_inertia();
          Axis torque{};
          for (int a = 0; a < n_spins; ++a)
            {
              torque[a] = contract(stress_of_mean,
                                   times<dim>(spin(a), operation->stretch));
              for (std::size_t p = 0; p < points.size(); ++p)
                torque[a] +=
                  points[p].volume *
                  contract(back[p],
                           times<dim>(spin(a),
                                      operation->turned_back(points[p].F)));
            }
          pull = divided(torque);
        }
    }

    // H of the stretch, symmetric
    void
    invert_inertia()
    {
      const Matrix &U = operation->stretch;
      if constexpr (dim == 2)
        inverse[0][0] = 1 / (U[0][0] + U[1][1]);
      else
        {
          Matrix H;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              H[d][e] = (d == e ? U[0][0] + U[1][1] + U[2][2] : 0.) - U[d][e];
          inverse                             = cofactor<dim>(H);
          const double inverse_of_determinant = 1 / determinant<dim>(H);
          for (auto &row : inverse)
            for (double &entry : row)
              entry *= inverse_of_determinant;
        }
    }

    Axis
    divided(const Axis &axis) const
    {
      Axis result{};
      for (int a = 0; a < n_spins; ++a)
        for (int b = 0; b < n_spins; ++b)
          result[a] += inverse[a][b] * axis[b];
      return result;
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
                means.first[c][e]  = component * of_nodes[k / dim].first[c][e];
                means.second[c][e] = component * of_nodes[k / dim].second[c][e];
              }
          mean[k] = means.first;
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

    static double
    trace(const Matrix &a)
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        result += a[d][d];
      return result;
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

    std::optional<AssumedDeformation<dim, finite_strain, double>> operation;
    double                                                        volume = 0;
    std::vector<Matrix> turned, back;     // R^T dW/dF_a and Q of the points
    Matrix              stress_of_mean{}; // M, J
    // Sums of V dW/dJ_a, and times 1 + tr X, J
    std::array<double, 2>  of_volume{};
    SmallMatrix<3, double> inverse{}; // of H
    Axis                   pull{};    // H^-1 t
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
