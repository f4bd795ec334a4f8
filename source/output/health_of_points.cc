// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/health_checks.h>

#include <algorithm>
#include <limits>

namespace limber
{
  HealthLine
  judge_put_back(const HealthFigures &figures, const HealthCheck &check)
  {
    HealthLine line;
    line.value   = figures.points > 0 ? figures.put_back / figures.points : 0;
    line.verdict = check.verdict(line.value);
    line.text    = figures.put_back > 0 ?
                     "points were put back " + brief(figures.put_back) +
                    " times that had gone beyond closed sides, by " +
                    brief(figures.put_back_way / figures.put_back) +
                    " cells on average" :
                     "no point went beyond a closed side";
    if (line.verdict != Verdict::good)
      line.text += ": nodes of hardly any mass at the side move too fast; "
                   "take shorter steps";
    line.entry = figures.step_entry;
    return line;
  }



  HealthLine
  judge_mass(const HealthFigures &figures, const HealthCheck &check)
  {
    const auto error = [](const BodyFigures &b) {
      return b.shape_volume > 0 ? b.volume / b.shape_volume - 1 : 0;
    };
    const BodyFigures &body = worst(figures, error);
    HealthLine         line;
    line.value   = error(body);
    line.verdict = check.verdict(line.value);
    line.text    = "the points of body '" + body.name + "' fill " +
                percent(1 + line.value) + " of its shape";
    line.entry =
      of_body(body, body.is_cut ? "Points per cell edge" : "Placement");
    if (line.verdict != Verdict::good)
      line.text +=
        body.is_cut ?
          std::string(": it is too thin for the parts of cells that "
                      "points stand for; take more points per cell "
                      "edge") :
          ", and so of its mass and load: places in cells are in "
          "or out as a whole; set 'cut'" +
            std::string(figures.has_levels ? "" :
                                             ", or 'fitted' for a box or "
                                             "block");
    return line;
  }



  HealthLine
  judge_overlap(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body =
      worst(figures, [](const BodyFigures &b) { return b.overlap; });
    HealthLine line;
    line.value   = body.overlap;
    line.verdict = check.verdict(line.value);
    line.entry   = of_body(body, "Shape");
    line.text    = body.overlap > 0 ?
                     percent(body.overlap) + " of body '" + body.name +
                    "' lay in body '" + body.overlaps_with +
                    "' at the start, around (" + body.overlap_place +
                    "): there are two masses in one place" :
                     "no body lay in another one at the start";
    return line;
  }



  namespace
  {
    /** Cells that have lost all points (numerical fracture), as a share of the
     * occupied cells. */
    double
    share_of_gaps(const BodyFigures &body)
    {
      const double opened = double(body.gaps) - double(body.gaps_at_start);
      return body.is_liquid || body.cells == 0 ?
               0 :
               std::max(0., opened) / body.cells;
    }
  } // namespace



  HealthLine
  judge_gaps(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body = worst(figures, share_of_gaps);
    HealthLine         line;
    line.value   = share_of_gaps(body);
    line.verdict = check.verdict(line.value);
    line.entry =
      of_body(body,
              body.is_plastic || body.is_split ? "Points per cell edge" :
                                                 "Split stretched points");
    line.text = line.value > 0 ?
                  "body '" + body.name + "' has come apart on the grid: " +
                    std::to_string(body.gaps - body.gaps_at_start) +
                    " empty cells have opened between its " +
                    std::to_string(body.cells) +
                    ". Points that stand further apart than a cell do not hold "
                    "together" :
                  "no cell within a solid has lost its points";
    return line;
  }



  namespace
  {
    double
    share_of_single(const BodyFigures &body)
    {
      return body.inner_cells == 0 ?
               0 :
               double(body.single_cells) / body.inner_cells;
    }
  } // namespace



  HealthLine
  judge_points(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body = worst(figures, share_of_single);
    HealthLine         line;
    line.value   = share_of_single(body);
    line.verdict = check.verdict(line.value);
    line.text    = std::to_string(body.single_cells) + " of " +
                std::to_string(body.inner_cells) + " inner cells of body '" +
                body.name + "' hold one point alone";

    const BodyFigures &smallest =
      *std::min_element(figures.bodies.begin(),
                        figures.bodies.end(),
                        [](const BodyFigures &a, const BodyFigures &b) {
                          return a.points < b.points;
                        });
    // A body of four points across hardly resolves more than its rigid
    // motion.
    const unsigned long few = figures.dim == 2 ? 16 : 64;
    if (line.verdict == Verdict::good && smallest.points < few)
      {
        line.verdict = Verdict::look;
        line.text    = "body '" + smallest.name + "' has only " +
                    std::to_string(smallest.points) +
                    " points, too few for more than its motion as a whole";
        line.entry = of_body(smallest, "Points per cell edge");
      }
    else
      line.entry = of_body(body, "Points per cell edge");
    return line;
  }



