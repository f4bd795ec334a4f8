// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_health_h
#define limber_output_health_h

#include <limber/materials/kernel.h>

#include <string>
#include <vector>

/**
 * @file Quality assessment of a run: figures of its end, each with a verdict,
 * what it means and the entry to change (doc/guide/health.md).
 */
namespace limber
{
  /** How good a figure is. */
  enum class Verdict
  {
    good,
    look, // may be meant; the text says what to look at
    bad   // results have errors of about this size
  };

  const char *
  name_of(Verdict verdict);



  /** One figure with its verdict. */
  struct HealthLine
  {
    std::string name; // a word: "energy"
    Verdict     verdict = Verdict::good;
    double      value   = 0; // dimensionless; not finite: unknown
    std::string text;        // the figure with its unit, and what it means
    std::string entry;       // to be changed, as "Section/Name"
  };



  /** Figures of one body; volumes in m^dim, energies in J. */
  struct BodyFigures
  {
    std::string  name;
    bool         is_liquid       = false;
    bool         is_plastic      = false; // may flow plastically
    bool         keeps_surface   = true;  // see Body
    bool         is_split        = false; // splits stretched points
    bool         stays_in_cells  = false; // 'Frame = initial'
    unsigned int points_per_edge = 2;     // the smallest of all directions
    KernelKind   kernel          = KernelKind::linear;

    // At the start
    unsigned long points       = 0;
    double        volume       = 0; // of its points
    double        shape_volume = 0;
    bool          is_cut       = false; // 'Placement' is 'cut' or 'fitted'
    double        overlap      = 0;     // share that lies in another body
    double        potential    = 0;     // weight times depth of a liquid
    std::string   overlaps_with;        // the name of that body
    std::string   overlap_place;        // its centre, as "0.5, 1"
    unsigned long gaps_at_start = 0;

    // At the end
    double        unseen_energy = 0; // kinetic, in the null space of P2G
    double        strain_energy = 0;
    double        crossings     = 0; // cells entered, mean over the points
    double        crossings_under_strain = 0; // weighted by strain energy
    double        most_crossings         = 0; // of one point
    double        elastic_share          = 1; // of the strain at these
    double        share_in_tension       = 0; // of its strain energy
    unsigned long cells                  = 0; // that hold points of it
    unsigned long inner_cells            = 0; // with neighbours along all axes
    unsigned long single_cells           = 0; // of these, with one point
    unsigned long gaps            = 0; // empty cells between two of the body
    double        smallest_volume = 1, largest_volume = 1; // of all J
    // Clumping of a liquid: volume of points in inner cells over that of these
    double filling    = 1;
    bool   is_shifted = false; // by 'Particle shifting'
    // Whether its law is for small strains, in the initial frame; and the angle
    // by which its points have rotated since the start, rms
    bool   stays_upright = false;
    double rotation      = 0;
  };



  /** Penetration into one obstacle at the end. */
  struct ObstacleFigures
  {
    std::string   name;
    unsigned long points_inside = 0; // deeper than a thousandth of a cell
    double        depth         = 0; // of the deepest, in edges of its cell
  };



  /** Figures of a run; energies in J. */
  struct HealthFigures
  {
    std::vector<BodyFigures>     bodies;
    std::vector<ObstacleFigures> obstacles; // in the order of the scene
    unsigned int                 dim          = 2;
    double                       energy_scale = 0;   // see Balance
    double                       inner_scale  = 0;   // see Balance
    double                       kinetic      = 0;   // energy of all points
    double                       drift        = 0;   // over the inner scale
    std::string                  against_splines;    // GridDescription
    bool                         has_levels = false; // cells of several sizes
    bool                         takes_apic = true;  // the scene, as a transfer
    std::string                  with_apic; // entries that it needs besides
    bool          knows_domains = true;     // the steps: cpdi and the like
    bool          may_hit = false; // obstacles, each other or sides that let go
    unsigned long points  = 0;
    double        put_back     = 0; // points, each time; see Ledger
    double        put_back_way = 0; // of all of them, cells
    // Points of liquids that were put out of obstacles, each time
    double put_out = 0;
    // Energy contributions in the ledger
    double transfer = 0, viscous = 0, history = 0, plastic = 0, friction = 0,
           contact = 0, adaptation = 0, sides = 0, loads = 0;
    // Part of 'viscous' that is lost by semi-implicit steps
    bool   is_semi_implicit = false;
    double lost_by_steps    = 0;
    bool   is_smoothed      = false; // by the transfer: pic, xpic, fmpm
    // Of implicit steps, J s, see Ledger
    bool   is_implicit    = false; // and has made enough steps to tell
    double kinetic_action = 0, action_of_changes = 0;
    // The entry that determines the time step
    std::string step_entry = "Method/Courant number";
  };



  /** All lines, in the order of the table of checks in health.cc. */
  std::vector<HealthLine>
  judge(const HealthFigures &figures);

  /** For the screen: good figures in one line, all others in one line each. */
  std::string
  health_text(const std::vector<HealthLine> &lines);

  /**
   * Numerical creep: share of the elastic strain that becomes permanent with
   * each cell crossing of a point, by kernel and points along the edge of a
   * cell.
   */
  double
  creep_per_crossing(const BodyFigures &body);
} // namespace limber

#endif
