// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_solid_samples_h
#define limber_fem_solid_samples_h

#include <limber/fem/solid_model.h>

#include <vector>

/** @file Evaluates a finite element solution at places and at nodes. */
namespace limber
{
  /** Displacement, velocity and state of the material at a place. */
  template <int dim>
  struct PlaceSample
  {
    bool                   inside = false; // else the rest means nothing
    dealii::Tensor<1, dim> displacement, velocity; // m, m/s
    MaterialState          material;
  };



  /**
   * Means over the elements that meet at @p place of the initial body; outside
   * of the body only @p inside is set. Strain energies are left out.
   * Collective.
   */
  template <int dim>
  PlaceSample<dim>
  sample_at(const SolidModel<dim>    &model,
            const dealii::Point<dim> &place,
            const NodalVector        &displacement,
            const NodalVector        &velocity);

  /**
   * The same at many places, in their order, each from one element that holds
   * it, strain energies included. For one rank.
   */
  template <int dim>
  std::vector<PlaceSample<dim>>
  sample_at(const SolidModel<dim>                 &model,
            const std::vector<dealii::Point<dim>> &places,
            const NodalVector                     &displacement,
            const NodalVector                     &velocity);

  /** A sample and the part of the body that it stands for. */
  template <int dim>
  struct QuadratureSample
  {
    dealii::Point<dim> start;      // place at the start, m
    double             volume = 0; // at the start, m^dim
    PlaceSample<dim>   here;
  };

  /** Those of the quadrature points of this rank. */
  template <int dim>
  std::vector<QuadratureSample<dim>>
  quadrature_samples(const SolidModel<dim> &model,
                     const NodalVector     &displacement,
                     const NodalVector     &velocity);

  /** Cauchy pressure and stress (xx yy zz xy yz zx) of a node, Pa. */
  using NodalStress = std::array<double, 7>;

  /**
   * Interpolates nodal values at many places by the shape functions; zero
   * outside of the body. Nodes in the order of
   * SolidModel::for_each_owned_node(). For one rank.
   */
  template <int dim>
  std::vector<NodalStress>
  interpolate_at(const SolidModel<dim>                 &model,
                 const std::vector<dealii::Point<dim>> &places,
                 const std::vector<NodalStress>        &nodal);

  /**
   * States of the nodes of this rank, in the order of
   * SolidModel::for_each_owned_node(): means over the elements that meet
   * there. Strain energies are left out. Collective.
   */
  template <int dim>
  std::vector<MaterialState>
  nodal_states(const SolidModel<dim> &model, const NodalVector &displacement);
} // namespace limber

#endif
