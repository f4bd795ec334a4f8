// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <limber/simulation/run_state.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace limber
{
  // One list of members for all purposes: written to a file, read from it, and
  // tested for finite numbers.

  template <class Archive>
  void
  serialize(Archive &archive, CheckedValue &value, const unsigned int)
  {
    archive &value.distance &value.value;
  }



  template <class Archive>
  void
  serialize(Archive &archive, ZeroCrossings &crossings, const unsigned int)
  {
    archive &crossings.last_time &crossings.last_value &crossings
      .side &crossings.swing_sign &crossings.swing &crossings.count &crossings
      .first &crossings.last &crossings.before &crossings.entered &crossings
      .is_crossing;
  }



  template <class Archive>
  void
  serialize(Archive &archive, RunningValues &values, const unsigned int)
  {
    archive &values.any &values.first_time &values.last_time &values
      .last_value &values.integral &values.smallest &values.largest;
  }



  template <class Archive>
  void
  serialize(Archive &archive, ColumnOverTime &column, const unsigned int)
  {
    archive &column.crossings &column.values;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, TrackedPoint<dim> &point, const unsigned int)
  {
    archive &point.body &point.id &point.reference &point.lost;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, ObstacleAction<dim> &action, const unsigned int)
  {
    archive &action.impulse &action.moment;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, ObservablesState<dim> &state, const unsigned int)
  {
    archive &state.tracked &state.tracked_of &state.columns &state
      .has_row &state.time &state.side_impulse &state.side_force &state
      .obstacle_impulse &state.obstacle_force;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, BalanceState<dim> &state, const unsigned int)
  {
    archive &state.kinetic_energy &state.strain_energy &state
      .gravitational_energy &state.momentum &state.mass &state.stiffness &state
      .energy_scale &state.inner_scale &state.momentum_scale;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, Ledger<dim> &ledger, const unsigned int)
  {
    archive &ledger.transfer &ledger.boundary_work &ledger.load_work &ledger
      .viscous &ledger.by_steps &ledger.history &ledger.plastic &ledger
      .friction &ledger.contact &ledger.adaptation &ledger
      .kinetic_action &ledger.action_of_changes &ledger.load_impulse &ledger
      .gravity_impulse &ledger.side_impulse &ledger.put_back &ledger
      .put_back_way &ledger.put_out &ledger.lost_mass &ledger
      .lost_energy &ledger.lost_momentum &ledger.lost_points &ledger.obstacles;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, IntegratorState<dim> &state, const unsigned int)
  {
    archive &state.wave_speed &state.point_speed &state.displacement &state
      .largest_mass &state.steps_since_filter &state.step &state
      .way_since_shifting &state.largest_force &state.compliance &state
      .face_pieces &state.filtered_nodes &state.kept_nodes;
  }



  template <class Archive>
  void
  serialize(Archive &archive, WriterState &state, const unsigned int)
  {
    archive &state.points &state.grid;
  }



  template <class Archive>
  void
  serialize(Archive &archive, AdaptationState &state, const unsigned int)
  {
    archive &state.mesh &state.wanted &state.next_id &state.points_added &state
      .way &state.steps &state.times_asked &state.mesh_changes &state
      .points_split &state.points_joined;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, RunState<dim> &state, const unsigned int)
  {
    archive &state.step &state.time &state.step_size &state.ledger &state
      .integrator &state.adaptation &state.balance &state.observables &state
      .checks &state.pictures &state.next_pictures &state
      .statistics_length                           &state.warnings;
  }


  namespace
  {
    /** An archive that keeps nothing but whether all numbers are finite. */
    class FiniteNumbers
    {
    public:
      template <class T>
      FiniteNumbers &
      operator&(const T &value)
      {
        look_at(value);
        return *this;
      }

      bool all = true;

    private:
      template <class T>
      void
      look_at(const T &value)
      {
        if constexpr (std::is_arithmetic_v<T>)
          all = all && std::isfinite(static_cast<double>(value));
        else
          serialize(*this, const_cast<T &>(value), 0);
      }

      template <int dim>
      void
      look_at(const dealii::Tensor<1, dim> &value)
      {
        for (int d = 0; d < dim; ++d)
          look_at(value[d]);
      }

      template <int dim>
      void
      look_at(const dealii::Point<dim> &value)
      {
        look_at(static_cast<const dealii::Tensor<1, dim> &>(value));
      }

      template <int dim>
      void
      look_at(const FacePiece<dim> &value)
      {
        const_cast<FacePiece<dim> &>(value).serialize(*this, 0);
      }

      template <int dim>
      void
      look_at(const FilteredNode<dim> &value)
      {
        const_cast<FilteredNode<dim> &>(value).serialize(*this, 0);
      }

      template <int dim>
      void
      look_at(const KeptNode<dim> &value)
      {
        const_cast<KeptNode<dim> &>(value).serialize(*this, 0);
      }

      template <class T>
      void
      look_at(const std::vector<T> &values)
      {
        for (const T &value : values)
          look_at(value);
      }

      template <class T, std::size_t n>
      void
      look_at(const std::array<T, n> &values)
      {
        for (const T &value : values)
          look_at(value);
      }

      template <class T>
      void
      look_at(const std::pair<T, std::string> &value)
      {
        look_at(value.first);
      }

      void
      look_at(const std::map<std::string, unsigned int> &)
      {}

      // Not tested: initial values of checks are infinite and NaN.
      void
      look_at(const CheckedValue &)
      {}
    };



    /** Times of pictures ascend up to now, and each has both files. */
    bool
    in_order(const WriterState &pictures, const double now)
    {
      if (pictures.points.size() != pictures.grid.size())
        return false;
      double last = 0;
      for (std::size_t i = 0; i < pictures.points.size(); ++i)
        {
          const double time = pictures.points[i].first;
          if (!(time >= last && time <= now) || pictures.grid[i].first != time)
            return false;
          last = time;
        }
      return true;
    }



    /**
     * Whether all arrays have equal lengths, and the same points are tracked.
     */
    template <int dim>
    bool
    same_shape(const RunState<dim> &state, const RunState<dim> &start)
    {
      const ObservablesState<dim> &a = state.observables,
                                  &b = start.observables;
      if (a.tracked_of != b.tracked_of || a.tracked.size() != b.tracked.size())
        return false;
      for (std::size_t i = 0; i < a.tracked.size(); ++i)
        if (a.tracked[i].body != b.tracked[i].body)
          return false;
      return a.columns.size() == b.columns.size() &&
             state.adaptation.next_id.size() ==
               start.adaptation.next_id.size() &&
             state.checks.size() == start.checks.size() &&
             state.integrator.face_pieces.size() ==
               start.integrator.face_pieces.size();
    }
  } // namespace



  template <int dim>
  std::vector<char>
  to_bytes(const RunState<dim> &state)
  {
    return dealii::Utilities::pack(state, /*allow_compression=*/false);
  }



  template <int dim>
  RunState<dim>
  to_run_state(const std::vector<char> &bytes)
  {
    try
      {
        return dealii::Utilities::unpack<RunState<dim>>(
          bytes, /*allow_compression=*/false);
      }
    catch (const std::exception &)
      {
        // Boost's own words, or a length that no memory has room for
        throw std::runtime_error("not the state of a run");
      }
  }



  template <int dim>
  std::string
  fault_of(const RunState<dim> &state, const RunState<dim> &start)
  {
    FiniteNumbers finite;
    finite       &state;
    if (!finite.all)
      return "has values in 'run' that are not finite";
    if (state.time < 0 || state.step_size < 0 || state.next_pictures < 0)
      return "has negative times in 'run'";
    for (const ColumnOverTime &column : state.observables.columns)
      if (std::abs(column.crossings.side) > 1 ||
          std::abs(column.crossings.swing_sign) > 1)
        return "has a sign in 'run' that is none";
    if (!in_order(state.pictures, state.time))
      return "has pictures in 'run' that are not in order";
    if (!same_shape(state, start))
      return "has another number of observables, checks or loads in 'run'";
    return "";
  }



  template std::vector<char>
  to_bytes(const RunState<2> &);
  template std::vector<char>
  to_bytes(const RunState<3> &);
  template RunState<2>
  to_run_state<2>(const std::vector<char> &);
  template RunState<3>
  to_run_state<3>(const std::vector<char> &);
  template std::string
  fault_of(const RunState<2> &, const RunState<2> &);
  template std::string
  fault_of(const RunState<3> &, const RunState<3> &);
} // namespace limber
