#!/usr/bin/env python3
"""Finite element reference of the fixed soft beam.

    fixed_beam_reference.py [elements over the width] [Poisson's ratio]

The beam of prm/benchmarks/fixed_soft_beam.prm by total Lagrangian bilinear
elements whose volume ratio is averaged over the element (mean dilatation),
with explicit central differences. Prints place of the tip and energy over
its start at some times. Ten elements take some two minutes.
"""

import sys

import numpy as np

WIDTH, HEIGHT = 1, 6  # m, clamped at y = 0
DENSITY, YOUNG, SPEED = 1100., 17e6, 10.  # kg/m^3, Pa, m/s
TIMES = (0.2, 0.3, 0.4, 0.8)  # s


def mesh(n):
    """Places of nodes and nodes of elements, n over the width."""
    x, y = np.meshgrid(np.arange(n + 1), np.arange(HEIGHT * n + 1))
    places = np.stack([x.ravel(), y.ravel()], axis=1) * WIDTH / n
    first = (np.arange(n) + (n + 1) * np.arange(HEIGHT * n)[:, None]).ravel()
    return places, first[:, None] + np.array([0, 1, n + 1, n + 2])


def gradients(h):
    """dN_a/dX_k at the four Gauss points of a square: (point, node, k)."""
    places = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    return np.array([[[-(1 - b), -(1 - a)], [1 - b, -a], [-b, 1 - a], [b, a]]
                     for a in places for b in places]) / h


def forces(u, elements, dN, weight, bulk, shear):
    """Nodal forces and strain energy of W = K/2 (<J> - 1)^2 + G/2
    (J^(-2/3) tr(F F^T) - 3), plane strain."""
    F = np.einsum("ead,gak->egdk", u[elements], dN) + np.eye(2)
    J = np.linalg.det(F)
    mean = J.mean(axis=1, keepdims=True)
    scale = J**(-2 / 3)
    trace = (F**2).sum(axis=(2, 3)) + 1
    by_J = bulk * (mean - 1) - shear / 3 * scale * trace / J
    cofactor = np.stack([
        np.stack([F[..., 1, 1], -F[..., 1, 0]], axis=-1),
        np.stack([-F[..., 0, 1], F[..., 0, 0]], axis=-1)], axis=-2)
    P = shear * scale[..., None, None] * F + by_J[..., None, None] * cofactor
    on_elements = -weight * np.einsum("egdk,gak->ead", P, dN)
    result = np.stack([np.bincount(elements.ravel(),
                                   on_elements[..., d].ravel(), len(u))
                       for d in range(2)], axis=1)
    energy = weight * (bulk / 2 * (mean - 1)**2 +
                       shear / 2 * (scale * trace - 3)).sum()
    return result, energy


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    poisson = float(sys.argv[2]) if len(sys.argv) > 2 else 0.499
    bulk, shear = YOUNG / 3 / (1 - 2 * poisson), YOUNG / 2 / (1 + poisson)
    h = WIDTH / n
    places, elements = mesh(n)
    dN = gradients(h)
    mass = DENSITY * h * h / 4 * np.bincount(elements.ravel())[:, None]
    clamped = places[:, 1] == 0
    tip = np.argmin(np.hypot(places[:, 0] - WIDTH / 2, places[:, 1] - HEIGHT))

    step = 0.45 * h / np.sqrt((bulk + 4 / 3 * shear) / DENSITY)
    u = np.zeros_like(places)
    v = np.zeros_like(places)
    v[:, 0] = np.where(clamped, 0, SPEED)
    start = 0.5 * (mass * v**2).sum()
    force, _ = forces(u, elements, dN, h * h / 4, bulk, shear)
    v += 0.5 * step * force / mass  # half a step ahead
    v[clamped] = 0
    time = 0
    for target in TIMES:
        while time < target - 0.5 * step:
            u += step * v
            force, energy = forces(u, elements, dN, h * h / 4, bulk, shear)
            before = v.copy()
            v += step * force / mass
            v[clamped] = 0
            time += step
        kinetic = 0.5 * (mass * (0.5 * (before + v))**2).sum()
        print(f"{time:.3f} s: tip {u[tip, 0]:.3f} m, "
              f"E/E0 {(kinetic + energy) / start:.5f}", flush=True)


if __name__ == "__main__":
    main()
