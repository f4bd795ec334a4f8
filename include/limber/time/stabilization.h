// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_stabilization_h
#define limber_time_stabilization_h

#include <limber/time/integrator.h>
#include <limber/transfer/hourglass.h>

#include <vector>

namespace limber
{
  /**
   * Stabilisation of modes that means over cells do not see: checkerboard
   * control of the pressure and hourglass control of the motion. A body that
   * asks for none costs nothing.
   */
  template <int dim>
  class Stabilization
  {
  public:
    explicit Stabilization(const RunParts<dim> &parts);

    /**
     * Checkerboard control: find what the volumetric variable of the points in
     * each cell is to lose over @p step, s, with waves of that speed, m/s. To
     * be called before P2G: the records of nodes at the corners of cells serve
     * here. Collective.
     */
    void
    control_checkerboards(double step, double wave_speed);

    /**
     * Hourglass control: add viscous forces against hourglass modes to those of
     * the nodes, and their heat to the ledger. Their own slots are zero
     * afterwards. Collective.
     */
    void
    resist_hourglass(double step, double wave_speed);

  private:
    double
    speed_of_resistance(const MaterialBody<dim> &body, double step) const;
    void
    resist_hourglass_of_field(double step);
    void
    find_hourglass_modes(double step);
    void
    lend_to_hanging_nodes();

    const RunParts<dim> parts;
    // Refilled in each step, which then allocates nothing
    std::vector<HourglassResistance<dim>> resisting;
    std::vector<HourglassModes<dim>>      hourglass_modes;
    LazyArray<double>                     hourglass_sums; // HourglassLayout
    RecordExchange hourglass_exchange{NodeLayout<dim>::stride};
  };
} // namespace limber

#endif
