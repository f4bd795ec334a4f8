// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_scene_run_h
#define limber_tests_support_scene_run_h

#include <limber/output/totals.h>
#include <limber/problem/read_problem.h>
#include <limber/simulation/set_up.h>
#include <limber/time/integrator.h>

#include <cmath>
#include <functional>
#include <regex>
#include <string>

namespace limber
{
  /** A value to put into a scene, with all its digits. */
  inline std::string
  digits(const double value)
  {
    char text[32];
    std::snprintf(text, sizeof(text), "%.17g", value);
    return text;
  }



  /**
   * A scene with linear functions and its bodies in the current frame, unless
   * it says otherwise: what is tested then is the same for all that can be
   * chosen automatically.
   */
  inline std::string
  in_the_current_frame(const std::string &text)
  {
    std::string      result = "subsection Method\n set Kernel = linear\nend\n";
    const std::regex body("subsection Body [^\n]+\n");
    for (std::sregex_iterator found(text.begin(), text.end(), body), end;
         found != end;
         ++found)
      result += found->str() + " set Frame = current\nend\n";
    return result + text; // the last word counts
  }



  /**
   * A scene from a text, set up and stepped by hand: what the program does
   * between reading and writing, with access to points between the steps.
   * Several ranks may run it, but what changes points here is for one.
   */
  template <int dim>
  class SceneRun
  {
  public:
    explicit SceneRun(const std::string              &text,
                      const std::vector<std::string> &overrides = {})
      : problem(read_problem<dim>(SceneFile(
          ParameterText{in_the_current_frame(text), FileFormat::prm, "scene"},
          overrides)))
      , grid(problem.grid, MPI_COMM_WORLD)
      , bodies(set_up_bodies(problem, grid))
      , nodes(grid)
      , integrator_of_scene(
          make_integrator<dim>({problem, grid, nodes, bodies, ledger}))
      , integrator(*integrator_of_scene)
      , balance(state())
    {}

    void
    advance(const double step, const unsigned int n_steps = 1)
    {
      for (unsigned int n = 0; n < n_steps; ++n, ++n_done)
        {
          integrator.reorganise(time);
          last_step = integrator.advance(time, step);
          time += step;
        }
      integrator.synchronise();
    }

    /** With steps of the scene's own choice; @p watch is called after each. */
    void
    advance_to(
      const double                 end,
      const std::function<void()> &watch = []() {})
    {
      while (time < end * (1 - 1e-12))
        {
          advance(std::min(integrator.longest_step(), end - time));
          watch();
        }
      time = end;
    }

    PointView<dim>
    points(const unsigned int body = 0)
    {
      return bodies[body]->points.view();
    }

    dealii::Point<dim>
    position(const std::size_t p, const unsigned int body = 0)
    {
      dealii::Point<dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = points(body).position[d][p];
      return result;
    }

    dealii::Tensor<1, dim>
    velocity(const std::size_t p, const unsigned int body = 0)
    {
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = points(body).velocity[d][p];
      return result;
    }

    /** Positions by the number that a point keeps for good. */
    std::vector<dealii::Point<dim>>
    positions(const unsigned int body = 0)
    {
      std::vector<dealii::Point<dim>> result(bodies[body]->points.size());
      for (std::size_t p = 0; p < result.size(); ++p)
        result.at(bodies[body]->points.id(p)) = position(p, body);
      return result;
    }

    /** Move all points to other cells if need be: grid lines that cut. */
    void
    translate(const dealii::Tensor<1, dim> &shift)
    {
      for (unsigned int b = 0; b < bodies.size(); ++b)
        for (std::size_t p = 0; p < bodies[b]->points.size(); ++p)
          {
            const auto              place = position(p, b) + shift;
            std::array<double, dim> x;
            for (int d = 0; d < dim; ++d)
              points(b).position[d][p] = x[d] = place[d];
            points(b).cell[p] = nodes.view().bins.cell_at(x);
          }
      integrator.reinit();
    }

    /** v = L x at every point, also for what APIC knows beyond the points. */
    void
    set_linear_velocity(const dealii::Tensor<2, dim> &gradient,
                        const dealii::Point<dim>     &centre)
    {
      const PointView<dim> view = points();
      for (std::size_t p = 0; p < view.size; ++p)
        {
          const auto v = gradient * (position(p) - centre);
          for (int d = 0; d < dim; ++d)
            {
              view.velocity[d][p] = v[d];
              for (int e = 0; e < dim; ++e)
                if (view.affine[d * dim + e] != nullptr)
                  view.affine[d * dim + e][p] = gradient[d][e];
            }
        }
    }

    State<dim>
    state() const
    {
      return {problem, grid, nodes, bodies, n_done, time, last_step, ledger};
    }

    Totals<dim>
    totals()
    {
      return balance.evaluate(state());
    }

    const Problem<dim>                              problem;
    BackgroundGrid<dim>                             grid;
    std::vector<std::unique_ptr<MaterialBody<dim>>> bodies;
    NodalFields<dim>                                nodes;
    Ledger<dim>                                     ledger;
    const std::unique_ptr<Integrator<dim>>          integrator_of_scene;
    Integrator<dim>                                &integrator;
    double                                          time      = 0;
    double                                          last_step = 0; // s
    unsigned long                                   n_done    = 0;
    Balance<dim>                                    balance;
  };



  inline const std::vector<std::string> stress_update_orders = {"usf",
                                                                "usl",
                                                                "musl",
                                                                "usavg"};
} // namespace limber

#endif
