// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_further_deformation_h
#define limber_materials_further_deformation_h

#include <limber/materials/isochoric_strain.h>

namespace limber
{
  /**
   * The state of a plastic law after the deformation f in a step (s), in which
   * the volume ratio grows by the factor @p growth: return mapping from the
   * trial strain at the end of f. Returns the plastic work per initial volume,
   * Pa.
   */
  template <int dim, class Law, class Number>
  Number
  return_map(const Law                                 &law,
             const SmallMatrix<dim, Number>            &f,
             const Number                              &growth,
             const double                               step,
             typename Law::template State<dim, Number> &state)
  {
    // the trial strain is set here and the stress is still the old one, as in
    // update() after its trial step, which therefore gets a zero increment
    isochoric::deform<dim>(state.history, f, determinant<dim>(f));
    state.history[0] *= growth;
    MotionIncrement<dim, Number> none{};
    none.step = step;
    return law.template update<dim>(none, state).plastic;
  }



  /**
   * A law of a solid that can deform a state by a finite f in one step, as
   * implicit solvers need: Law::update() is for the short motions of explicit
   * steps, and bounds the deformation in small-cut cells. Plastic laws return
   * from the trial strain at the end of f.
   */
  template <class Law>
  class FurtherDeformation : public Law
  {
  public:
    static_assert(Law::is_elastic || (Law::is_plastic && Law::finite_strain));

    explicit FurtherDeformation(const Law &law)
      : Law(law)
    {}

    /**
     * Apply f, in which the volume ratio grows by the factor @p growth; at
     * small strain J increases by @p growth - 1. Returns the plastic work per
     * initial volume, Pa.
     */
    template <int dim>
    double
    deform(const SquareMatrix<dim>                   &f,
           const double                               growth,
           typename Law::template State<dim, double> &state) const
    {
      if constexpr (Law::is_plastic)
        return return_map<dim, Law>(*this, f, growth, 0, state);
      else if constexpr (Law::finite_strain)
        {
          isochoric::deform<dim>(state.history, f, determinant<dim>(f));
          state.history[0] *= growth;
          this->template set_stress<dim>(state);
        }
      else
        {
          const auto added = this->template at_deformation<dim>(f, growth);
          state.pressure += added.pressure;
          for (unsigned int k = 0; k < state.deviator.size(); ++k)
            state.deviator[k] += added.deviator[k];
        }
      return 0;
    }
  };
} // namespace limber

#endif
