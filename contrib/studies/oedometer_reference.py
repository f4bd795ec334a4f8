#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settlement and lateral force of prm/verification/oedometer.prm.

Integrates the rate equations of modified Cam-clay for one point whose sides
are held: no grid, no return map. The elastic strain e of shear gives q = G
(exp(e) - exp(-2 e)), and plastic shear takes 3 G I of it, I = (exp(-2 e) + 2
exp(e)) / 3 (doc/theory/plasticity.md).
"""
from math import exp, expm1

LAMBDA, KAPPA, M, G = 0.05, 0.01, 1.2, 4e6
BORNE, ATTRACTION = 20e3, 1e3


class Point:
    """Logarithmic strain from rest; stress is Kirchhoff's, Pa."""

    def __init__(self):
        self.log_height = 0.0
        self.x, self.q, self.c = ATTRACTION, 0.0, BORNE + ATTRACTION

    @staticmethod
    def elastic_shear(q):
        """e, by Newton's method."""
        e = q / (3 * G)
        for _ in range(5):
            e -= ((exp(e) - exp(-2 * e)) - q / G) / (exp(e) + 2 * exp(-2 * e))
        return e

    def rates(self, x, q, c, sign):
        """Of x, q and c per compression; sign of the strain increment."""
        e = self.elastic_shear(q)
        whole = G * (exp(e) + 2 * exp(-2 * e))  # dq/de
        bulk, shear = x / KAPPA, 2 / 3 * whole
        relaxing = G * (exp(-2 * e) + 2 * exp(e))
        flow = 0.0
        normal_p, normal_q = 2 * x - c, 2 * q / M**2
        if q * q / M**2 + x * (x - c) > -1e-7 * c * c:
            drive = normal_p * bulk + normal_q * shear
            if sign * drive > 0:
                flow = drive / (normal_p**2 * bulk + relaxing * normal_q**2 +
                                x * c * normal_p / (LAMBDA - KAPPA))
        return (bulk * (1 - flow * normal_p), shear - relaxing * flow * normal_q,
                c / (LAMBDA - KAPPA) * flow * normal_p)

    def compress(self, by):
        """The rule of the middle, Runge and Kutta's of second order."""
        sign = 1 if by > 0 else -1
        state = (self.x, self.q, self.c)
        first = self.rates(*state, sign)
        middle = [s + 0.5 * by * r for s, r in zip(state, first)]
        second = self.rates(*middle, sign)
        self.x, self.q, self.c = (s + by * r for s, r in zip(state, second))
        self.log_height -= by

    def top(self):
        """Vertical stress of Cauchy, Pa."""
        return (self.x - ATTRACTION + 2 / 3 * self.q) / exp(self.log_height)

    def wall(self):
        """Horizontal force on a wall, N/m: the wall is as high as the clay."""
        return self.x - ATTRACTION - self.q / 3


def main():
    point = Point()
    step = 1e-5
    while point.top() < 200e3:
        point.compress(step)
    report = "{:s}: settlement {:.5f} m, force on the wall {:.1f} N/m"
    print(report.format("200 kPa", -expm1(point.log_height), point.wall()))
    while point.top() > 50e3:
        point.compress(-step)
    print(report.format(" 50 kPa", -expm1(point.log_height), point.wall()))


if __name__ == "__main__":
    main()
