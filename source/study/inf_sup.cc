// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/lapack_full_matrix.h>

#include <limber/base/exceptions.h>
#include <limber/study/inf_sup.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace limber
{
  namespace
  {
    using Matrix = dealii::LAPACKFullMatrix<double>;

    constexpr int not_there = -1;

    /** A point of integration: its place in the cell and its area. */
    struct Quadrature
    {
      double xi = 0, eta = 0, weight = 0;
    };

    /** All points by cell, and the numbers of the unknowns. */
    struct Spaces
    {
      std::vector<std::vector<Quadrature>> points;   // per cell
      std::vector<int>                     velocity; // per node, or not_there
      std::vector<int>                     pressure; // per node or cell
      unsigned int                         n_velocities = 0; // of one component
      unsigned int                         n_pressures  = 0;
    };



    std::vector<Quadrature>
    full_cell(const InfSupCase &asked)
    {
      const double        area = 1. / asked.cells / asked.cells;
      std::vector<double> places;
      if (asked.points == 0)
        places = {0.5 - 0.5 / std::sqrt(3.), 0.5 + 0.5 / std::sqrt(3.)};
      else
        for (unsigned int i = 0; i < asked.points; ++i)
          places.push_back((i + 0.5) / asked.points);
      std::vector<Quadrature> result;
      for (const double eta : places)
        for (const double xi : places)
          result.push_back(
            {xi, eta, area / double(places.size() * places.size())});
      return result;
    }



    std::array<unsigned int, 4>
    nodes_of(const unsigned int cell, const unsigned int n)
    {
      const unsigned int i = cell % n, j = cell / n;
      const unsigned int first = j * (n + 1) + i;
      return {{first, first + 1, first + n + 1, first + n + 2}};
    }



    Spaces
    make_spaces(const InfSupCase &asked)
    {
      const unsigned int                     n = asked.cells;
      std::mt19937                           generator(asked.seed);
      std::uniform_real_distribution<double> chance(0, 1);
      Spaces                                 spaces;
      spaces.velocity.assign((n + 1) * (n + 1), not_there);
      spaces.pressure.assign(asked.pressure == PressureSpace::cell ?
                               n * n :
                               (n + 1) * (n + 1),
                             not_there);
      const auto take_part = [](int &number, unsigned int &count) {
        if (number == not_there)
          number = int(count++);
      };
      for (unsigned int cell = 0; cell < n * n; ++cell)
        {
          const unsigned int i = cell % n, j = cell / n;
          const bool outer = i == 0 || j == 0 || i == n - 1 || j == n - 1;
          std::vector<Quadrature> points = full_cell(asked);
          if (outer && asked.fill < 1)
            points.erase(std::remove_if(points.begin(),
                                        points.end(),
                                        [&](const Quadrature &) {
                                          return chance(generator) > asked.fill;
                                        }),
                         points.end());
          spaces.points.push_back(points);
          if (points.empty())
            continue;
          if (asked.pressure == PressureSpace::cell)
            take_part(spaces.pressure[cell], spaces.n_pressures);
          for (const unsigned int node : nodes_of(cell, n))
            {
              const unsigned int a = node % (n + 1), b = node / (n + 1);
              if (a > 0 && b > 0 && a < n && b < n)
                take_part(spaces.velocity[node], spaces.n_velocities);
              if (asked.pressure == PressureSpace::node)
                take_part(spaces.pressure[node], spaces.n_pressures);
            }
        }
      return spaces;
    }



    /** Stiffness (H1 seminorm) of one velocity component, divergence, and
     * pressure mass matrix. */
    struct Matrices
    {
      Matrix S, B, M; // B: rows velocity (component by component), pressures
    };



    void
    add_point(const InfSupCase &asked,
              const Spaces     &spaces,
              const unsigned    cell,
              const Quadrature &q,
              Matrices         &matrices)
    {
      const double n       = asked.cells;
      const auto   nodes   = nodes_of(cell, asked.cells);
      const double N[4]    = {(1 - q.xi) * (1 - q.eta),
                              q.xi * (1 - q.eta),
                              (1 - q.xi) * q.eta,
                              q.xi * q.eta};
      const double G[4][2] = {{-(1 - q.eta) * n, -(1 - q.xi) * n},
                              {(1 - q.eta) * n, -q.xi * n},
                              {-q.eta * n, (1 - q.xi) * n},
                              {q.eta * n, q.xi * n}};

      // the pressures that are not zero at this point, and their values
      std::vector<std::pair<int, double>> pressures;
      if (asked.pressure == PressureSpace::cell)
        pressures = {{spaces.pressure[cell], 1.}};
      else
        for (unsigned int a = 0; a < 4; ++a)
          pressures.emplace_back(spaces.pressure[nodes[a]], N[a]);

      for (unsigned int a = 0; a < 4; ++a)
        {
          const int row = spaces.velocity[nodes[a]];
          if (row == not_there)
            continue;
          for (unsigned int b = 0; b < 4; ++b)
            if (const int column = spaces.velocity[nodes[b]];
                column != not_there)
              matrices.S(row, column) +=
                q.weight * (G[a][0] * G[b][0] + G[a][1] * G[b][1]);
          for (const auto &[p, value] : pressures)
            for (unsigned int d = 0; d < 2; ++d)
              matrices.B(row + d * spaces.n_velocities, p) +=
                q.weight * G[a][d] * value;
        }
      for (const auto &[p, value] : pressures)
        for (const auto &[r, other] : pressures)
          matrices.M(p, r) += q.weight * value * other;
    }



    /** Pressure Schur complement B^T S^-1 B, with the same S for both
     * components. */
    Matrix
    schur_complement(const Spaces &spaces, Matrices &matrices)
    {
      const unsigned int n_v = spaces.n_velocities, n_p = spaces.n_pressures;
      matrices.S.set_property(dealii::LAPACKSupport::symmetric);
      matrices.S.compute_cholesky_factorization();
      Matrix result(n_p, n_p);
      for (unsigned int d = 0; d < 2; ++d)
        {
          Matrix part(n_v, n_p), product(n_p, n_p);
          for (unsigned int i = 0; i < n_v; ++i)
            for (unsigned int p = 0; p < n_p; ++p)
              part(i, p) = matrices.B(i + d * n_v, p);
          Matrix solved = part;
          matrices.S.solve(solved);
          part.Tmmult(product, solved);
          for (unsigned int p = 0; p < n_p; ++p)
            for (unsigned int r = 0; r < n_p; ++r)
              result(p, r) += product(p, r);
        }
      return result;
    }
  } // namespace



  InfSup
  inf_sup(const InfSupCase &asked)
  {
    const Spaces spaces = make_spaces(asked);
    if (spaces.n_velocities == 0 || spaces.n_pressures == 0)
      throw ComputationError(
        "The mesh of " + std::to_string(asked.cells) + " x " +
        std::to_string(asked.cells) +
        " cells has no free node. The inf-sup test needs inner nodes: take at "
        "least two cells per edge.");
    Matrices matrices{Matrix(spaces.n_velocities, spaces.n_velocities),
                      Matrix(2 * spaces.n_velocities, spaces.n_pressures),
                      Matrix(spaces.n_pressures, spaces.n_pressures)};
    for (unsigned int cell = 0; cell < spaces.points.size(); ++cell)
      for (const Quadrature &q : spaces.points[cell])
        add_point(asked, spaces, cell, q, matrices);
    try
      {
        Matrix schur = schur_complement(spaces, matrices);
        schur.set_property(dealii::LAPACKSupport::symmetric);
        matrices.M.set_property(dealii::LAPACKSupport::symmetric);
        std::vector<dealii::Vector<double>> vectors(
          0, dealii::Vector<double>(spaces.n_pressures));
        schur.compute_generalized_eigenvalues_symmetric(matrices.M, vectors);

        // beta is of order one and round-off of beta^2 of order 1e-15
        constexpr double zero = 1e-9;
        InfSup           result;
        double           smallest = 1e300;
        for (unsigned int i = 0; i < spaces.n_pressures; ++i)
          {
            const double value = schur.eigenvalue(i).real();
            if (value < zero)
              ++result.zero_modes;
            else
              smallest = std::min(smallest, value);
          }
        result.beta = smallest < 1e300 ? std::sqrt(smallest) : 0;
        return result;
      }
    catch (const dealii::ExceptionBase &)
      {
        throw ComputationError(
          "The points of " + std::to_string(asked.cells) + " x " +
          std::to_string(asked.cells) +
          " cells leave a node without stiffness or a pressure without norm. "
          "Usually the outermost cells hold too few points. Take more with "
          "'--points', or a larger '--fill'.");
      }
  }
} // namespace limber
