// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_observed_row_h
#define limber_output_observed_row_h

#include <limber/output/frequency.h>
#include <limber/output/running_values.h>
#include <limber/problem/observable.h>

#include <algorithm>
#include <vector>

namespace limber
{
  /** Their names, in the order of the scene. */
  template <int dim>
  std::vector<std::string>
  names_of(const std::vector<Observable<dim>> &observables)
  {
    std::vector<std::string> result;
    for (const Observable<dim> &observable : observables)
      result.push_back(observable.name);
    return result;
  }



  /** Whether the kind follows a material point. */
  template <int dim>
  bool
  looks_at_place(const Observable<dim> &observable)
  {
    return observable.kind->looks_at == ObservedPart::place ||
           observable.kind->looks_at == ObservedPart::material;
  }



  /** What an observable of another one keeps of its rows; plain data, for
   * checkpoints. */
  struct ColumnOverTime
  {
    ZeroCrossings crossings;
    RunningValues values;
  };



  /**
   * The values of all observables at @p time, s, in the order of the scene.
   * look(i) returns what the observable of that number sees (Seen); those of
   * other columns come last and count on in their own entry of @p columns, one
   * call per row.
   */
  template <int dim, class Look>
  std::vector<double>
  observed_row(const std::vector<Observable<dim>> &observables,
               const double                        time,
               std::vector<ColumnOverTime>        &columns,
               const Look                         &look)
  {
    std::vector<double> values(observables.size(), not_known);
    for (unsigned int i = 0; i < values.size(); ++i)
      if (const Observable<dim> &observable = observables[i];
          observable.kind->looks_at != ObservedPart::column)
        if (const Seen<dim> seen = look(i); seen.known)
          values[i] = (observable.positive ? 1 : -1) *
                      observable.kind->value(observable, seen);

    for (unsigned int i = 0; i < values.size(); ++i)
      if (const Observable<dim> &observable = observables[i];
          observable.kind->looks_at == ObservedPart::column)
        {
          const auto of =
            std::find_if(observables.begin(),
                         observables.end(),
                         [&](const Observable<dim> &other) {
                           return other.name == observable.observable;
                         });
          const double value = time >= observable.from_time ?
                                 values[of - observables.begin()] :
                                 not_known;
          columns[i].crossings.add(time, value);
          columns[i].values.add(time, value);
          Seen<dim> seen;
          seen.frequency = columns[i].crossings.frequency();
          if (columns[i].values.any)
            {
              seen.mean     = columns[i].values.mean();
              seen.smallest = columns[i].values.smallest;
              seen.largest  = columns[i].values.largest;
            }
          values[i] = observable.kind->value(observable, seen);
        }
    return values;
  }
} // namespace limber

#endif
