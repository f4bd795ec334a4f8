// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/law_sweep.h>

#include <gtest/gtest.h>
#include <support/sample_laws.h>

#include <cfenv>
#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  /** Random points under random stress, on a grid that moves at random. */
  template <class Case>
  class Sweep : public testing::Test
  {
  public:
    static constexpr int dim       = Case::dim;
    using Law                      = typename Case::Law;
    using State                    = typename Case::State;
    using Layout                   = NodeLayout<dim>;
    static constexpr int n_history = Law::template n_history<dim>;

    SmallPoints<dim>
    stressed_points(const Law &law, const bool shuffled = false)
    {
      auto own = random_points<dim>(
        grid, random, Law::has_deviator, n_history, Law::volumetric, shuffled);
      const auto points = own.view();
      for (std::size_t p = 0; p < points.size; ++p)
        set(points, p, random_state<Case>(law, random));
      return own;
    }

    static State
    get(const PointView<dim> &points, const std::size_t p)
    {
      State state;
      state.pressure = points.pressure[p];
      if (Law::has_deviator)
        for (std::size_t k = 0; k < state.deviator.size(); ++k)
          state.deviator[k] = points.deviator[k][p];
      for (int k = 0; k < n_history; ++k)
        state.history[k] = points.history[k][p];
      return state;
    }

    static void
    set(const PointView<dim> &points, const std::size_t p, const State &state)
    {
      points.pressure[p] = state.pressure;
      if (Law::has_deviator)
        for (std::size_t k = 0; k < state.deviator.size(); ++k)
          points.deviator[k][p] = state.deviator[k];
      for (int k = 0; k < n_history; ++k)
        points.history[k][p] = state.history[k];
    }

    /** The least size of what a law computes the variable k of its history
     * from. */
    static double
    size_computed_with(const Law &law, const int k)
    {
      // pc is the length of the ellipse in the p-q plane, less the attraction
      if constexpr (std::is_same_v<Law, CamClay>)
        if (k == index_of_variable<dim, Law>(1))
          return law.attraction;
      return 1;
    }

    void
    expect_states(const PointView<dim> &points,
                  const PointView<dim> &wanted,
                  const Law            &law,
                  const double          tolerance)
    {
      const double scale = law.density * law.template wave_speed_squared<dim>(
                                           law.template initialise<dim>(0));
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto a = get(points, p), b = get(wanted, p);
          ASSERT_NEAR(a.pressure, b.pressure, tolerance * scale);
          for (std::size_t k = 0; k < a.deviator.size(); ++k)
            ASSERT_NEAR(a.deviator[k], b.deviator[k], tolerance * scale);
          for (int k = 0; k < n_history; ++k)
            ASSERT_NEAR(a.history[k],
                        b.history[k],
                        tolerance * std::max(size_computed_with(law, k),
                                             std::abs(b.history[k])));
        }
    }

    void
    random_motion()
    {
      for (double &value : grid.nodes)
        value = random();
    }

    void
    linear_motion(const Vector<dim> &a, const Matrix<dim> &A)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          {
            double v = a[d];
            for (int e = 0; e < dim; ++e)
              v += A[d][e] * grid.place(n)[e];
            grid.nodes[n * Layout::stride + Layout::velocity + d] = v;
            grid.nodes[n * Layout::stride + Layout::remapped + d] = v;
          }
    }

    /** dt grad v at a point, from one slot of the records. */
    Matrix<dim>
    gradient(const std::uint32_t cell,
             const Vector<dim>  &x,
             const unsigned int  slot,
             const double        step) const
    {
      Matrix<dim> result{};
      for (int i = 0; i < 1 << dim; ++i)
        {
          const auto G = grid.gradient(cell, i, x);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              result[d][e] +=
                step * grid.nodes[grid.cells[cell].node[i] + slot + d] * G[e];
        }
      return result;
    }

    /** The mass-weighted mean in each cell of one number per point. */
    template <class Value>
    std::vector<double>
    cell_means(const PointView<dim> &points, const Value &value) const
    {
      std::vector<double> result(grid.n_cells), mass(grid.n_cells);
      for (std::size_t p = 0; p < points.size; ++p)
        {
          result[points.cell[p]] += points.mass[p] * value(p);
          mass[points.cell[p]] += points.mass[p];
        }
      for (std::size_t c = 0; c < grid.n_cells; ++c)
        if (mass[c] > 0)
          result[c] /= mass[c];
      return result;
    }

    Random         random;
    SmallGrid<dim> grid;
  };

  TYPED_TEST_SUITE(Sweep, AllLawCases);

  constexpr double step = 0.005; // s
} // namespace



