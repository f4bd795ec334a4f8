// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_observables_h
#define limber_output_observables_h

#include <limber/output/observed_row.h>
#include <limber/output/region_sums.h>
#include <limber/output/totals.h>
#include <limber/output/tracked_points.h>

#include <vector>

namespace limber
{
  /** What observables keep from one row to the next; plain data, for
   * checkpoints. */
  template <int dim>
  struct ObservablesState
  {
    std::vector<TrackedPoint<dim>> tracked;
    std::vector<unsigned int>      tracked_of; // per observable, or invalid
    std::vector<ColumnOverTime>    columns;    // per observable
    bool                           has_row = false;
    double                         time    = 0; // of the last row, s
    // on the material until then, kg m/s, and the force since the row before
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse;
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_force; // N
    // The same of obstacles: N, N m
    std::vector<ObstacleAction<dim>> obstacle_impulse, obstacle_force;
  };



  /**
   * The observables of the scene in every row, in its order. Unknown values are
   * NaN: the displacement of a lost point, the extreme of no point, a frequency
   * before the second crossing of zero.
   */
  template <int dim>
  class Observables
  {
  public:
    /** Chooses the points to be tracked; after seeding, collective. */
    explicit Observables(const State<dim> &start);

    /** Restores those of a checkpoint. */
    void
    restore(const ObservablesState<dim> &former);

    /** Note the reaction forces of a step without a row: rows have the mean
     * force since the last note or row, that is, in quasi-static steps, the one
     * of the last equilibrium. */
    void
    follow_forces(double time, const Totals<dim> &totals);

    /** A row; frequencies and reaction forces count on one per call. */
    std::vector<double>
    evaluate(const State<dim> &state, const Totals<dim> &totals);

    ObservablesState<dim>
    state() const;

  private:
    void
    decide_what_to_sample();
    Seen<dim>
    look(unsigned int                         number,
         const Totals<dim>                   &totals,
         const std::vector<PointSample<dim>> &samples,
         const std::vector<double>           &extents,
         const std::vector<RegionSums<dim>>  &regions) const;
    std::vector<double>
    extents(const State<dim> &state) const;
    std::vector<RegionSums<dim>>
    regions(const State<dim> &state) const;
    unsigned int
    body_index(const std::string &name) const;
    BodyTotals<dim>
    totals_of(const Observable<dim> &observable,
              const Totals<dim>     &totals) const;

    const Problem<dim>   &problem;
    ObservablesState<dim> memory;
    TrackedPoints<dim>    points;
    std::vector<bool>     with_stress; // per tracked point
    bool                  has_extremes = false, has_regions = false;
  };
} // namespace limber

#endif
