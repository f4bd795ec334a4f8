// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/cam_clay.h>
#include <limber/materials/drucker_prager.h>
#include <limber/materials/j2.h>
#include <limber/materials/linear_elastic.h>
#include <limber/materials/neo_hookean.h>
#include <limber/stress/stress_update.h>
#include <limber/stress/trial_stress.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class LawType,
            int        dimension,
            Treatment  treatment,
            Frame      frame_kind,
            KernelKind functions = KernelKind::linear>
  struct TrialCase
  {
    using Law                          = LawType;
    static constexpr int        dim    = dimension;
    static constexpr Treatment  kind   = treatment;
    static constexpr Frame      frame  = frame_kind;
    static constexpr KernelKind kernel = functions;
  };



  /** Soft enough to flow at the strains of these tests. */
  template <class Law>
  std::vector<double>
  values_of()
  {
    if constexpr (std::is_same_v<Law, J2>)
      return {1000, 1e6, 0.4, 2e4, 5e4, 1e4, 10, 0, 1};
    else if constexpr (std::is_same_v<Law, DruckerPrager<false>>)
      return {1000, 1e6, 0.4, 30, 2e4, 0, 1e300, 0, 0, 1, 1, 1};
    else if constexpr (std::is_same_v<Law, DruckerPrager<true>>)
      return {1000, 1e6, 0.4, 30, 2e4, 10, 1e300, 0, 0, 1, 1, 1};
    else if constexpr (std::is_same_v<Law, CamClay>)
      return {1000, 4e5, 0.3, 0.1, 1.2, 3e4, 5e4};
    else
      return {1000, 1e6, 0.4};
  }



  /** Points in two cells, strained before, and what they respond. */
  template <class Case>
  class TrialStresses : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Law                = typename Case::Law;

    TrialStresses()
      : own(n_points,
            true,
            Law::template n_history<dim>,
            Law::volumetric,
            false)
      , deformation(dim * dim,
                    std::vector<double>(n_points + SmallPoints<dim>::room))
      , places(dim, std::vector<double>(n_points + SmallPoints<dim>::room))
      , displacement(grid.n_nodes * dim)
      , trial(make_trial_stress<dim>(Law::name,
                                     values_of<Law>(),
                                     Case::kind,
                                     HourglassResponse::bending,
                                     Case::frame,
                                     Case::kernel))
    {
      const auto                                 points = view();
      std::array<double, Law::parameters.size()> values;
      const auto                                 of_law = values_of<Law>();
      std::copy(of_law.begin(), of_law.end(), values.begin());
      const Law law(values);
      for (std::size_t p = 0; p < n_points; ++p)
        {
          own.cell[p]      = p < 5 ? 1 : 6; // share a corner or an edge
          const auto &cell = grid.cells[own.cell[p]];
          for (int d = 0; d < dim; ++d)
            {
              points.position[d][p] =
                cell.origin[d] + grid.edge[d] * random(0, 1);
              places[d][p]                  = points.position[d][p];
              deformation[d * (dim + 1)][p] = 1;
            }
          points.mass[p]     = random(0.5, 2);
          const auto state   = law.template initialise<dim>(0.);
          points.pressure[p] = state.pressure;
          for (unsigned int k = 0; k < state.deviator.size(); ++k)
            points.deviator[k][p] = state.deviator[k];
          for (unsigned int k = 0; k < state.history.size(); ++k)
            points.history[k][p] = state.history[k];
        }
      // A former step leaves stress; in the current frame also volume ratios
      // that differ within a cell
      set_random(0.05);
      trial->accept(points, grid.view(), displacement.data());
      for (std::size_t p = 0; p < n_points; ++p)
        {
          own.cell[p] = p < 5 ? 1 : 6;
          for (int d = 0; d < dim; ++d)
            points.position[d][p] = Case::frame == Frame::initial ?
                                      points.position[d][p] :
                                      places[d][p];
        }
      set_random(0.04);
    }

    PointView<dim>
    view()
    {
      auto result = own.view();
      if (Case::frame == Frame::initial)
        {
          for (int k = 0; k < dim * dim; ++k)
            result.deformation[k] = deformation[k].data();
          for (int d = 0; d < dim; ++d)
            result.place[d] = places[d].data();
        }
      return result;
    }

    /** Points that nothing has strained yet. */
    void
    undo_strain()
    {
      for (int k = 0; k < dim * dim; ++k)
        for (double &entry : deformation[k])
          entry = k % (dim + 1) == 0;
      for (int d = 0; d < dim; ++d)
        own.fields[d] = places[d];
    }

    /** Displacements A x + b of the nodes where they are. */
    void
    set_linear(const Matrix<dim> &A, const Vector<dim> &b)
    {
      for (std::size_t node = 0; node < grid.n_nodes; ++node)
        {
          const auto x = grid.place(node);
          for (int d = 0; d < dim; ++d)
            {
              double &u = displacement[node * dim + d];
              u         = b[d];
              for (int e = 0; e < dim; ++e)
                u += A[d][e] * x[e];
            }
        }
    }

    void
    set_random(const double size)
    {
      for (double &u : displacement)
        u = size * random();
    }

    /** Energy, force, tangent of all. */
    struct Total
    {
      double              energy = 0;
      std::vector<double> force, tangent;
      bool                admissible = false;
    };

    Total
    respond(const bool with_tangent = false, const double *former = nullptr)
    {
      const std::size_t n = displacement.size();
      Total             result;
      result.force.resize(n);
      if (with_tangent)
        result.tangent.resize(n * n);
      result.admissible = trial->respond(
        view(),
        grid.view(),
        displacement.data(),
        former,
        with_tangent,
        [&](const std::uint32_t cell, CellResponse &response) {
          response.add_volume_stiffness(response.volume_stiffness);
          result.energy += response.energy;
          const auto dof = [&](const unsigned int k) {
            return grid.node_number(cell, k / dim) * dim + k % dim;
          };
          for (unsigned int k = 0; k < response.n; ++k)
            {
              result.force[dof(k)] += response.force[k];
              if (with_tangent)
                for (unsigned int l = 0; l < response.n; ++l)
                  result.tangent[dof(k) * n + dof(l)] +=
                    response.tangent[k * response.n + l];
            }
        });
      return result;
    }

    static constexpr std::size_t            n_points = 12;
    SmallGrid<dim, Case::kernel>            grid{3};
    Random                                  random;
    SmallPoints<dim>                        own;
    std::vector<std::vector<double>>        deformation, places;
    std::vector<double>                     displacement;
    std::unique_ptr<const TrialStress<dim>> trial;
  };



  template <class Law, int dim>
  using TrialCasesOf = testing::Types<
    TrialCase<Law, dim, Treatment::none, Frame::current>,
    TrialCase<Law, dim, Treatment::cell, Frame::current>,
    TrialCase<Law, dim, Treatment::assumed_strain, Frame::current>,
    TrialCase<Law, dim, Treatment::none, Frame::initial>,
    TrialCase<Law, dim, Treatment::cell, Frame::initial>,
    TrialCase<Law, dim, Treatment::assumed_strain, Frame::initial>,
    TrialCase<Law, dim, Treatment::none, Frame::initial, KernelKind::quadratic>,
    TrialCase<Law,
              dim,
              Treatment::cell,
              Frame::initial,
              KernelKind::quadratic>>;

  TYPED_TEST_SUITE_P(TrialStresses);



  TYPED_TEST_P(TrialStresses, ForceIsTheDerivativeOfTheEnergy)
  {
    const auto   here = this->respond();
    const double step = 1e-6;
    ASSERT_TRUE(here.admissible);
    double largest = 0, error = 0;
    for (std::size_t k = 0; k < this->displacement.size(); ++k)
      {
        const double u        = this->displacement[k];
        this->displacement[k] = u + step;
        const double above    = this->respond().energy;
        this->displacement[k] = u - step;
        const double below    = this->respond().energy;
        this->displacement[k] = u;
        largest               = std::max(largest, std::abs(here.force[k]));
        error =
          std::max(error,
                   std::abs(here.force[k] - (above - below) / (2 * step)));
      }
    EXPECT_GT(largest, 1); // N
    EXPECT_LT(error, 1e-7 * largest);
  }



  TYPED_TEST_P(TrialStresses, TangentIsTheDerivativeOfTheForce)
  {
    const auto        here    = this->respond(true);
    const std::size_t n       = this->displacement.size();
    const double      step    = 1e-6;
    double            largest = 0, error = 0, skew = 0;
    for (std::size_t l = 0; l < n; ++l)
      {
        const double u        = this->displacement[l];
        this->displacement[l] = u + step;
        const auto above      = this->respond().force;
        this->displacement[l] = u - step;
        const auto below      = this->respond().force;
        this->displacement[l] = u;
        for (std::size_t k = 0; k < n; ++k)
          {
            const double entry = here.tangent[k * n + l];
            largest            = std::max(largest, std::abs(entry));
            skew = std::max(skew, std::abs(entry - here.tangent[l * n + k]));
            error =
              std::max(error,
                       std::abs(entry - (above[k] - below[k]) / (2 * step)));
          }
      }
    EXPECT_GT(largest, 1e3); // N/m
    EXPECT_LT(error, 1e-7 * largest);
    EXPECT_LT(skew, 1e-13 * largest);
  }



  // From displacements that are nearly the same the extrapolation is exact to
  // second order; from those themselves it is exact.
  TYPED_TEST_P(TrialStresses, StressInTheTangentIsExtrapolated)
  {
    const auto exact   = this->respond(true).tangent;
    auto       former  = this->displacement;
    double     largest = 0;
    for (const double entry : exact)
      largest = std::max(largest, std::abs(entry));
    const auto error_from = [&](const double distance) {
      Random random(3);
      for (std::size_t k = 0; k < former.size(); ++k)
        former[k] = this->displacement[k] + distance * random();
      const auto tangent = this->respond(true, former.data()).tangent;
      double     error   = 0;
      for (std::size_t k = 0; k < exact.size(); ++k)
        error = std::max(error, std::abs(tangent[k] - exact[k]));
      return error / largest;
    };
    EXPECT_LT(error_from(0), 1e-13);
    if (!TypeParam::Law::finite_strain)
      return;
    const double far = error_from(4e-3), near = error_from(2e-3);
    EXPECT_GT(far, 1e-6);
    EXPECT_GT(far / near, 3.5);
  }



  TYPED_TEST_P(TrialStresses, TrialsLeaveThePointsAsTheyAre)
  {
    const auto fields = this->own.fields;
    const auto F      = this->deformation;
    this->respond(true);
    EXPECT_EQ(fields, this->own.fields);
    EXPECT_EQ(F, this->deformation);
    this->trial->accept(this->view(),
                        this->grid.view(),
                        this->displacement.data());
    EXPECT_NE(fields, this->own.fields);
  }



  // Places and functions stay, so what has been accepted is where the next step
  // begins.
  TYPED_TEST_P(TrialStresses, AcceptedStateIsThatOfTheTrial)
  {
    const auto before = this->respond();
    const auto places = this->own.fields;
    this->trial->accept(this->view(),
                        this->grid.view(),
                        this->displacement.data());
    for (int d = 0; d < this->dim; ++d)
      if (TypeParam::frame == Frame::current)
        this->own.fields[d] = places[d];
    for (std::size_t p = 0; p < this->n_points; ++p)
      this->own.cell[p] = p < 5 ? 1 : 6;
    this->set_random(0);
    const auto after = this->respond();
    EXPECT_NEAR(after.energy, before.energy, 1e-12 * before.energy);
    if (TypeParam::frame == Frame::initial)
      {
        for (std::size_t k = 0; k < before.force.size(); ++k)
          EXPECT_NEAR(after.force[k], before.force[k], 1e-7);
      }
  }



  TYPED_TEST_P(TrialStresses, PointsTurnedInsideOutAreRefused)
  {
    if (!TypeParam::Law::finite_strain)
      return;
    // the mirror image of the cells
    for (std::size_t node = 0; node < this->grid.n_nodes; ++node)
      this->displacement[node * this->dim] = -3 * this->grid.place(node)[0];
    EXPECT_FALSE(this->respond().admissible);
  }



  // In the initial frame: nothing resists a rotation about a third of a turn,
  // and a homogeneous deformation is that of every point.
  TYPED_TEST_P(TrialStresses, RigidMotionsAreFreeAndLinearOnesExact)
  {
    if (TypeParam::frame != Frame::initial)
      return;
    constexpr int dim = TypeParam::dim;
    Random        random(5);
    const auto    A = random.template matrix<dim>(0.05);
    const auto    b = random.template vector<dim>();
    this->undo_strain();
    this->set_linear(A, b);
    const auto strained = this->respond();
    this->trial->accept(this->view(),
                        this->grid.view(),
                        this->displacement.data());
    for (std::size_t p = 0; p < this->n_points; ++p)
      for (int d = 0; d < dim; ++d)
        {
          double x = this->places[d][p] + b[d];
          for (int e = 0; e < dim; ++e)
            {
              x += A[d][e] * this->places[e][p];
              EXPECT_NEAR(this->deformation[d * dim + e][p],
                          A[d][e] + (d == e),
                          1e-13);
            }
          EXPECT_NEAR(this->own.fields[d][p], x, 1e-13);
        }

    if (!TypeParam::Law::finite_strain)
      return;
    Matrix<dim>  turn{};
    const double c = std::cos(2.), s = std::sin(2.);
    turn[0][0] = turn[1][1] = c - 1;
    turn[0][1]              = -s;
    turn[1][0]              = s;
    this->undo_strain();
    this->set_linear(turn, b);
    const auto turned  = this->respond();
    double     largest = 0, error = 0;
    for (std::size_t k = 0; k < turned.force.size(); ++k)
      {
        largest = std::max(largest, std::abs(strained.force[k]));
        error   = std::max(error, std::abs(turned.force[k]));
      }
    EXPECT_LT(std::abs(turned.energy), 1e-12 * strained.energy);
    EXPECT_LT(error, 1e-12 * largest);
  }



  REGISTER_TYPED_TEST_SUITE_P(TrialStresses,
                              RigidMotionsAreFreeAndLinearOnesExact,
                              ForceIsTheDerivativeOfTheEnergy,
                              TangentIsTheDerivativeOfTheForce,
                              StressInTheTangentIsExtrapolated,
                              TrialsLeaveThePointsAsTheyAre,
                              AcceptedStateIsThatOfTheTrial,
                              PointsTurnedInsideOutAreRefused);

  /** Of laws that flow. */
  template <class Case>
  class PlasticTrialStresses : public TrialStresses<Case>
  {};

  TYPED_TEST_SUITE_P(PlasticTrialStresses);

  // Return map and all; central differences of the force know it to 1e-6 where
  // no point is at the edge of its yield surface.
  TYPED_TEST_P(PlasticTrialStresses, TangentIsTheDerivativeOfTheForce)
  {
    const auto        here    = this->respond(true);
    const std::size_t n       = this->displacement.size();
    const double      step    = 1e-6;
    double            largest = 0, error = 0, skew = 0;
    for (std::size_t l = 0; l < n; ++l)
      {
        const double u        = this->displacement[l];
        this->displacement[l] = u + step;
        const auto above      = this->respond().force;
        this->displacement[l] = u - step;
        const auto below      = this->respond().force;
        this->displacement[l] = u;
        for (std::size_t k = 0; k < n; ++k)
          {
            const double entry = here.tangent[k * n + l];
            largest            = std::max(largest, std::abs(entry));
            skew = std::max(skew, std::abs(entry - here.tangent[l * n + k]));
            error =
              std::max(error,
                       std::abs(entry - (above[k] - below[k]) / (2 * step)));
          }
      }
    EXPECT_GT(largest, 1e3); // N/m
    EXPECT_LT(error, 1e-5 * largest);
    if (this->trial->has_symmetric_tangent())
      {
        EXPECT_LT(skew, 0.02 * largest);
      }
    else if (this->dim == 3) // in the plane all points part
      {
        EXPECT_GT(skew, 1e-3 * largest);
      }
  }



  // The motion of the trial does flow, and softens against an elastic one.
  TYPED_TEST_P(PlasticTrialStresses, FlowTakesWork)
  {
    const auto accepted = this->trial->accept(this->view(),
                                              this->grid.view(),
                                              this->displacement.data());
    EXPECT_GT(accepted.plastic_work, 1.); // J
    EXPECT_GT(accepted.longest_way, 0.);
  }

  // In the initial frame the functions are the same, so that an explicit step
  // by the same displacement leaves the same state, and the same forces.
  TYPED_TEST_P(PlasticTrialStresses, ExplicitStepsFlowInTheSameWay)
  {
    constexpr int dim = TestFixture::dim;
    using Layout      = NodeLayout<dim>;
    using Law         = typename TestFixture::Law;
    if (TypeParam::frame != Frame::initial)
      return; // points have other places there
    const auto stress = make_stress_update<dim>(Law::name,
                                                values_of<Law>(),
                                                TypeParam::kind,
                                                HourglassResponse::bending,
                                                TypeParam::frame,
                                                TypeParam::kernel);
    const auto trial  = this->respond();
    auto       other  = this->own; // the one by explicit steps
    auto       stored = this->deformation;
    auto       view   = other.view();
    for (int k = 0; k < dim * dim; ++k)
      view.deformation[k] = stored[k].data();
    for (int d = 0; d < dim; ++d)
      view.place[d] = this->places[d].data();
    StressSweep what;
    what.step       = 0.1;
    what.give_force = true;
    for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
      for (int d = 0; d < dim; ++d)
        this->grid.nodes[n * Layout::stride + Layout::strain_velocity + d] =
          this->displacement[n * dim + d] / what.step;
    const auto explicit_step =
      stress->update(view, this->grid.view(), nullptr, what);
    const auto accepted = this->trial->accept(this->view(),
                                              this->grid.view(),
                                              this->displacement.data());

    EXPECT_NEAR(explicit_step.plastic,
                accepted.plastic_work,
                1e-10 * accepted.plastic_work);
    const auto points  = this->view();
    double     largest = 0;
    for (std::size_t p = 0; p < this->n_points; ++p)
      {
        largest = std::max(largest, std::abs(points.pressure[p]));
        EXPECT_NEAR(view.pressure[p], points.pressure[p], 1e-5);
        for (unsigned int k = 0; k < n_deviator<dim>; ++k)
          EXPECT_NEAR(view.deviator[k][p], points.deviator[k][p], 1e-5);
        for (unsigned int k = 0; k < stress->n_history(); ++k)
          EXPECT_NEAR(view.history[k][p],
                      points.history[k][p],
                      1e-12 * (1 + std::abs(points.history[k][p])));
        for (int k = 0; k < dim * dim; ++k)
          EXPECT_NEAR(view.deformation[k][p], points.deformation[k][p], 1e-14);
      }
    EXPECT_GT(largest, 1e3); // Pa
    for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
      for (int d = 0; d < dim; ++d)
        EXPECT_NEAR(this->grid.nodes[n * Layout::stride + Layout::force + d],
                    -trial.force[n * dim + d],
                    1e-7);
  }

  REGISTER_TYPED_TEST_SUITE_P(PlasticTrialStresses,
                              TangentIsTheDerivativeOfTheForce,
                              FlowTakesWork,
                              ExplicitStepsFlowInTheSameWay);

  template <class Law, int dim, class... More>
  using PlasticCasesOf = testing::Types<
    TrialCase<Law, dim, Treatment::none, Frame::current>,
    TrialCase<Law, dim, Treatment::cell, Frame::current>,
    TrialCase<Law, dim, Treatment::assumed_strain, Frame::current>,
    TrialCase<Law, dim, Treatment::none, Frame::initial>,
    TrialCase<Law, dim, Treatment::cell, Frame::initial>,
    TrialCase<Law, dim, Treatment::assumed_strain, Frame::initial>,
    More...>;
  template <int dim>
  using OnSplines =
    TrialCase<J2, dim, Treatment::cell, Frame::initial, KernelKind::quadratic>;
  using J2Plane    = PlasticCasesOf<J2, 2, OnSplines<2>>;
  using J2Space    = PlasticCasesOf<J2, 3, OnSplines<3>>;
  using SandPlane  = PlasticCasesOf<DruckerPrager<false>, 2>;
  using SandSpace  = PlasticCasesOf<DruckerPrager<false>, 3>;
  using DensePlane = PlasticCasesOf<DruckerPrager<true>, 2>;
  using DenseSpace = PlasticCasesOf<DruckerPrager<true>, 3>;
  using ClayPlane  = PlasticCasesOf<CamClay, 2>;
  using ClaySpace  = PlasticCasesOf<CamClay, 3>;
  INSTANTIATE_TYPED_TEST_SUITE_P(J2In2d, PlasticTrialStresses, J2Plane);
  INSTANTIATE_TYPED_TEST_SUITE_P(J2In3d, PlasticTrialStresses, J2Space);
  INSTANTIATE_TYPED_TEST_SUITE_P(SandIn2d, PlasticTrialStresses, SandPlane);
  INSTANTIATE_TYPED_TEST_SUITE_P(SandIn3d, PlasticTrialStresses, SandSpace);
  INSTANTIATE_TYPED_TEST_SUITE_P(DenseIn2d, PlasticTrialStresses, DensePlane);
  INSTANTIATE_TYPED_TEST_SUITE_P(DenseIn3d, PlasticTrialStresses, DenseSpace);
  INSTANTIATE_TYPED_TEST_SUITE_P(ClayIn2d, PlasticTrialStresses, ClayPlane);
  INSTANTIATE_TYPED_TEST_SUITE_P(ClayIn3d, PlasticTrialStresses, ClaySpace);

  template <int dim>
  using NeoHookeanTrials = TrialCasesOf<NeoHookean, dim>;
  template <int dim>
  using LinearTrials = TrialCasesOf<LinearElastic, dim>;
  INSTANTIATE_TYPED_TEST_SUITE_P(NeoHookean2d,
                                 TrialStresses,
                                 NeoHookeanTrials<2>);
  INSTANTIATE_TYPED_TEST_SUITE_P(NeoHookean3d,
                                 TrialStresses,
                                 NeoHookeanTrials<3>);
  INSTANTIATE_TYPED_TEST_SUITE_P(Linear2d, TrialStresses, LinearTrials<2>);
  INSTANTIATE_TYPED_TEST_SUITE_P(Linear3d, TrialStresses, LinearTrials<3>);
} // namespace
