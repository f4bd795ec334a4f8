// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_further_deformation_h
#define limber_materials_further_deformation_h

#include <limber/materials/isochoric_strain.h>

namespace limber
{
  /**
   * The state of a law that flows after f in a step (s), in which the volume
   * ratio grows by the factor @p growth: it returns from the trial strain at
   * the end of f. Returns the work on plastic strain, per volume at the start,
   * Pa.
   */
  template <int dim, class Law, class Number>
  Number
  flow_further(const Law                                 &law,
               const SmallMatrix<dim, Number>            &f,
               const Number                              &growth,
               const double                               step,
               typename Law::template State<dim, Number> &state)
  {
    // the stress is still that of before, as update() has it after the motion,
    // of which nothing is left
    isochoric::deform<dim>(state.history, f, determinant<dim>(f));
    state.history[0] *= growth;
    MotionIncrement<dim, Number> none{};
    none.step = step;
    return law.template update<dim>(none, state).plastic;
  }



  /**
   * A law of a solid that can deform a state further by f of any size, in one
   * go: Law::update() takes motions as short as explicit steps make them, and
   * bounds what a cell that is hardly touched does to its points. What flows
   * returns from the trial strain at the end of f.
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
     * The state after f, in which the volume ratio grows by the factor
     * @p growth; where the strain is small, by @p growth less one. Returns the
     * work on plastic strain, per volume at the start, Pa.
     */
    template <int dim>
    double
    deform(const SquareMatrix<dim>                   &f,
           const double                               growth,
           typename Law::template State<dim, double> &state) const
    {
      if constexpr (Law::is_plastic)
        return flow_further<dim, Law>(*this, f, growth, 0, state);
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
