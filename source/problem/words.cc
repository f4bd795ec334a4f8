// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>
#include <limber/problem/words.h>

namespace limber
{
  const Words<LawDescription> &
  law_words()
  {
    static const Words<LawDescription> words = []() {
      Words<LawDescription> result;
      for (const LawDescription &law : describe_laws())
        result.push_back({law.name, law, law.text});
      return result;
    }();
    return words;
  }



  const Words<RefinementCriterion> &
  criterion_words()
  {
    static const Words<RefinementCriterion> words = {
      {"region", RefinementCriterion::region, "all cells"},
      {"body",
       RefinementCriterion::body,
       "cells with points of the bodies in 'Bodies'"},
      {"surface",
       RefinementCriterion::surface,
       "cells with points that are near an empty one"},
      {"obstacle",
       RefinementCriterion::obstacle,
       "cells near the surface of an obstacle"},
      {"contact",
       RefinementCriterion::contact,
       "cells with points that are near those of a body that may part from "
       "theirs ('Contact/Pairs')"},
      {"stress",
       RefinementCriterion::stress,
       "cells whose mean stress differs from that of a neighbour by more than "
       "'Scale'"},
      {"rate",
       RefinementCriterion::rate,
       "cells that are sheared so fast that h |dev D| over the wave speed is "
       "more than 'Scale'"},
      {"plastic strain",
       RefinementCriterion::plastic_strain,
       "cells where the mean of the equivalent plastic strain is more than "
       "'Scale'"}};
    return words;
  }



  const Words<KernelKind> &
  kernel_words()
  {
    static const Words<KernelKind> words = {
      {"auto",
       KernelKind::automatic,
       "'quadratic' if points of a solid may cross cells, or a body that a "
       "side holds may bend across them, where the time integration knows "
       "splines and no liquid is in the scene; on cells of several sizes "
       "'cpdi' instead; else 'linear'"},
      {"linear", KernelKind::linear, "Q1 shape functions of the grid"},
      {"quadratic",
       KernelKind::quadratic,
       "quadratic B-splines, smooth from cell to cell"},
      {"cubic",
       KernelKind::cubic,
       "cubic B-splines, smoother still, for twice the time"},
      {"gimp",
       KernelKind::gimp,
       "generalised interpolation: means over boxes of fixed size around the "
       "points of solids; liquids have linear functions"},
      {"cpgimp",
       KernelKind::cpgimp,
       "the same with boxes that follow the stretch"},
      {"cpdi",
       KernelKind::cpdi,
       "convected particle domains of solids; liquids have linear functions"},
      {"cpdi2",
       KernelKind::cpdi2,
       "the same with corners that move with the grid, so that domains leave "
       "no gaps"},
      {"ddmp",
       KernelKind::ddmp,
       "dual domain method: linear functions; gradients of solids partly come "
       "from the nodes and are continuous from cell to cell"}};
    return words;
  }



  const Words<TimeIntegration> &
  time_integration_words()
  {
    static const Words<TimeIntegration> words = {
      {"explicit", TimeIntegration::explicit_steps, "symplectic Euler"},
      {"semi-implicit",
       TimeIntegration::semi_implicit,
       "the pressure of liquids, and of elastic solids with 'Locking treatment "
       "= cell', is that of the end of the step, so that sound in them does not "
       "limit it"},
      {"auto",
       TimeIntegration::explicit_steps,
       "'semi-implicit' where sound in a liquid is thirty times as fast as all "
       "else and everything in the scene goes with it, otherwise 'explicit'"},
      {"implicit",
       TimeIntegration::implicit_steps,
       "the generalised-alpha method, or with 'Spectral radius at infinity = "
       "1' Newmark's trapezoidal rule; solids, solved by Newton's method, "
       "with steps of any length"},
      {"quasi-static",
       TimeIntegration::quasi_static,
       "solids in equilibrium under growing loads, solved by Newton's "
       "method; time counts the load"}};
    return words;
  }



  const Words<StressUpdateOrder> &
  stress_update_words()
  {
    static const Words<StressUpdateOrder> words = {
      {"auto",
       StressUpdateOrder::automatic,
       "'usavg' for solids with linear functions or in their initial frame, "
       "'usl' with the transfers 'fmpm' and 'xpic', else 'musl'; the log says "
       "which"},
      {"usf", StressUpdateOrder::usf, "before the forces", "first"},
      {"usl", StressUpdateOrder::usl, "with the moved nodes", "last"},
      {"musl",
       StressUpdateOrder::musl,
       "velocity gradient from the updated points",
       "last, remapped"},
      {"usavg",
       StressUpdateOrder::usavg,
       "half of it first, half last; second order, keeps energy",
       "both ends"}};
    return words;
  }



  const Words<Transfer> &
  transfer_words()
  {
    static const Words<Transfer> words = {
      {"pic", Transfer::pic, "points take the velocity; strong damping"},
      {"flip", Transfer::flip, "points take the change of velocity"},
      {"apic", Transfer::apic, "points carry an affine velocity field"},
      {"aflip",
       Transfer::aflip,
       "the same, but points take the change of velocity"},
      {"fmpm",
       Transfer::fmpm,
       "points take the velocity, with the full mass matrix to some order"},
      {"xpic",
       Transfer::xpic,
       "the same of the velocity before the step, and its change"}};
    return words;
  }