  namespace
  {
    /** Largest |log J| of the points of a body. */
    double
    change_of_volume(const BodyFigures &body)
    {
      if (!(body.smallest_volume > 0))
        return std::numeric_limits<double>::infinity();
      return std::max(-std::log(body.smallest_volume),
                      std::log(body.largest_volume));
    }
  } // namespace



  HealthLine
  judge_volume(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body = worst(figures, change_of_volume);
    HealthLine         line;
    line.value   = change_of_volume(body);
    line.verdict = check.verdict(line.value);
    line.text    = "the points of body '" + body.name + "' have " +
                brief(body.smallest_volume) + " to " +
                brief(body.largest_volume) + " times their first volume";
    line.entry = "Grid/Cells";
    return line;
  }



  HealthLine
  judge_clumping(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body = worst(figures, [](const BodyFigures &b) {
      return b.is_liquid ? b.filling : 0;
    });
    HealthLine         line;
    line.value   = std::max(0., body.filling - 1);
    line.verdict = check.verdict(line.value);
    const bool may_shift =
      body.kernel == KernelKind::linear || body.kernel == KernelKind::quadratic;
    line.entry =
      may_shift ? of_body(body, "Particle shifting") : "Method/Kernel";
    line.text = "points in inner cells of liquid '" + body.name +
                "' stand for " + brief(body.filling) + " times their volume";
    if (line.verdict != Verdict::good)
      line.text +=
        ": they clump, so that it takes less room than it should. " +
        std::string(
          !may_shift ?
            "With 'linear' or 'quadratic' functions 'Particle "
            "shifting' keeps the volume" :
          figures.is_semi_implicit ?
            "Three points per cell edge or smaller cells keep it "
            "better" :
          !body.is_shifted ?
            "Set 'Particle shifting = auto' and 'Locking treatment "
            "= cell'" :
          body.kernel == KernelKind::linear ?
            "Three points per cell edge, smaller cells or "
            "'Time integration = semi-implicit' keep it better" :
            "Three points per cell edge" +
              (figures.takes_apic ?
                 ", smaller cells or 'Transfer = apic'" + figures.with_apic :
                 " or smaller cells") +
              " keep it better");
    return line;
  }



  HealthLine
  judge_obstacles(const HealthFigures &figures, const HealthCheck &check)
  {
    const ObstacleFigures &deepest =
      *std::max_element(figures.obstacles.begin(),
                        figures.obstacles.end(),
                        [](const auto &a, const auto &b) {
                          return a.depth < b.depth;
                        });
    unsigned long inside = 0;
    for (const ObstacleFigures &obstacle : figures.obstacles)
      inside += obstacle.points_inside;
    HealthLine line;
    line.value   = deepest.depth;
    line.verdict = check.verdict(line.value);
    line.text    = inside > 0 ? std::to_string(inside) +
                               " points are inside obstacles, the deepest by " +
                               brief(deepest.depth) + " of a cell in '" +
                               deepest.name + "'" :
                                "no point is inside an obstacle";
    if (figures.put_out > 0)
      line.text += "; " + brief(figures.put_out) +
                   " times points were put out onto a surface";
    line.entry = "Grid/Cells";
    return line;
  }



  HealthLine
  judge_rotation(const HealthFigures &figures, const HealthCheck &check)
  {
    const BodyFigures &body =
      worst(figures, [](const BodyFigures &one) { return one.rotation; });
    HealthLine line;
    line.value   = body.rotation;
    line.verdict = check.verdict(line.value);
    line.entry   = of_body(body, "Material");
    line.text    = "the points of body '" + body.name + "' have turned by " +
                brief(body.rotation) + " rad (rms)";
    if (line.verdict != Verdict::good)
      line.text += ", which in 'linear elastic' is a strain of about " +
                   percent(0.5 * body.rotation * body.rotation) +
                   ". Set 'Material = neo hookean'";
    return line;
  }
} // namespace limber
