// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_vtu_h
#define limber_output_vtu_h

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>

#include <string>
#include <tuple>
#include <vector>

namespace limber
{
  /** The fields of a picture: components one after the other. */
  class PictureFields
  {
  public:
    using Range = std::tuple<
      unsigned int,
      unsigned int,
      std::string,
      dealii::DataComponentInterpretation::DataComponentInterpretation>;

    /** A field of 1 component, of 2 or 3 (vector), or of 9 (tensor). */
    void
    add(const std::string &name,
        const std::string &unit,
        const unsigned int n_components);

    std::vector<std::string>           names; // of each component
    std::vector<Range>                 ranges;
    std::map<std::string, std::string> units;
  };



  /**
   * Write the patches of all ranks into one VTU file; ranks may have none.
   * The file appears under its name when it is complete. Collective; throws
   * FileError on all ranks.
   */
  template <int patch_dim, int dim>
  void
  write_vtu(
    const std::string                                             &path,
    const std::vector<dealii::DataOutBase::Patch<patch_dim, dim>> &patches,
    const PictureFields                                           &fields,
    const double                                                   time,
    MPI_Comm communicator);
} // namespace limber

#endif