  const Words<Placement> &
  placement_words()
  {
    static const Words<Placement> words = {
      {"auto",
       Placement::automatic,
       "'regular', but 'gauss' for boxes, blocks, balls, cylinders and "
       "formulas in their initial frame (except linear functions with the "
       "treatment 'none'); 'cut' for balls, cylinders and formulas of "
       "solids with splines that nothing may touch; for boxes and blocks of "
       "solids on cells of one size 'cut' if their faces run across the cells, or "
       "'regular' would miss the volume by more than 2 % (with several "
       "bodies, the faces); 'fitted' with domains, or linear functions and "
       "contact; for liquids with linear functions 'cut', for boxes that "
       "nothing may touch if 'regular' would miss the volume by more than 0.1 "
       "%, beside obstacles unless they are boxes of whole parts"},
      {"regular", Placement::regular, "evenly, at the centres of the parts"},
      {"gauss",
       Placement::gauss,
       "Gauss-Legendre places, weighted masses; in cells that the surface "
       "cuts, in a box of the volume, centroid and second moments of what is "
       "inside"},
      {"jittered", Placement::jittered, "regular, moved at random"},
      {"cut",
       Placement::cut,
       "regular, but parts that the surface cuts count with the volume and at "
       "the centroid of what is inside"},
      {"fitted",
       Placement::fitted,
       "on a lattice of the body's own, which fills it exactly; only box and "
       "block"}};
    return words;
  }



  const Words<ReferenceElement> &
  reference_element_words()
  {
    static const Words<ReferenceElement> words = {
      {"Q1", ReferenceElement::q1, "bilinear or trilinear"},
      {"Q2", ReferenceElement::q2, "biquadratic or triquadratic"},
      {"Q1-P0-P0",
       ReferenceElement::q1_p0_p0,
       "Q1 with constant pressure and volume ratio"},
      {"Q2-P1-P1",
       ReferenceElement::q2_p1_p1,
       "Q2 with linear pressure and volume ratio"}};
    return words;
  }



  const Words<ReferenceMethod> &
  reference_method_words()
  {
    static const Words<ReferenceMethod> words = {
      {"quasi-static",
       ReferenceMethod::quasi_static,
       "equilibrium; the loads follow 'Loads/Load factor' where 'Method/Time "
       "integration' is quasi-static, else those of the end time grow evenly"},
      {"implicit",
       ReferenceMethod::implicit_steps,
       "Newmark's method with the damping of Hilber, Hughes and Taylor"},
      {"auto",
       ReferenceMethod::implicit_steps,
       "'quasi-static' where 'Method/Time integration' is, else 'implicit'"},
      {"explicit",
       ReferenceMethod::explicit_steps,
       "central differences, lumped mass"}};
    return words;
  }



  const Words<Frame> &
  frame_words()
  {
    static const Words<Frame> words = {
      {"auto",
       Frame::automatic,
       "'initial' for one elastic body, with implicit and quasi-static steps "
       "also one of metal or several that are one piece, with quasi-static ones "
       "of any solid, that a side holds or that has no walls to meet, and for "
       "compact rubber that meets smooth ones; else 'current'"},
      {"current",
       Frame::current,
       "where the points are: bodies may flow, meet and cross cells"},
      {"initial",
       Frame::initial,
       "where they were at the start: nothing crosses a cell, for one solid "
       "that meets nobody, with implicit and quasi-static steps also for several "
       "that are one piece"}};
    return words;
  }



  const Words<Treatment> &
  locking_words()
  {
    static const Words<Treatment> words = []() {
      Words<Treatment> result;
      for (const TreatmentRow &treatment : treatments)
        result.push_back({treatment.word, treatment.kind, treatment.text});
      return result;
    }();
    return words;
  }



  const Words<HourglassResponse> &
  hourglass_words()
  {
    static const Words<HourglassResponse> words = {
      {"auto",
       HourglassResponse::automatic,
       "'incompressible' if the material flows plastically, else 'bending'"},
      {"bending",
       HourglassResponse::bending,
       "as a beam bends, from the moduli of the material"},
      {"deviatoric",
       HourglassResponse::deviatoric,
       "the deviator of what the nodes do"},
      {"incompressible",
       HourglassResponse::incompressible,
       "without change of volume"}};
    return words;
  }



  const Words<HistoryTreatment> &
  history_words()
  {
    static const Words<HistoryTreatment> words = {
      {"keep", HistoryTreatment::keep, "every point keeps its own"},
      {"relax",
       HistoryTreatment::relax,
       "it tends to the mean of the cell within 'Relaxation time'"},
      {"crossing",
       HistoryTreatment::crossing,
       "the same within the time in which the fastest point crosses a cell"},
      {"replace",
       HistoryTreatment::replace,
       "it is set to the mean of the cell in every step"}};
    return words;
  }



  const Words<HistoryTreatment> &
  volume_history_words()
  {
    static const Words<HistoryTreatment> words = [] {
      Words<HistoryTreatment> all = {
        {"auto",
         HistoryTreatment::keep, // until choose_histories() knows more
         "'crossing' for liquids in explicit steps with linear functions on "
         "equal cells where a side moves or an obstacle turns, else 'keep'"}};
      const auto &others = history_words();
      all.insert(all.end(), others.begin(), others.end());
      return all;
    }();
    return words;
  }

} // namespace limber
