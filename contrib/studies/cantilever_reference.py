#!/usr/bin/python3
"""First natural frequency of a beam in plane strain by finite elements.

    cantilever_reference.py [Poisson's ratio] [elements over the depth]

The clamped beam of prm/cantilever.prm, 8 m x 1 m, E = 1 MPa, rho = 1000 kg/m^3,
by square elements of degree two (Q2, consistent mass, nine Gauss points). Needs
numpy and scipy; takes seconds.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "plot"))
import charts  # noqa: E402
from charts import np  # noqa: E402

charts.need("scipy")
import scipy.sparse as sparse  # noqa: E402
from scipy.sparse.linalg import eigsh  # noqa: E402

LENGTH, YOUNG, DENSITY = 8, 1e6, 1000.


def shapes(x):
    """Quadratic shape functions on [0, 1] and their derivatives."""
    return (np.array([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)]),
            np.array([4 * x - 3, 4 - 8 * x, 4 * x - 1]))


def element(h, poisson):
    """Stiffness and mass of one element; dofs: node, then direction."""
    shear = YOUNG / 2 / (1 + poisson)
    lam = 2 * shear * poisson / (1 - 2 * poisson)
    C = np.array([[lam + 2 * shear, lam, 0], [lam, lam + 2 * shear, 0],
                  [0, 0, shear]])
    stiffness, mass = np.zeros((18, 18)), np.zeros((18, 18))
    places = 0.5 + 0.5 * np.sqrt(0.6) * np.array([-1, 0, 1])
    weights = np.array([5, 8, 5]) / 18
    for x, wx in zip(places, weights):
        for y, wy in zip(places, weights):
            (a, da), (b, db) = shapes(x), shapes(y)
            N = np.outer(b, a).ravel()
            dx, dy = np.outer(b, da).ravel() / h, np.outer(db, a).ravel() / h
            B = np.zeros((3, 18))
            B[0, 0::2], B[1, 1::2], B[2, 0::2], B[2, 1::2] = dx, dy, dy, dx
            stiffness += wx * wy * h * h * B.T @ C @ B
            mass += wx * wy * h * h * DENSITY * np.kron(np.outer(N, N),
                                                        np.eye(2))
    return stiffness, mass


def main():
    poisson = float(sys.argv[1]) if len(sys.argv) > 1 else 0.3
    n = int(sys.argv[2]) if len(sys.argv) > 2 else 16
    K, M = element(1 / n, poisson)
    row = 2 * LENGTH * n + 1
    first = np.add.outer(2 * row * np.arange(n), 2 * np.arange(LENGTH * n))
    nodes = first.reshape(-1, 1) + np.add.outer(row * np.arange(3),
                                                np.arange(3)).ravel()
    dofs = (2 * nodes[:, :, None] + np.arange(2)).reshape(len(nodes), 18)
    i, j = np.repeat(dofs, 18, axis=1).ravel(), np.tile(dofs, 18).ravel()
    stiffness, mass = (sparse.csc_matrix(
        (np.tile(values.ravel(), len(nodes)), (i, j))) for values in (K, M))
    free = np.flatnonzero(np.arange(stiffness.shape[0]) // 2 % row != 0)
    values = eigsh(stiffness[free][:, free], 3, mass[free][:, free], sigma=0,
                   return_eigenvectors=False)
    print(*(f"{f:.6f}" for f in np.sqrt(sorted(values)) / 2 / np.pi), "Hz")


if __name__ == "__main__":
    main()
