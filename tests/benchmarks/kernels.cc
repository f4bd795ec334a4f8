// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/timing.h>
#include <limber/problem/read_problem.h>
#include <limber/simulation/set_up.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

/**
 * @file Time per point of each sweep over a block that fills its cells, 2^dim
 * points in each: the best and the median of many repetitions.
 *
 *     kernels [REPETITIONS [KERNEL]]
 *
 * 40 of them with linear functions, if not told otherwise. Kernels whose points
 * have domains (gimp, cpgimp, cpdi, cpdi2) are measured with FLIP and without
 * treatment; ddmp, whose sweeps need others before them, only by block.py.
 */
using namespace limber;

namespace
{
  unsigned int n_repetitions = 40;
  std::string  kernel        = "linear";



  bool
  has_domains()
  {
    return kernel == "gimp" || kernel == "cpgimp" || kernel == "cpdi" ||
           kernel == "cpdi2";
  }



  /** A block at rest: the material, treatment and transfer are of choice. */
  template <int dim>
  SceneFile
  block(const std::string &law,
        const std::string &law_section,
        const std::string &treatment,
        const bool         apic)
  {
    const unsigned int n    = dim == 2 ? 100 : 30;
    const auto         each = [](const double value) {
      std::ostringstream text;
      for (int d = 0; d < dim; ++d)
        text << (d ? ", " : "") << value;
      return text.str();
    };
    std::ostringstream text;
    text << "set Dimension = " << dim << "\n"
         << "set Bodies = block\n"
         << "subsection Body block\n"
         << "  set Shape = box\n"
         << "  subsection Box\n"
         << "    set Lower corner = " << each(1) << "\n"
         << "    set Upper corner = " << each(1 + n) << "\n"
         << "  end\n"
         << "  set Points per cell edge = 2\n"
         << "  set Frame = current\n"
         << "  set Material = " << law << "\n"
         << law_section << "  set Locking treatment = " << treatment << "\n"
         << "end\n"
         << "subsection Grid\n"
         << "  set Lower corner = " << each(0) << "\n"
         << "  set Upper corner = " << each(2 + n) << "\n"
         << "  set Cells = " << each(2 + n) << "\n"
         << "end\n"
         << "subsection Method\n"
         << "  set Kernel = " << kernel << "\n"
         << "  set Transfer = " << (apic ? "apic" : "flip") << "\n"
         << "end\n";
    return SceneFile(ParameterText{text.str(), FileFormat::prm, "block"});
  }



  /** A block with everything that the sweeps need, and a stopwatch. */
  template <int dim>
  class Bench
  {
  public:
    explicit Bench(const SceneFile &scene)
      : problem(read_problem<dim>(scene))
      , grid(problem.grid, MPI_COMM_WORLD)
      , bodies(set_up_bodies(problem, grid))
      , nodes(grid)
      , body(*bodies[0])
    {
      cells = body.points.sort_by_cell();
      if (const auto points = body.points.view(); points.has_domains())
        {
          const auto corners = cells_of_corners(points, nodes.view());
          const auto middle  = cells.size();
          cells.insert(cells.end(), corners.begin(), corners.end());
          std::inplace_merge(cells.begin(),
                             cells.begin() + middle,
                             cells.end());
          cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        }
      nodes.set_occupied(std::vector<std::uint32_t>(cells));
      if (body.cell_sums)
        {
          gather_cell_sums<dim>(body.points.view(),
                                nodes.view(),
                                body.cell_sums->view());
          complete_cells();
          sums = body.cell_sums->view();
        }
    }

    /** Zero records, which is not part of what is measured. */
    void
    clear()
    {
      nodes.clear();
    }

    void
    complete_cells()
    {
      body.cell_sums->start_completion(nodes.cell_plan());
      body.cell_sums->finish_completion();
    }

    /** Motion so slow that many repetitions leave the points where they are. */
    void
    set_motion()
    {
      for (const std::uint32_t node : nodes.active_nodes())
        for (unsigned int k = 1; k < NodeLayout<dim>::stride; ++k)
          nodes.record(node)[k] = 1e-9 * ((node * 7 + k * 13) % 101 - 50.);
    }

    const CellSums<dim> *
    sums_or_none() const
    {
      return body.cell_sums ? &sums : nullptr;
    }

    template <class Prepare, class Sweep>
    void
    measure(const char *name, const Prepare &prepare, const Sweep &sweep)
    {
      std::vector<double> seconds;
      for (unsigned int k = 0; k < n_repetitions + 3; ++k)
        {
          prepare();
          const double start = wall_time();
          sweep();
          if (k >= 3) // caches are warm
            seconds.push_back(wall_time() - start);
        }
      std::sort(seconds.begin(), seconds.end());
      const double scale = 1e9 / body.points.size();
      std::printf("  %-44s %8.2f %8.2f\n",
                  name,
                  scale * seconds[0],
                  scale * seconds[seconds.size() / 2]);
      std::fflush(stdout);
    }

