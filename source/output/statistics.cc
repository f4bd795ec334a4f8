// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/statistics.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace limber
{
  namespace
  {
    void
    append_number(std::string &text, const double value)
    {
      if (std::isnan(value))
        {
          text += "nan"; // without the sign that some processors give it
          return;
        }
      char       digits[32];
      const auto end = std::to_chars(digits, digits + sizeof(digits), value);
      text.append(digits, end.ptr);
    }



    /** The path of a table that has the rows a checkpoint counts on. */
    const std::string &
    with_rows(const std::string &path, const std::uintmax_t length)
    {
      std::error_code      error;
      const std::uintmax_t present = std::filesystem::file_size(path, error);
      if (error || present < length)
        throw FileError("The table '" + path + "' has fewer than the " +
                        std::to_string(length) +
                        " bytes that the checkpoint counts on. Usually it was "
                        "edited or removed after the checkpoint. Restore it, "
                        "or start the run anew in another "
                        "'Output/Directory'.");
      return path;
    }
  } // namespace



  Statistics::Statistics(const std::string         &path,
                         const std::vector<Column> &columns)
    : n_columns(columns.size())
    , file(path, TextFile::Mode::create)
    , last_flush(std::chrono::steady_clock::now())
  {
    for (std::size_t c = 0; c < columns.size(); ++c)
      {
        buffer += "# " + std::to_string(c + 1) + ": " + columns[c].name;
        if (!columns[c].unit.empty())
          buffer += " [" + columns[c].unit + "]";
        buffer += '\n';
      }
    flush();
  }



  Statistics::Statistics(const std::string   &path,
                         const std::uintmax_t length,
                         const unsigned int   n_columns)
    : n_columns(n_columns)
    , file(with_rows(path, length), TextFile::Mode::append)
    , written(length)
    , last_flush(std::chrono::steady_clock::now())
  {
    file.shorten(length);
  }



  Statistics::~Statistics()
  {
    try
      {
        flush();
      }
    catch (const FileError &)
      {} // another failure is on its way
  }



  void
  Statistics::add(const std::vector<double> &row)
  {
    if (row.size() != n_columns)
      throw std::logic_error("a row of the statistics has another length");
    for (std::size_t c = 0; c < row.size(); ++c)
      {
        if (c > 0)
          buffer += ' ';
        append_number(buffer, row[c]);
      }
    buffer += '\n';

    // Seldom enough for slow file systems, often enough for who watches.
    constexpr std::size_t full = 1 << 16;
    const auto            now  = std::chrono::steady_clock::now();
    if (buffer.size() > full || now - last_flush > std::chrono::seconds(1))
      flush();
  }



  void
  Statistics::flush()
  {
    if (buffer.empty())
      return;
    file.write(buffer);
    written += buffer.size();
    buffer.clear();
    last_flush = std::chrono::steady_clock::now();
  }



  void
  Statistics::close()
  {
    flush();
    file.close();
  }



  namespace
  {
    template <int dim>
    bool
    may_flow(const Problem<dim> &problem)
    {
      return std::any_of(problem.bodies.begin(),
                         problem.bodies.end(),
                         [](const auto &body) { return body.is_plastic; });
    }



    /** Whether anything slides with friction. */
    template <int dim>
    bool
    may_rub(const Problem<dim> &problem)
    {
      const auto rubs = [](const auto &one) { return one.friction > 0; };
      return std::any_of(problem.sides.begin(), problem.sides.end(), rubs) ||
             std::any_of(problem.contacts.begin(),
                         problem.contacts.end(),
                         rubs) ||
             std::any_of(problem.obstacles.begin(),
                         problem.obstacles.end(),
                         rubs);
    }



    /** Whether bodies may press on each other or an obstacle and part. */
    template <int dim>
    bool
    may_part(const Problem<dim> &problem)
    {
      return !problem.obstacles.empty() ||
             std::any_of(problem.sides.begin(),
                         problem.sides.end(),
                         [](const Side<dim> &side) {
                           return side.held != HeldComponents::none;
                         }) ||
             std::any_of(problem.contacts.begin(),
                         problem.contacts.end(),
                         [](const ContactPair &pair) {
                           return pair.law == ContactLaw::separate;
                         });
    }
  } // namespace



  template <int dim>
  std::vector<Column>
  statistics_columns(const Problem<dim> &problem)
  {
    std::vector<Column> columns = {{"step", ""},
                                   {"time", "s"},
                                   {"step size", "s"},
                                   {"points", ""},
                                   {"cells", ""},
                                   {"active nodes", ""},
                                   {"mass", "kg"}};
    for (int d = 0; d < dim; ++d)
      columns.push_back({std::string("momentum ") + "xyz"[d], "kg m/s"});
    for (const char *const name : {"kinetic energy",
                                   "strain energy",
                                   "gravitational energy",
                                   "dissipated energy",
                                   "energy removed by transfer",
                                   "energy removed with history",
                                   "boundary work",
                                   "load work"})
      columns.push_back({name, "J"});
    columns.push_back({"energy drift", ""});
    columns.push_back({"momentum error", ""});
    columns.push_back({"largest velocity", "m/s"});
    columns.push_back({"smallest volume ratio", ""});
    columns.push_back({"largest volume ratio", ""});
    columns.push_back({"lost points", ""});
    if (may_flow(problem))
      columns.push_back({"plastic work", "J"});
    if (may_rub(problem))
      columns.push_back({"friction heat", "J"});
    if (may_part(problem))
      columns.push_back({"contact loss", "J"});
    if (problem.adapts())
      columns.push_back({"energy removed by adaptation", "J"});

    for (const Observable<dim> &observable : problem.observables)
      columns.push_back({observable.name, observable.unit});
    return columns;
  }



  template <int dim>
  std::vector<double>
  statistics_row(const State<dim>          &state,
                 const Totals<dim>         &totals,
                 const std::vector<double> &observed)
  {
    std::vector<double> row = {static_cast<double>(state.step),
                               state.time,
                               state.step_size,
                               static_cast<double>(totals.points),
                               static_cast<double>(totals.cells),
                               static_cast<double>(totals.active_nodes),
                               totals.all.mass};
    for (int d = 0; d < dim; ++d)
      row.push_back(totals.all.momentum[d]);
    row.insert(row.end(),
               {totals.all.kinetic_energy,
                totals.all.strain_energy,
                totals.all.gravitational_energy,
                totals.dissipated,
                totals.removed_by_transfer,
                totals.removed_with_history,
                totals.boundary_work,
                totals.load_work,
                totals.energy_drift,
                totals.momentum_error,
                totals.largest_speed,
                totals.smallest_volume,
                totals.largest_volume,
                static_cast<double>(totals.lost_points)});
    if (may_flow(state.problem))
      row.push_back(totals.plastic_work);
    if (may_rub(state.problem))
      row.push_back(totals.friction_heat);
    if (may_part(state.problem))
      row.push_back(totals.contact_loss);
    if (state.problem.adapts())
      row.push_back(totals.removed_by_adaptation);
    row.insert(row.end(), observed.begin(), observed.end());
    return row;
  }



  template std::vector<Column>
  statistics_columns(const Problem<2> &);
  template std::vector<Column>
  statistics_columns(const Problem<3> &);
  template std::vector<double>
  statistics_row(const State<2> &,
                 const Totals<2> &,
                 const std::vector<double> &);
  template std::vector<double>
  statistics_row(const State<3> &,
                 const Totals<3> &,
                 const std::vector<double> &);
} // namespace limber
