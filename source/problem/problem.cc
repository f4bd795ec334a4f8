// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/problem.h>

namespace limber
{
  template <int dim>
  double
  Body<dim>::density() const
  {
    switch (law)
      {
        case LawKind::linear_elastic:
          return linear_elastic.density;
        case LawKind::neo_hookean:
          return neo_hookean.density;
        case LawKind::newtonian_fluid:
          return newtonian_fluid.density;
      }
    return 0; // every law has its case above
  }



  template double
  Body<2>::density() const;
  template double
  Body<3>::density() const;
} // namespace limber
