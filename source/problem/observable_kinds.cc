// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/observable.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  const std::vector<ObservableKind<dim>> &
  observable_kinds()
  {
    using O    = const Observable<dim> &;
    using S    = const Seen<dim> &;
    using Part = ObservedPart;

    const std::vector<std::string> at_place  = {"Location"};
    const std::vector<std::string> component = {"Location", "Direction"};
    const std::vector<std::string> body      = {"Body"};
    const std::vector<std::string> in_column = {"From time"};
    // In the plane there is one axis to turn about.
    const std::vector<std::string> about_obstacle =
      dim == 2 ? std::vector<std::string>{"Obstacle"} :
                 std::vector<std::string>{"Obstacle", "Direction"};

    static const std::vector<ObservableKind<dim>> kinds = {
      {"displacement",
       "m",
       Part::place,
       component,
       body,
       [](O o, S s) { return s.displacement[o.axis]; }},
      {"velocity",
       "m/s",
       Part::place,
       component,
       body,
       [](O o, S s) { return s.velocity[o.axis]; }},
      {"stress",
       "Pa",
       Part::material,
       component,
       body,
       [](O o, S s) { return s.stress[o.axis][o.second_axis]; },
       2},
      {"pressure",
       "Pa",
       Part::material,
       at_place,
       body,
       [](O, S s) { return s.pressure; }},
      {"volume ratio",
       "",
       Part::material,
       at_place,
       body,
       [](O, S s) { return s.volume_ratio; }},
      {"state variable",
       "",
       Part::material,
       {"Location", "Variable"},
       body,
       [](O, S s) { return s.variable; }},
      {"largest state variable",
       "",
       Part::largest,
       {"Variable"},
       body,
       [](O, S s) { return s.variable; }},
      {"position",
       "m",
       Part::place,
       component,
       body,
       [](O o, S s) { return s.position[o.axis]; }},
      {"extreme coordinate",
       "m",
       Part::extent,
       {"Direction"},
       {"Body", "Within", "Share beyond"},
       [](O, S s) { return s.extent; }},
      {"mass within",
       "kg",
       Part::region,
       {"Within"},
       body,
       [](O, S s) { return s.mass; }},
      {"mean velocity",
       "m/s",
       Part::region,
       {"Within", "Direction"},
       body,
       [](O o, S s) { return s.velocity[o.axis]; }},
      {"mean pressure",
       "Pa",
       Part::region_material,
       {"Within"},
       body,
       [](O, S s) { return s.pressure; }},
      {"mean stress",
       "Pa",
       Part::region_material,
       {"Within", "Direction"},
       body,
       [](O o, S s) { return s.stress[o.axis][o.second_axis]; },
       2},
      {"kinetic energy",
       "J",
       Part::body,
       {},
       body,
       [](O, S s) { return s.kinetic_energy; }},
      {"strain energy",
       "J",
       Part::body,
       {},
       body,
       [](O, S s) { return s.strain_energy; }},
      {"total energy",
       "J",
       Part::body,
       {},
       body,
       [](O, S s) {
         return s.kinetic_energy + s.strain_energy + s.potential_energy;
       }},
      {"momentum",
       "kg m/s",
       Part::body,
       {"Direction"},
       body,
       [](O o, S s) { return s.momentum[o.axis]; }},
      {"centre of mass",
       "m",
       Part::body,
       {"Direction"},
       body,
       [](O o, S s) {
         return s.mass > 0 ? s.mass_moment[o.axis] / s.mass : not_known;
       }},
      {"frequency",
       "Hz",
       Part::column,
       {"Observable"},
       in_column,
       [](O, S s) { return s.frequency; }},
      {"mean over time",
       "",
       Part::column,
       {"Observable"},
       in_column,
       [](O, S s) { return s.mean; }},
      {"largest so far",
       "",
       Part::column,
       {"Observable"},
       in_column,
       [](O, S s) { return s.largest; }},
      {"smallest so far",
       "",
       Part::column,
       {"Observable"},
       in_column,
       [](O, S s) { return s.smallest; }},
      {"reaction force",
       "N",
       Part::side,
       {"Side", "Direction"},
       {},
       [](O o, S s) { return s.force[o.axis]; }},
      {"obstacle force",
       "N",
       Part::obstacle,
       {"Obstacle", "Direction"},
       {},
       [](O o, S s) { return s.force[o.axis]; }},
      {"obstacle moment",
       "N m",
       Part::obstacle,
       about_obstacle,
       {},
       [](O o, S s) { return s.moment[dim == 2 ? 2 : o.axis]; }}};
    return kinds;
  }



  template <int dim>
  const ObservableKind<dim> &
  observable_kind(const std::string &word)
  {
    const auto &kinds = observable_kinds<dim>();
    return *std::find_if(kinds.begin(), kinds.end(), [&](const auto &kind) {
      return kind.word == word;
    });
  }



  template const std::vector<ObservableKind<2>> &
  observable_kinds();
  template const std::vector<ObservableKind<3>> &
  observable_kinds();
  template const ObservableKind<2> &
  observable_kind(const std::string &);
  template const ObservableKind<3> &
  observable_kind(const std::string &);
} // namespace limber