TYPED_TEST(Sweep, UpdatesEveryPointAsTheLawSays)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Plain       = LawSweep<Linear<dim>, Law, Treatment::none>;
  using Averaged    = LawSweep<Linear<dim>, Law, Treatment::cell>;
  using Layout      = NodeLayout<dim>;
  for (const auto &law : samples<Law>())
    for (int variant = 0; variant < 16; ++variant)
      {
        this->random_motion();
        StressSweep what;
        what.step            = step;
        what.remapped        = variant & 1;
        what.relaxation      = variant & 2 ? 0.3 : 0;
        const bool projected = variant & 4;
        auto       own       = this->stressed_points(law, variant & 8);
        const auto points    = own.view();
        this->grid.gather(points);
        const auto before = own.fields;

        const unsigned int slot =
          what.remapped ? Layout::remapped : Layout::velocity;
        auto       wanted_points = own;
        const auto wanted        = wanted_points.view();
        const auto motion_at     = [&](const std::size_t p) {
          return motion_of<dim>(
            this->gradient(points.cell[p], own.position(p), slot, step), step);
        };
        const auto divergence =
          this->cell_means(points, [&](const std::size_t p) {
            return motion_at(p).trace();
          });
        const auto volumetric =
          this->cell_means(points, [&](const std::size_t p) {
            return points.volumetric[p];
          });
        double viscous = 0, removed = 0, squared = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double volume = points.mass[p] / law.density;
            auto         motion = motion_at(p);
            if (projected)
              {
                motion.volumetric = divergence[points.cell[p]];
                double &x         = wanted.volumetric[p];
                removed += volume * law.volumetric_energy(x);
                x += what.relaxation * (volumetric[points.cell[p]] - x);
                removed -= volume * law.volumetric_energy(x);
              }
            auto       state = this->get(wanted, p);
            const auto heat  = law.template update<dim>(motion, state);
            this->set(wanted, p, state);
            viscous += volume * heat.viscous;
            removed += volume * heat.cutoff;
            squared =
              std::max(squared, law.template wave_speed_squared<dim>(state));
          }

        const auto    sums = this->grid.cell_sums();
        StressSummary summary;
        if (projected)
          summary = Averaged(law, {Treatment::cell})
                      .update(points, this->grid.view(), &sums, what);
        else
          summary =
            Plain(law, {}).update(points, this->grid.view(), nullptr, what);
        this->expect_states(points, wanted, law, 1e-13);
        const double scale = law.density * squared;
        EXPECT_NEAR(summary.viscous, viscous, 1e-12 * scale);
        EXPECT_NEAR(summary.history, removed, 1e-12 * scale);
        EXPECT_NEAR(summary.wave_speed_squared, squared, 1e-12 * squared);
        EXPECT_EQ(summary.displacement, 0.);

        // neither motion nor anything beyond the points has changed
        for (unsigned int k = 0; k < own.fields.size(); ++k)
          {
            if (k <= 2 * dim)
              {
                EXPECT_EQ(own.fields[k], before[k]);
              }
            for (std::size_t p = own.size; p < own.fields[k].size(); ++p)
              EXPECT_EQ(own.fields[k][p], before[k][p]);
          }
      }
}



// Lanes beyond a batch must neither spoil a sum nor raise an exception.
TYPED_TEST(Sweep, WhatLiesBehindThePointsDoesNotMatter)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Averaged    = LawSweep<Linear<dim>, Law, Treatment::cell>;
  for (const auto &law : samples<Law>())
    for (const double behind : {0., -7., 1e300})
      {
        this->random_motion();
        auto       own    = this->stressed_points(law, true);
        const auto points = own.view();
        for (auto &field : own.fields)
          std::fill(field.begin() + own.size, field.end(), behind);
        this->grid.gather(points);
        StressSweep what;
        what.step       = step;
        what.relaxation = 0.5;
        const auto sums = this->grid.cell_sums();

        std::feclearexcept(FE_ALL_EXCEPT);
        const auto summary = Averaged(law, {Treatment::cell})
                               .update(points, this->grid.view(), &sums, what);
#ifdef DEBUG
        EXPECT_FALSE(std::fetestexcept(FE_DIVBYZERO | FE_INVALID));
#endif
        EXPECT_TRUE(std::isfinite(summary.viscous));
        EXPECT_TRUE(std::isfinite(summary.history));
        EXPECT_TRUE(std::isfinite(summary.wave_speed_squared));
        for (std::size_t p = 0; p < points.size; ++p)
          ASSERT_TRUE(std::isfinite(points.pressure[p]));
        for (const auto &field : own.fields)
          EXPECT_TRUE(std::all_of(field.begin() + own.size,
                                  field.end(),
                                  [&](const double x) { return x == behind; }));
      }
}



