// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_solid_element_h
#define limber_fem_solid_element_h

#include <deal.II/base/symmetric_tensor.h>

#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <limber/base/law_parameter.h>
#include <limber/problem/problem.h>

#include <memory>
#include <vector>

namespace limber
{
  /** The state of the material at a place in an element. */
  struct MaterialState
  {
    double                        volume_ratio = 1;  // J, of the element's kind
    double                        pressure     = 0;  // Cauchy, Pa
    dealii::SymmetricTensor<2, 3> stress;            // Cauchy, Pa
    double                        strain_energy = 0; // per start volume, J/m^3
    // those of the law that the scene may name
    std::array<double, max_variables> variables{};
  };



  /**
   * A total Lagrangian element of a solid, with one field (Q1, Q2) or three
   * (mixed): displacement u, volume ratio j and its conjugate p, the latter two
   * polynomials within the element and eliminated there by static condensation
   * (Simo, Taylor and Pister 1985),
   *
   *   Pi = int W_dev(F) + U(j) + p (J(F) - j) dV.
   *
   * An elastoplastic law has no such energy, but the same stationarity in each
   * step; its points store the state at the end of the step before.
   *
   * Stationarity makes j the L2 projection of J(F), and p that of U'(j). So the
   * element without the two fields is the one whose projection is the identity,
   * and both are computed by the same lines. theory/reference.md.
   */
  template <int dim>
  class SolidElement
  {
  public:
    using Values = dealii::FEValues<dim>;

    virtual ~SolidElement() = default;

    /**
     * Internal forces at the nodal displacements @p u, N, and, where @p tangent
     * is not null, their derivative (tangent stiffness), N/m. False where the
     * element is inverted; the results are then of no use. All in the numbering
     * of the degrees of freedom of a cell; @p values has shape gradients,
     * places and weights of the initial configuration.
     *
     * With @p former displacements, those of the iterate before, p in the
     * tangent is the one that they and their linearisation lead to, instead of
     * the one at @p u. Near incompressibility the two differ by much, and
     * Newton's method converges from further away (mixed integration points:
     * Magisano, Leonetti and Garcea, Int. J. Numer. Methods Eng. 2017).
     */
    virtual bool
    compute(const Values               &values,
            const std::vector<double>  &u,
            dealii::Vector<double>     &forces,
            dealii::FullMatrix<double> *tangent,
            const std::vector<double>  *former = nullptr,
            const double               *memory = nullptr) const = 0;

    /**
     * States at the points of @p places from the fields of the element, which
     * the points of @p values determine. Both may be the same. With plasticity
     * they are those stored in @p memory, interpolated by the polynomial
     * through the quadrature points.
     */
    virtual std::vector<MaterialState>
    states(const Values              &values,
           const Values              &places,
           const std::vector<double> &u,
           const double              *memory = nullptr) const = 0;

    /** Number of history values of a quadrature point; elastic: none. */
    virtual unsigned int
    n_memory() const
    {
      return 0;
    }

    /** Initial history values of the points of @p values. */
    virtual void
    begin(const Values & /*values*/, double * /*memory*/) const
    {}

    /** Updates the history values in @p memory to the displacements @p u, at
     * which compute() has succeeded. Returns the plastic work, J. */
    virtual double
    accept(const Values & /*values*/,
           const std::vector<double> & /*u*/,
           double * /*memory*/) const
    {
      return 0;
    }

    /** Whether the derivative of the forces is symmetric. */
    virtual bool
    has_symmetric_tangent() const
    {
      return true;
    }

    /** Whether equilibrium is that of the deformed body. */
    bool finite_strain = true;

    /** rho, kg/m^3, and wave speeds at rest, m/s. */
    double density = 0, pressure_wave_speed = 0, shear_wave_speed = 0;
  };



  /** The element of a scene. Throws InputError where the law of the body is
   * that of a liquid, or depends on the rate. */
  template <int dim>
  std::unique_ptr<const SolidElement<dim>>
  make_solid_element(const Body<dim> &body, const ReferenceElement kind);
} // namespace limber

#endif
