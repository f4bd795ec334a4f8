// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/initial_frame_sweep.h>

#include <gtest/gtest.h>
#include <support/sample_laws.h>
#include <support/treatments.h>

#include <cmath>
#include <functional>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class LawType,
            int        dimension,
            Treatment  treatment_kind,
            KernelKind kernel_kind = KernelKind::linear>
  struct FrameCase
  {
    using Law                          = LawType;
    static constexpr int        dim    = dimension;
    static constexpr Treatment  kind   = treatment_kind;
    static constexpr KernelKind kernel = kernel_kind;
  };



  /** Points in some cells, sorted, at rest in their initial frame. */
  template <class Case>
  class InitialFrame : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Law                = typename Case::Law;
    using Layout             = NodeLayout<dim>;
    using Grid               = SmallGrid<dim, Case::kernel>;
    using Sweep = InitialFrameSweep<typename Grid::Basis, Law, Case::kind>;

    InitialFrame()
      : cell_of_point(some_cells())
      , own(cell_of_point.size(),
            true,
            Law::template n_history<dim>,
            Law::volumetric,
            false)
      , deformation(dim * dim,
                    std::vector<double>(own.size + SmallPoints<dim>::room))
      , places(dim, std::vector<double>(own.size + SmallPoints<dim>::room))
      , law(samples<Law>().front())
      , sweep(law, bending(law))
    {
      std::copy(cell_of_point.begin(), cell_of_point.end(), own.cell.begin());
      const auto points = view();
      for (std::size_t p = 0; p < own.size; ++p)
        {
          const auto &cell = grid.cells[cell_of_point[p]];
          for (int d = 0; d < dim; ++d)
            {
              points.position[d][p] = points.place[d][p] =
                cell.origin[d] + grid.edge[d] * random(0, 1);
              points.deformation[d * (dim + 1)][p] = 1;
            }
          points.mass[p] = random(0.5, 2);
          sweep.initialise(points, p, {});
        }
    }

    PointView<dim>
    view()
    {
      auto result = own.view();
      for (int k = 0; k < dim * dim; ++k)
        result.deformation[k] = deformation[k].data();
      for (int d = 0; d < dim; ++d)
        result.place[d] = places[d].data();
      return result;
    }

    /** The nodes get that velocity, and the points follow for a time. */
    void
    move(const std::function<Vector<dim>(std::size_t)> &velocity,
         const double                                   step)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          grid.nodes[n * Layout::stride + Layout::strain_velocity + d] =
            velocity(n)[d];
      StressSweep what;
      what.step = step;
      sweep.update(view(), grid.view(), nullptr, what);
    }

    void
    move_linearly(const Matrix<dim> &A, const double step)
    {
      move(
        [&](const std::size_t n) {
          Vector<dim> v{};
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              v[d] += A[d][e] * grid.place(n)[e];
          return v;
        },
        step);
    }

    /** Internal forces of all nodes; dim numbers each. */
    std::vector<double>
    forces()
    {
      grid.clear();
      return forces_after(0);
    }

    /** The same when points have followed the nodes for a time before. */
    std::vector<double>
    forces_after(const double step)
    {
      StressSweep what;
      what.step       = step;
      what.give_force = true;
      sweep.update(view(), grid.view(), nullptr, what);
      std::vector<double> result;
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          result.push_back(grid.nodes[n * Layout::stride + Layout::force + d]);
      return result;
    }

    // a small strain law is linear in whatever F is
    static constexpr double amplitude = Law::finite_strain ? 0.03 : 1;

    Random                           random;
    Grid                             grid;
    std::vector<std::uint32_t>       cell_of_point;
    SmallPoints<dim>                 own;
    std::vector<std::vector<double>> deformation, places;
    const Law                        law;
    const Sweep                      sweep;

  private:
    /** (e1, e2) of theory/treatments.md for a beam that bends. */
    static StrainTreatment
    bending(const Law &law)
    {
      const double    K = law.bulk_modulus, G = law.shear_modulus;
      const double    nu     = (3 * K - 2 * G) / (2 * (3 * K + G));
      StrainTreatment result = strain_treatment_of(Case::kind);
      result.own             = 1;
      result.mate            = -nu / (1 - nu);
      result.trilinear_own   = 1;
      result.trilinear_mate  = -nu;
      return result;
    }

    std::vector<std::uint32_t>
    some_cells()
    {
      std::vector<std::uint32_t> result;
      for (std::uint32_t c = 0; c < grid.n_cells; ++c)
        if (random.below(3) > 0)
          result.insert(result.end(), 1 + random.below(6 << dim), c);
      return result;
    }
  };

  template <class Law, int dim, Treatment kind>
  using OnSplines = FrameCase<Law, dim, kind, KernelKind::quadratic>;

  template <class Law, int dim, Treatment kind>
  using OnCubics = FrameCase<Law, dim, kind, KernelKind::cubic>;

  using Cases =
    testing::Types<FrameCase<LinearElastic, 2, Treatment::none>,
                   FrameCase<LinearElastic, 2, Treatment::cell>,
                   FrameCase<LinearElastic, 2, Treatment::assumed_strain>,
                   FrameCase<LinearElastic, 3, Treatment::none>,
                   FrameCase<LinearElastic, 3, Treatment::cell>,
                   FrameCase<LinearElastic, 3, Treatment::assumed_strain>,
                   FrameCase<NeoHookean, 2, Treatment::none>,
                   FrameCase<NeoHookean, 2, Treatment::cell>,
                   FrameCase<NeoHookean, 2, Treatment::assumed_strain>,
                   FrameCase<NeoHookean, 3, Treatment::none>,
                   FrameCase<NeoHookean, 3, Treatment::cell>,
                   FrameCase<NeoHookean, 3, Treatment::assumed_strain>,
                   OnSplines<LinearElastic, 2, Treatment::none>,
                   OnSplines<LinearElastic, 3, Treatment::cell>,
                   OnSplines<NeoHookean, 2, Treatment::none>,
                   OnSplines<NeoHookean, 2, Treatment::cell>,
                   OnSplines<NeoHookean, 3, Treatment::none>,
                   OnSplines<NeoHookean, 3, Treatment::cell>,
                   OnCubics<LinearElastic, 2, Treatment::cell>,
                   OnCubics<NeoHookean, 2, Treatment::none>,
                   OnCubics<NeoHookean, 3, Treatment::none>,
                   OnCubics<NeoHookean, 3, Treatment::cell>>;
  TYPED_TEST_SUITE(InitialFrame, Cases);
} // namespace