// Where strain is the same everywhere there is nothing to average.
TYPED_TEST(Sweep, HomogeneousMotionIsNotAffectedByTreatment)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Plain       = LawSweep<Linear<dim>, Law, Treatment::none>;
  using Averaged    = LawSweep<Linear<dim>, Law, Treatment::cell>;
  for (const auto &law : samples<Law>())
    for (const double size : {0., 10.})
      {
        this->linear_motion(this->random.template vector<dim>(),
                            this->random.template matrix<dim>(size));
        auto one = this->stressed_points(law), two = one;
        this->grid.gather(one.view());
        StressSweep what;
        what.step       = step;
        const auto sums = this->grid.cell_sums();
        Plain(law, {}).update(one.view(), this->grid.view(), nullptr, what);
        Averaged(law, {Treatment::cell})
          .update(two.view(), this->grid.view(), &sums, what);
        this->expect_states(one.view(), two.view(), law, 1e-12);
        // rigid translation: not even the neo-Hookean state moves
        if (size == 0)
          {
            auto still = this->stressed_points(law);
            auto after = still;
            if (!Law::dissipates) // a viscous deviator is gone at once
              {
                Plain(law, {}).update(after.view(),
                                      this->grid.view(),
                                      nullptr,
                                      what);
                this->expect_states(after.view(), still.view(), law, 1e-12);
              }
          }
      }
}



// Relaxation goes to the mean of the cell, keeps it, and says what it costs. A
// law that parts or dilates is at rest under pressure here, where it does not.
TYPED_TEST(Sweep, RelaxationKeepsTheMean)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Averaged    = LawSweep<Linear<dim>, Law, Treatment::cell>;
  for (const auto &law : samples<Law>())
    for (const double relaxation : {0., 0.25, 1.})
      {
        std::fill(this->grid.nodes.begin(), this->grid.nodes.end(), 0.);
        auto       own    = this->stressed_points(law);
        const auto points = own.view();
        if (is_frictional<Law>)
          for (std::size_t p = 0; p < points.size; ++p)
            this->set(points,
                      p,
                      law.template initialise<dim>(law.bulk_modulus *
                                                   this->random(0.01, 0.1)));
        this->grid.gather(points);
        const auto value = [&](const std::size_t p) {
          return points.volumetric[p];
        };
        const auto energy = [&]() {
          double result = 0;
          for (std::size_t p = 0; p < points.size; ++p)
            result += points.mass[p] / law.density *
                      law.volumetric_energy(points.volumetric[p]);
          return result;
        };
        const auto   mean    = this->cell_means(points, value);
        const auto   old     = own;
        const double before  = energy();
        const double largest = law.template wave_speed_squared<dim>(
                                 law.template initialise<dim>(0)) *
                               law.density;

        StressSweep what;
        what.step          = step;
        what.relaxation    = relaxation;
        const auto sums    = this->grid.cell_sums();
        const auto summary = Averaged(law, {Treatment::cell})
                               .update(points, this->grid.view(), &sums, what);

        const double scale = Law::volumetric < 0 ? largest : 1;
        const auto   after = this->cell_means(points, value);
        for (std::size_t c = 0; c < this->grid.n_cells; ++c)
          EXPECT_NEAR(mean[c], after[c], 1e-14 * scale);
        auto       copy    = old;
        const auto earlier = copy.view();
        for (std::size_t p = 0; p < points.size; ++p)
          EXPECT_NEAR(points.volumetric[p] - mean[points.cell[p]],
                      (1 - relaxation) *
                        (earlier.volumetric[p] - mean[points.cell[p]]),
                      1e-14 * scale);
        EXPECT_NEAR(summary.history, before - energy(), 1e-12 * largest);
        if (relaxation > 0)
          {
            EXPECT_GT(summary.history, 0.); // energies are convex
          }
      }
}