    const Problem<dim>                              problem;
    BackgroundGrid<dim>                             grid;
    std::vector<std::unique_ptr<MaterialBody<dim>>> bodies;
    NodalFields<dim>                                nodes;
    MaterialBody<dim>                              &body;
    std::vector<std::uint32_t>                      cells;
    CellSums<dim>                                   sums;
  };



  template <int dim>
  void
  measure_giving(const std::string &treatment, const bool apic)
  {
    Bench<dim> bench(block<dim>("linear elastic", "", treatment, apic));
    P2GOptions give;
    give.affine          = apic;
    give.inverse_density = 1e-3;
    give.treatment       = bench.body.stress->treatment();
    const auto label = "points to grid, " + treatment + (apic ? ", apic" : "");
    bench.measure(
      label.c_str(),
      [&]() { bench.clear(); },
      [&]() {
        points_to_grid<dim>(bench.body.points.view(),
                            bench.nodes.view(),
                            give,
                            bench.sums_or_none());
      });
  }



  template <int dim>
  void
  measure_taking(const bool apic)
  {
    Bench<dim>        bench(block<dim>("linear elastic", "", "none", apic));
    const std::string name = apic ? "grid to points, apic" : "grid to points";
    G2POptions        take;
    take.affine        = apic;
    take.flip_share    = apic ? 0 : 1;
    const auto prepare = [&]() { bench.set_motion(); };
    const auto sweep   = [&]() {
      grid_to_points<dim>(bench.body.points.view(),
                          bench.nodes.view(),
                          take,
                          nullptr);
    };
    bench.measure(name.c_str(), prepare, sweep);
    take.remap = true;
    bench.measure((name + ", re-map").c_str(), prepare, sweep);
    take.remap = false;
    take.move  = 1e-9;
    bench.measure((name + ", move").c_str(), prepare, sweep);
    if (!apic)
      bench.measure(
        "sort by cell", [] {}, [&]() { bench.body.points.sort_by_cell(); });
  }



  template <int dim>
  void
  measure_law(const std::string              &name,
              const std::string              &law,
              const std::string              &section,
              const std::vector<std::string> &treatments)
  {
    for (const std::string &treatment : treatments)
      {
        Bench<dim> bench(block<dim>(law, section, treatment, false));
        bench.set_motion();
        StressSweep what;
        what.step        = 1e-9;
        what.remapped    = true;
        what.move        = true;
        const auto sweep = [&]() {
          bench.body.stress->update(bench.body.points.view(),
                                    bench.nodes.view(),
                                    bench.sums_or_none(),
                                    what);
        };
        const auto label = "stress, " + name + ", " + treatment;
        bench.measure(
          label.c_str(), [] {}, sweep);
        if (treatment != "none")
          {
            what.relaxation = 1;
            bench.measure((label + ", replace").c_str(), [] {}, sweep);
          }
      }
  }



  template <int dim>
  void
  measure_all()
  {
    std::printf(
      "\n%dd: ns per point %28s %8s %8s\n", dim, "", "best", "median");
    if (has_domains())
      {
        measure_giving<dim>("none", false);
        measure_taking<dim>(false);
        measure_law<dim>("linear elastic", "linear elastic", "", {"none"});
        measure_law<dim>("neo-Hookean", "neo hookean", "", {"none"});
        return;
      }
    std::vector<std::string> treatments = {"none",
                                           "cell",
                                           "cell shear",
                                           "cell full"};
    if (kernel == "linear")
      treatments.push_back("assumed strain");
    const std::vector<std::string> of_fluids = {"none", "cell"};
    for (const std::string &treatment : treatments)
      measure_giving<dim>(treatment, false);
    measure_giving<dim>("cell", true);
    measure_taking<dim>(false);
    measure_taking<dim>(true);

    const auto fluid = [](const std::string &entries) {
      return "subsection Newtonian fluid\nset Bulk modulus = 1e6\n" + entries +
             "end\n";
    };
    measure_law<dim>("linear elastic", "linear elastic", "", treatments);
    measure_law<dim>("neo-Hookean", "neo hookean", "", treatments);
    measure_law<dim>("fluid", "newtonian fluid", fluid(""), of_fluids);
    measure_law<dim>("viscous fluid",
                     "newtonian fluid",
                     fluid("set Viscosity = 1\n"),
                     of_fluids);
    measure_law<dim>("fluid, Tait",
                     "newtonian fluid",
                     fluid("set Equation of state = tait\n"),
                     of_fluids);
  }
} // namespace



int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc > 1)
    n_repetitions = std::max(1, std::atoi(argv[1]));
  if (argc > 2)
    kernel = argv[2];
  if (kernel != "linear" && kernel != "quadratic" && kernel != "cubic" &&
      !has_domains())
    {
      std::fprintf(stderr,
                   "Error: The kernel '%s' is none of linear, quadratic, "
                   "cubic, gimp, cpgimp, cpdi, cpdi2.\n",
                   kernel.c_str());
      return 1;
    }
  measure_all<2>();
  measure_all<3>();
  return 0;
}