// Forces are minus the derivative of the energy with respect to the places of
// the nodes, in any deformation, also where the volumetric part is averaged.
TYPED_TEST(InitialFrame, ForcesAreTheDerivativeOfTheEnergy)
{
  constexpr int            dim  = TestFixture::dim;
  const double             size = this->amplitude;
  std::vector<Vector<dim>> there(this->grid.n_nodes), change(there.size());
  for (auto &v : there)
    for (double &x : v)
      x = this->random();
  for (auto &v : change)
    for (double &x : v)
      x = this->random();
  this->move([&](const std::size_t n) { return there[n]; }, size);
  const auto forces = this->forces();
  double     power = 0, scale = 0;
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    for (int d = 0; d < dim; ++d)
      {
        power -= forces[n * dim + d] * change[n][d];
        scale += std::abs(forces[n * dim + d] * change[n][d]);
      }

  const auto energy_after = [&](const double step) {
    this->move([&](const std::size_t n) { return change[n]; }, step);
    return this->sweep.summarize(this->view()).strain_energy;
  };
  const double h     = 1e-5 * size;
  const double later = energy_after(h), earlier = energy_after(-2 * h);
  ASSERT_GT(scale, 0);
  EXPECT_NEAR((later - earlier) / (2 * h), power, 1e-7 * scale);
}



// One sweep strains and gives the forces of what it has come to.
TYPED_TEST(InitialFrame, ForcesAreThoseOfTheNewStress)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  std::vector<Vector<dim>> there(this->grid.n_nodes);
  for (auto &v : there)
    for (double &x : v)
      x = this->random();
  const double size = this->amplitude;
  this->move([&](const std::size_t n) { return there[n]; }, size);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    for (int d = 0; d < dim; ++d)
      this->grid.nodes[n * Layout::stride + Layout::force + d] = 0;
  const auto at_once   = this->forces_after(size);
  const auto afterward = this->forces();
  double     largest   = 0;
  for (const double force : afterward)
    largest = std::max(largest, std::abs(force));
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < at_once.size(); ++i)
    ASSERT_NEAR(at_once[i], afterward[i], 1e-14 * largest);
}



TYPED_TEST(InitialFrame, StressFollowsFromAHomogeneousDeformation)
{
  constexpr int dim   = TestFixture::dim;
  using Law           = typename TestFixture::Law;
  const Matrix<dim> A = this->random.template matrix<dim>(0.2);
  for (int i = 0; i < 5; ++i)
    this->move_linearly(A, 0.2);

  Matrix<dim> F = A;
  for (int d = 0; d < dim; ++d)
    F[d][d] += 1;
  double J = 1;
  if (Law::finite_strain)
    J = determinant<dim>(F);
  else
    for (int d = 0; d < dim; ++d)
      J += A[d][d];
  const auto   state  = this->law.template at_deformation<dim>(F, J);
  const double scale  = this->law.bulk_modulus;
  const auto   points = this->view();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      ASSERT_NEAR(points.pressure[p], state.pressure, 1e-13 * scale);
      for (std::size_t k = 0; k < state.deviator.size(); ++k)
        ASSERT_NEAR(points.deviator[k][p], state.deviator[k], 1e-13 * scale);
      for (int d = 0; d < dim; ++d)
        {
          double x = points.place[d][p];
          for (int e = 0; e < dim; ++e)
            x += A[d][e] * points.place[e][p];
          ASSERT_NEAR(points.position[d][p], x, 1e-13);
        }
    }
}



// A body that is turned in one step, by any angle where strain is finite, has
// neither stress nor forces.
TYPED_TEST(InitialFrame, RotationLeavesNoStress)
{
  constexpr int dim   = TestFixture::dim;
  const double  angle = 2.1;
  Matrix<dim>   A{};
  if (TestFixture::Law::finite_strain)
    A[0][0] = A[1][1] = std::cos(angle) - 1;
  A[1][0] = TestFixture::Law::finite_strain ? std::sin(angle) : angle;
  A[0][1] = -A[1][0];
  this->move_linearly(A, 1);

  const double scale  = this->law.bulk_modulus;
  const auto   points = this->view();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      ASSERT_NEAR(points.pressure[p], 0, 1e-13 * scale);
      for (int k = 0; k < int(n_deviator<dim>); ++k)
        ASSERT_NEAR(points.deviator[k][p], 0, 1e-13 * scale);
    }
  const double largest = scale / this->law.density * 100;
  for (const double force : this->forces())
    ASSERT_NEAR(force, 0, 1e-12 * largest);
}