TYPED_TEST(Sweep, MovesPointsOnRequest)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Plain       = LawSweep<Linear<dim>, Law, Treatment::none>;
  using Averaged    = LawSweep<Linear<dim>, Law, Treatment::cell>;
  const auto law    = samples<Law>().front();
  this->random_motion();
  for (const bool projected : {false, true})
    {
      auto still = this->stressed_points(law), moved = still;
      this->grid.gather(still.view());
      const auto  sums = this->grid.cell_sums();
      StressSweep what;
      what.step = 0.1;
      std::unique_ptr<StressUpdate<dim>> sweep;
      if (projected)
        sweep =
          std::make_unique<Averaged>(law, StrainTreatment{Treatment::cell});
      else
        sweep = std::make_unique<Plain>(law, StrainTreatment());

      sweep->update(still.view(), this->grid.view(), &sums, what);
      what.move = 0.07;
      const auto summary =
        sweep->update(moved.view(), this->grid.view(), &sums, what);
      this->expect_states(moved.view(), still.view(), law, 1e-15);

      double largest = 0;
      for (std::size_t p = 0; p < still.size; ++p)
        {
          for (int d = 0; d < dim; ++d)
            {
              double shift = 0;
              for (int i = 0; i < 1 << dim; ++i)
                shift +=
                  what.move *
                  this->grid.nodes[this->grid.cells[still.cell[p]].node[i] +
                                   NodeLayout<dim>::velocity + d] *
                  this->grid.shape(still.cell[p], i, still.position(p));
              EXPECT_NEAR(moved.fields[d][p],
                          still.fields[d][p] + shift,
                          1e-14);
              largest = std::max(largest, std::abs(shift) / this->grid.edge[d]);
            }
          EXPECT_EQ(moved.cell[p], this->grid.bins.cell_at(moved.position(p)));
        }
      if (projected)
        {
          auto gathered = this->grid.next_sums;
          for (std::uint32_t cell = 0; cell < this->grid.n_cells; ++cell)
            if (!sums.is_open(cell))
              std::fill_n(&gathered[cell << dim], 1 << dim, 0.);
          this->grid.gather(moved.view());
          for (std::size_t k = 0; k < gathered.size(); ++k)
            EXPECT_NEAR(gathered[k],
                        this->grid.sums[k],
                        1e-13 * std::max(1., std::abs(gathered[k])));
        }
      EXPECT_NEAR(summary.displacement, largest, 1e-14);
    }
}



TYPED_TEST(Sweep, SummariesAreSumsOverPoints)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  using Plain       = LawSweep<Linear<dim>, Law, Treatment::none>;
  for (const auto &law : samples<Law>())
    {
      auto                own    = this->stressed_points(law);
      const auto          points = own.view();
      const Plain         sweep(law, {});
      double              energy = 0, smallest = 1, largest = 1, squared = 0;
      std::vector<double> ratios(points.size);
      sweep.volume_ratio(points, ratios.data());
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto   state = this->get(points, p);
          const double J     = law.template volume_ratio<dim>(state);
          EXPECT_EQ(ratios[p], J);
          energy += points.mass[p] / law.density *
                    law.template strain_energy<dim>(state);
          smallest = std::min(smallest, J);
          largest  = std::max(largest, J);
          squared =
            std::max(squared, law.template wave_speed_squared<dim>(state));
        }
      const auto summary = sweep.summarize(points);
      EXPECT_NEAR(summary.strain_energy, energy, 1e-13 * energy);
      EXPECT_EQ(summary.smallest_volume, smallest);
      EXPECT_EQ(summary.largest_volume, largest);
      EXPECT_DOUBLE_EQ(sweep.wave_speed_squared(points), squared);

      const double    pressure = 0.01 * law.bulk_modulus;
      PointStart<dim> start;
      start.pressure = pressure;
      sweep.initialise(points, 3, start);
      auto wanted = law.template initialise<dim>(pressure);
      if constexpr (std::is_same_v<Law, CamClay>) // given as Cauchy's
        wanted.history[index_of_variable<dim, Law>(1)] *=
          law.template volume_ratio<dim>(wanted);
      const auto state = this->get(points, 3);
      EXPECT_EQ(state.pressure, wanted.pressure);
      EXPECT_EQ(state.history, wanted.history);
      // the mass of what is strained little does not follow its volume
      const bool follows_volume = !std::is_same_v<Law, LinearElastic>;
      EXPECT_EQ(sweep.volume_ratio_at(start),
                follows_volume ? law.template volume_ratio<dim>(wanted) : 1);
      EXPECT_EQ(sweep.n_history(), unsigned(TestFixture::n_history));
      EXPECT_EQ(sweep.density(), law.density);
    }
}



