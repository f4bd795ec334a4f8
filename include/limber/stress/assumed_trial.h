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
   * (assumed_deformation.h), and what Newton's method needs of it: here the
   * first derivative of the energy sum V W(F_a, J_a) by the nodal
   * displacements, in AssumedTangent the second. Rotated back with the cell,
   * G = R^T F and A G = R^T F_a vary by
   *
   *   delta (A G) = A(g) + S A(G) - A(S G),   g = R^T delta F,
   *
   * where S = R^T delta R is the spin with the axial vector H^-1 axis(<g>),
   * H = tr(U) 1 - U. With P^, Q = A P^, M of assumed_deformation.h and the
   * torque t_a = sum V Q : S_a G + M : S_a U about each axis a, the force is
   * sum V Q : g + M : <g> minus the axial vector of the spin times t, since
   * dW/dF_a : R S A(G) = 0 by symmetry of the stress.
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
        axis[a] = contract(spin(a), means.mean);
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
      const Matrix        of_stretch  = means_moved.mean; // <g> - S U
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

  protected:
    using Operation = AssumedDeformation<dim, finite_strain, double>;
    using Means     = typename Operation::Means;

    static double
    contract(const Matrix &a, const Matrix &b)
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result += a[d][e] * b[d][e];
      return result;
    }

    static double
    trace(const Matrix &a)
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        result += a[d][d];
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
                result.mean[d][e] += share;
                if constexpr (dim == 3)
                  {
                    const auto along = [&](const int f) {
                      return share *
                             (points[p].xi[f] - operation->centroid[f]) *
                             operation->inverse_variance[f];
                    };
                    if (d != e)
                      result.torsion[d][e] += along(3 - d - e);
                    else
                      for (int f = 0; f < dim; ++f)
                        result.bending[d][f] += along(f);
                  }
              }
        }
      return result;
    }

    /** (A X)_p */
    Matrix
    assume(const Matrix &X, const Means &means, const std::size_t p) const
    {
      return operation->assume(X, means, points[p].xi);
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

    std::optional<Operation> operation;
    double                   volume = 0;
    std::vector<Matrix>      turned, back; // R^T dW/dF_a and Q of the points
    Matrix                   stress_of_mean{}; // M, J
    // Sums of V dW/dJ_a, and times 1 + tr X, J
    std::array<double, 2>  of_volume{};
    SmallMatrix<3, double> inverse{}; // of H
    Axis                   pull{};    // H^-1 t
  };
} // namespace limber

#endif
