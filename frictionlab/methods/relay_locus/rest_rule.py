"""Friction while the body rests on the belt: a polynomial, and integrals over it against a body's response.

Over a rest from a to b friction is a polynomial of degree N in xi, with s = a + (b - a) xi^grading: after a jump of
force at a, what a fractional element remembers has powers of s - a that are no whole numbers, and a grading above 1
makes them smooth enough. Its values at Chebyshev's points are the unknowns. The rows of a rule are weights of these
values: of the integral over dF(s) against any function known at the rule's places.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from frictionlab.quantities import Floats


class RestRule(NamedTuple):
    """Shares of a rest, and weights of the values of friction at its nodes.

    nodes [N + 1]: shares (s - a)/(b - a) of the nodes. V' is seen as a polynomial of zeta, u = (b - a) zeta^grading
    after a jump, and of u = period - (b - a) zeta before one: lags, leads [M]: shares u/(b - a) at which it is asked.
    of_before, of_after [N + 1, M, N + 1]: weights of its values there and of friction in the integral over what lies
    before and after a node. places [g], of_all [g, N + 1]: of the integral over the whole rest against any function.
    end [N + 1]: of the rate of friction at b, times b - a. mean [N + 1]: of the mean over the rest. to_polynomials
    [N + 1, N + 1]: of the coefficients of Chebyshev's polynomials of xi. samples, of_samples: shares, and weights of
    the value there.
    """

    grading: float
    nodes: Any
    lags: Any
    leads: Any
    of_before: Any
    of_after: Any
    places: Any
    of_all: Any
    end: Any
    mean: Any
    to_polynomials: Any
    samples: Any
    of_samples: Any


@lru_cache(maxsize=32)
def rest_rule(degree: int, grading: int) -> RestRule:
    """For friction of this degree."""
    xi = 0.5 * (1.0 - np.cos(np.pi * np.arange(degree + 1) / degree))
    nodes = xi**grading
    lags, leads = nodes, xi
    n = degree + 1
    to = _coefficients(xi)
    of_before, of_after = np.zeros((n, n, n)), np.zeros((n, n, n))
    for i, node in enumerate(nodes):
        at, weights = _over(xi, grading, (0.0, float(node)), 3 * n)
        zeta = np.maximum(node - at, 0.0) ** (1.0 / grading)
        of_before[i] = (_polynomials(zeta, degree) @ to).T @ weights
        at, weights = _over(xi, grading, (float(node), 1.0), 3 * n)
        of_after[i] = (_polynomials(at - node, degree) @ to).T @ weights
    places, of_all = _over(xi, grading, (0.0, 1.0), n + 8 * (grading > 1))
    end = _derivatives(xi, np.ones(1))[0] / grading
    # the mean over s of polynomials of xi: ds = grading xi^(grading - 1) dxi
    x, weight = _gauss(n + 2 * grading)
    mean = (weight * grading * x ** (grading - 1)) @ _polynomials(x, degree) @ to
    dense = 0.5 * (1.0 - np.cos(np.pi * np.arange(4 * degree + 1) / (4 * degree)))
    parts: tuple[Any, ...] = (nodes, lags, leads, of_before, of_after, places, of_all, end, mean, to)
    parts = *parts, dense**grading, _polynomials(dense, degree) @ to
    arrays: list[Any] = [np.ascontiguousarray(each) for each in parts]
    return RestRule(float(grading), *arrays)


def _gauss(count: int) -> tuple[Floats, Floats]:
    """Gauss's rule on [0, 1]."""
    x, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * (1.0 + x), 0.5 * weight


def _over(xi: Floats, grading: int, span: tuple[float, float], count: int) -> tuple[Floats, Floats]:
    """Places in a span of the rest, and weights of the values of friction there of the integral over dF.

    Closer at both ends by eta -> (integral of (eta (1 - eta))^(grading - 1)), so that xi at the beginning of the
    rest, and zeta at the other end, are as smooth as eta."""
    eta, weight = _gauss(count)
    power = np.polynomial.Polynomial([0.0, 1.0, -1.0]) ** (grading - 1)
    whole = power.integ()
    width = span[1] - span[0]
    at = span[0] + width * whole(eta) / whole(1.0)
    if width == 0.0:
        return at, np.zeros((count, len(xi)))
    x = at ** (1.0 / grading)
    # dF = F'(xi) dxi, dxi = ds xi^(1 - grading)/grading
    per = weight * width * power(eta) / whole(1.0) * x ** (1.0 - grading) / grading
    return at, per[:, None] * _derivatives(xi, x)


def _polynomials(x: Floats, degree: int) -> Floats:
    """Chebyshev's polynomials of [0, 1]."""
    return np.asarray(np.polynomial.chebyshev.chebvander(2.0 * x - 1.0, degree))


def _coefficients(xi: Floats) -> Floats:
    """From values at xi to coefficients of Chebyshev's polynomials, well conditioned at any degree."""
    return np.asarray(np.linalg.inv(_polynomials(xi, len(xi) - 1)))


def _derivatives(xi: Floats, x: Floats) -> Floats:
    """Rows of weights: the derivative at x of the polynomial through values at xi."""
    slopes = np.polynomial.chebyshev.chebval(
        2.0 * x - 1.0, np.polynomial.chebyshev.chebder(np.eye(len(xi)), axis=0, scl=2.0)
    )
    return np.asarray(slopes.T @ _coefficients(xi))