TEST(StressUpdates, AreMadeByNameWithTheRightVariant)
{
  constexpr auto response = HourglassResponse::bending;
  const auto     laws     = describe_laws();
  ASSERT_EQ(laws.size(), 6u);
  for (const auto &law : laws)
    {
      std::vector<double> values;
      for (const auto &parameter : law.parameters)
        values.push_back(parameter.standard);
      for (const Treatment kind : {Treatment::none, Treatment::cell})
        {
          const auto update =
            make_stress_update<2>(law.name, values, kind, response);
          EXPECT_EQ(update->density(), values[0]);
          EXPECT_EQ(update->treatment().kind, kind);
        }
    }
  EXPECT_FALSE(make_stress_update<3>("newtonian fluid",
                                     {1000, 1e5, 0, 0, 0, 7},
                                     Treatment::none,
                                     response)
                 ->has_deviator());
  EXPECT_TRUE(make_stress_update<3>("newtonian fluid",
                                    {1000, 1e5, 1, 0, 0, 7},
                                    Treatment::none,
                                    response)
                ->has_deviator());
  EXPECT_THROW(make_stress_update<2>("cheese", {}, Treatment::none, response),
               std::logic_error);
  EXPECT_THROW(
    make_stress_update<2>("neo hookean", {}, Treatment::none, response),
    std::logic_error);
}



// The components that a treatment averages tend to the mean of the cell, the
// others stay; what the body loses of its energy is told.
TYPED_TEST(Sweep, DeviatoricHistoryTendsToTheMeanOfTheCell)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (Law::keeps_deviator)
    {
      const auto strains = [](const Law &law, const PointView<dim> &points) {
        std::vector<Deviator<dim, double>> result;
        for (std::size_t p = 0; p < points.size; ++p)
          result.push_back(
            law.template deviatoric_strain<dim>(TestFixture::get(points, p)));
        return result;
      };
      const auto expect = [&](const auto        &sweep,
                              const Law         &law,
                              const unsigned int first,
                              const double       share) {
        auto       own      = this->stressed_points(law, true);
        const auto points   = own.view();
        const auto before   = strains(law, points);
        const auto energy   = sweep.summarize(points).strain_energy;
        const auto pressure = own.fields[2 * dim + 1];

        this->grid.gather(points); // the former sums are old then
        const auto sums = this->grid.cell_sums();
        sweep.sum_deviators(points, sums);
        const double removed = sweep.relax_deviators(points, sums.next, share);
        const auto   after   = strains(law, points);
        for (unsigned int k = 0; k < n_deviator<dim>; ++k)
          {
            const auto mean =
              this->cell_means(points, [&](const std::size_t p) {
                return before[p][k];
              });
            for (std::size_t p = 0; p < points.size; ++p)
              EXPECT_NEAR(after[p][k],
                          before[p][k] +
                            (k < first ? 0 : share) *
                              (mean[points.cell[p]] - before[p][k]),
                          1e-13);
          }
        for (std::size_t p = 0; p < points.size; ++p)
          {
            double stiffness = law.bulk_modulus;
            if constexpr (std::is_same_v<Law, CamClay>) // grows with pressure
              stiffness = (pressure[p] + law.attraction) / law.swelling;
            EXPECT_NEAR(own.fields[2 * dim + 1][p],
                        pressure[p],
                        1e-15 * std::max(law.bulk_modulus, stiffness));
          }
        EXPECT_GT(removed, 0);
        EXPECT_NEAR(removed,
                    energy - sweep.summarize(points).strain_energy,
                    1e-12 * energy);
      };
      for (const auto &law : samples<Law>())
        for (const double share : {0.3, 1.})
          {
            expect(LawSweep<Linear<dim>, Law, Treatment::cell_shear>(
                     law, {Treatment::cell_shear}),
                   law,
                   2,
                   share);
            expect(LawSweep<Linear<dim>, Law, Treatment::hybrid>(
                     law, {Treatment::hybrid}),
                   law,
                   2,
                   share);
            expect(LawSweep<Linear<dim>, Law, Treatment::cell_full>(
                     law, {Treatment::cell_full}),
                   law,
                   0,
                   share);
          }
    }
}
