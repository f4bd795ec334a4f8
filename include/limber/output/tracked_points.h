// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_tracked_points_h
#define limber_output_tracked_points_h

#include <deal.II/base/symmetric_tensor.h>

#include <limber/base/law_parameter.h>
#include <limber/output/point_stress.h>

#include <array>
#include <map>
#include <vector>

namespace limber
{
  /** A point that observables follow; plain, for checkpoints. */
  template <int dim>
  struct TrackedPoint
  {
    unsigned int       body = 0;
    std::uint64_t      id   = 0;
    dealii::Point<dim> reference; // where it was at the start, m
    bool               lost = false;
  };



  /** What is seen of a point; meaningless where it has been lost. */
  template <int dim>
  struct PointSample
  {
    bool                          lost = true;
    dealii::Point<dim>            position;         // m
    dealii::Tensor<1, dim>        velocity;         // m/s
    double                        volume_ratio = 1; // J
    double                        pressure = 0; // Cauchy, as PointStress, Pa
    dealii::SymmetricTensor<2, 3> stress;       // Cauchy, Pa
    // Those that the law has names for, in its order
    std::array<double, max_variables> variables{};
  };



  /**
   * Follows single points: they change their position in the arrays with each
   * sort and their rank with each synchronisation. The owner notices the former
   * itself; only where no rank has a point do all of them search for it.
   */
  template <int dim>
  class TrackedPoints
  {
  public:
    TrackedPoints() = default;
    explicit TrackedPoints(const std::vector<TrackedPoint<dim>> &points);

    /**
     * Tracks the point of the body that is nearest to the place, of several the
     * first by coordinates, whatever the number of ranks. Returns its number
     * here; a point that is tracked already keeps its own. Collective.
     */
    unsigned int
    follow_nearest(const State<dim>         &state,
                   const unsigned int        body,
                   const dealii::Point<dim> &place);

    /**
     * Evaluates all tracked points. Pressure and stress are filled for those of
     * @p with_stress only, since averages cost a pass over the points of the
     * body. Collective: one reduction, another after a point has changed its
     * rank, and what averages need.
     */
    std::vector<PointSample<dim>>
    sample(const State<dim> &state, const std::vector<bool> &with_stress);

    const std::vector<TrackedPoint<dim>> &
    points() const
    {
      return tracked;
    }

  private:
    void
    revalidate(const State<dim> &state, const unsigned int t);
    void
    search(const State<dim> &state, const unsigned int t);
    using Stresses = std::map<unsigned int, PointStress<dim>>; // by body

    std::vector<double>
    collect(const State<dim>        &state,
            const Stresses          &stresses,
            const std::vector<bool> &with_stress) const;

    static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

    std::vector<TrackedPoint<dim>> tracked;
    std::vector<std::size_t>       index; // in the arrays of this rank
  };
} // namespace limber

#endif
