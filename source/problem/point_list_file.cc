// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/point_list.h>

#include <hdf5.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    std::vector<std::string>
    known_columns(const unsigned int dim)
    {
      std::vector<std::string> names = {"volume", "mass"};
      for (unsigned int d = 0; d < dim; ++d)
        {
          names.push_back(std::string(1, "xyz"[d]));
          names.push_back(std::string("velocity ") + "xyz"[d]);
        }
      return names;
    }



    [[noreturn]] void
    refuse_list(const InputFile   &file,
                const std::string &what,
                const std::string &remedy)
    {
      throw InputError("The point list " + file.name() + " " + what + ". " +
                       remedy);
    }



    /** Words between separators other than blanks, which names may contain. */
    std::vector<std::string>
    cells_of(std::string_view line)
    {
      std::string text(line);
      for (char &letter : text)
        if (letter == ';' || letter == '\t')
          letter = ',';
      return split(text, ',');
    }



    /**
     * The column names in the first line; those of unused columns are empty.
     */
    std::vector<std::string>
    read_header(const InputFile   &file,
                std::string_view   line,
                const unsigned int dim)
    {
      const auto known = known_columns(dim);
      auto       names = cells_of(line);
      double     number;
      if (std::all_of(names.begin(), names.end(), [&](const auto &name) {
            return is_number(name, number);
          }))
        refuse_list(file,
                    "begins with numbers instead of the names of its columns",
                    "Usually the first line was left out. Write 'x, y, "
                    "volume', for instance, above the numbers.");
      for (std::string &name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
          {
            const auto meant = nearest(name, known);
            if (name.size() > 1 && meant && meant->size() > 1 &&
                std::find(names.begin(), names.end(), *meant) == names.end())
              refuse_list(file,
                          "has a column " + in_quotes(name) +
                            " in its first line, which is not known",
                          "Usually it is misspelt. Did you mean " +
                            in_quotes(*meant) +
                            "? Give another column another name.");
            name.clear();
          }
      return names;
    }



    PointTable
    read_csv(const InputFile &file, const unsigned int dim)
    {
      PointTable               table;
      TextLines                lines(file.bytes);
      std::string_view         line;
      std::vector<std::string> names;
      while (lines.next(line))
        {
          line = line.substr(0, line.find('#'));
          if (line.find_first_not_of(" \t") == std::string_view::npos)
            continue;
          if (names.empty())
            {
              names = read_header(file, line, dim);
              for (const std::string &name : names)
                if (!name.empty())
                  table.columns[name] = {};
              continue;
            }
          const auto cells = words_of(line, ",;");
          if (cells.size() != names.size())
            refuse_list(file,
                        "has " + std::to_string(cells.size()) +
                          " numbers in line " + std::to_string(lines.number) +
                          ", but " + std::to_string(names.size()) +
                          " columns by its first line",
                        "Usually a cell of the table is empty. Write a number "
                        "there.");
          for (std::size_t i = 0; i < cells.size(); ++i)
            if (!names[i].empty())
              {
                double value;
                if (!is_number(cells[i], value))
                  refuse_list(file,
                              "has " + in_quotes(std::string(cells[i])) +
                                " for " + in_quotes(names[i]) + " in line " +
                                std::to_string(lines.number) +
                                ", which is no finite number",
                              "Usually a formula failed in the table. Write a "
                              "number there.");
                table.columns[names[i]].push_back(value);
              }
          table.lines.push_back(lines.number);
        }
      table.n = table.lines.size();
      return table;
    }



    /** Owns an HDF5 identifier; negative ones stand for failures. */
    struct Hdf5Handle
    {
      const hid_t id;
      herr_t (*const close)(hid_t);

      ~Hdf5Handle()
      {
        if (id >= 0)
          close(id);
      }
    };



    std::vector<double>
    read_hdf5_array(const InputFile &file, const hid_t from, const char *name)
    {
      const Hdf5Handle    array{H5Dopen2(from, name, H5P_DEFAULT), H5Dclose};
      const Hdf5Handle    space{H5Dget_space(array.id), H5Sclose};
      const hssize_t      n = H5Sget_simple_extent_npoints(space.id);
      std::vector<double> values(std::max<hssize_t>(n, 0));
      if (n < 0 || H5Dread(array.id,
                           H5T_NATIVE_DOUBLE,
                           H5S_ALL,
                           H5S_ALL,
                           H5P_DEFAULT,
                           values.data()) < 0)
        refuse_list(file,
                    "has no numbers in its array " + in_quotes(name),
                    "Usually the array has text or pairs. Write one number for "
                    "each point.");
      return values;
    }



    // From a file image in memory, as the first rank has read the file for all.
    PointTable
    read_hdf5(const InputFile &file, const unsigned int dim)
    {
      H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // errors are reported here
      std::string      bytes = file.bytes;
      const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
      H5Pset_fapl_core(access.id, 1 << 20, false);
      H5Pset_file_image(access.id, bytes.data(), bytes.size());
      // HDF5 needs a name under which there is no file.
      const std::string name = file.path + "/in memory";
      const Hdf5Handle  hdf5{H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.id),
                            H5Fclose};
      if (hdf5.id < 0)
        refuse_list(file,
                    "begins as HDF5 does, but cannot be read as such",
                    "Usually it was cut off while it was copied. Write it "
                    "anew, and close it.");
      PointTable table;
      for (const std::string &name : known_columns(dim))
        if (H5Lexists(hdf5.id, name.c_str(), H5P_DEFAULT) > 0)
          table.columns[name] = read_hdf5_array(file, hdf5.id, name.c_str());
      for (const auto &[name, values] : table.columns)
        {
          table.n = table.columns.begin()->second.size();
          if (values.size() != table.n)
            refuse_list(file,
                        "has " + std::to_string(values.size()) +
                          " numbers in the array " + in_quotes(name) +
                          ", but " + std::to_string(table.n) + " in " +
                          in_quotes(table.columns.begin()->first),
                        "Usually arrays of different lists were mixed. Write "
                        "one number for each point.");
          for (std::size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
              refuse_list(file,
                          "has a value that is not finite in the array " +
                            in_quotes(name) + ", " + table.row_name(i),
                          "Usually a computation failed there. Write a "
                          "number.");
        }
      return table;
    }



    void
    check_columns(const InputFile   &file,
                  const PointTable  &table,
                  const unsigned int dim)
    {
      const auto has = [&](const std::string &name) {
        return table.columns.count(name) > 0;
      };
      for (unsigned int d = 0; d < dim; ++d)
        {
          const std::string place(1, "xyz"[d]), velocity = "velocity " + place;
          if (!has(place))
            refuse_list(file,
                        "has no column " + in_quotes(place),
                        "Usually it has another name there. The names are x, "
                        "y, " +
                          std::string(dim == 3 ? "z, " : "") +
                          "volume or mass, and velocity x and so on.");
          if (has(velocity) != has("velocity x"))
            refuse_list(file,
                        "has some components of the velocity, but not all: " +
                          in_quotes(has(velocity) ? "velocity x" : velocity) +
                          " is missing",
                        "Usually the table is for another dimension. Add the "
                        "column, with zeros if need be.");
        }
      if (has("volume") == has("mass"))
        refuse_list(file,
                    has("mass") ? "has both columns 'volume' and 'mass'" :
                                  "has neither a column 'volume' nor 'mass'",
                    "The density of the material gives the other one. Give "
                    "exactly one of the two.");
      if (table.n == 0)
        refuse_list(file,
                    "holds no point",
                    "Usually the table was written before it was filled. Write "
                    "a line or entry for each point.");
      const std::string size   = has("mass") ? "mass" : "volume";
      const auto       &values = table.columns.at(size);
      for (std::size_t i = 0; i < table.n; ++i)
        if (!(values[i] > 0))
          refuse_list(file,
                      "has the " + size + " " + brief(values[i]) + " in " +
                        table.row_name(i) + ", which is not greater than 0",
                      "Usually columns were exchanged. Give each point a " +
                        size + ", or leave it out.");
    }
  } // namespace



  std::string
  PointTable::row_name(const std::size_t row) const
  {
    return lines.empty() ? "point " + std::to_string(row + 1) :
                           "line " + std::to_string(lines[row]);
  }



  PointTable
  read_point_table(const InputFile &file, const unsigned int dim)
  {
    const bool       is_hdf5 = file.bytes.compare(0, 4, "\x89HDF") == 0;
    const PointTable table =
      is_hdf5 ? read_hdf5(file, dim) : read_csv(file, dim);
    check_columns(file, table, dim);
    return table;
  }
} // namespace limber
