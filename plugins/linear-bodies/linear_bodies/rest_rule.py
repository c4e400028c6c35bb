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
from numpy.polynomial import chebyshev

from frictionlab.theory import Floats
from frictionlab.tools import inner


class RestRule(NamedTuple):
    """Shares of a rest, and weights of the values of friction at its nodes.

    nodes [N + 1]: shares (s - a)/(b - a) of the nodes. V' is seen as a polynomial of M terms of zeta, u = (b - a)
    zeta^grading after a jump, and of u = period - (b - a) zeta before one: lags, leads [M]: shares u/(b - a) at which
    it is asked. of_before, of_after [M, (N + 1)^2]: weights of its values there, for each node and each value of
    friction, in the integral over what lies before and after the node. places [g], of_all [g, N + 1]: of the integral
    over the whole rest against any function. end [N + 1]: of the rate of friction at b, times b - a. mean [N + 1]: of
    the mean over the rest. to_polynomials [N + 1, N + 1]: of the coefficients of Chebyshev's polynomials of xi.
    samples, of_samples: shares, and weights of the value there.
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


class RestRules(NamedTuple):
    """Rules of ascending degree, of each the numbers in a row: kernels carry two arrays in place of twelve a rule.

    sizes [rules, 4]: nodes, terms, places and samples. numbers [rules, longest]: the arrays of a rule in a row.
    """

    grading: float
    sizes: Any
    numbers: Any


def rest_rules(degrees: tuple[int, ...], terms: int, grading: int) -> RestRules:
    """Return the rules of these degrees."""
    rules = [rest_rule(degree, terms, grading) for degree in degrees]
    sizes = [(each.nodes.size, terms, each.places.size, each.samples.size) for each in rules]
    rows = [np.concatenate([array.ravel() for array in each[1:]]) for each in rules]
    numbers = np.zeros((len(rules), max(map(len, rows))))
    for row, written in zip(numbers, rows, strict=True):
        row[: len(written)] = written
    return RestRules(float(grading), np.array(sizes), numbers)


@inner
def rule_at(rules: RestRules, k: int) -> RestRule:
    """Return one of them."""
    row, sizes = rules.numbers[k], rules.sizes[k]
    n, terms, places, samples = sizes[0], sizes[1], sizes[2], sizes[3]
    lags, leads = n + terms, n + 2 * terms
    before, after = leads + terms * n * n, leads + 2 * terms * n * n
    at, of_all = after + places, after + places + places * n
    end, mean = of_all + n, of_all + 2 * n
    to, at_samples = mean + n * n, mean + n * n + samples
    return RestRule(
        rules.grading,
        row[:n],
        row[n:lags],
        row[lags:leads],
        row[leads:before].reshape(terms, n * n),
        row[before:after].reshape(terms, n * n),
        row[after:at],
        row[at:of_all].reshape(places, n),
        row[of_all:end],
        row[end:mean],
        row[mean:to].reshape(n, n),
        row[to:at_samples],
        row[at_samples : at_samples + samples * n].reshape(samples, n),
    )


@lru_cache(maxsize=64)
def rest_rule(degree: int, terms: int, grading: int) -> RestRule:
    """Return the rule for friction of this degree, and V' of so many terms."""
    xi, zeta = _points(degree), _points(terms - 1)
    nodes, to = xi**grading, _coefficients(xi)
    n, slopes = degree + 1, _slopes(degree) @ to
    count = (n + terms) // 2 + 1 if grading == 1 else 3 * n
    # Over what lies before every node, and after it: places of both [nodes, count], weights of values of friction.
    before, of_before = _over(slopes, grading, np.zeros(n), nodes, count)
    after, of_after = _over(slopes, grading, nodes, np.ones(n), count)
    at_before = np.maximum(nodes[:, None] - before, 0.0) ** (1.0 / grading)
    response = _coefficients(zeta)
    seen_before = _polynomials(at_before, terms - 1) @ response
    seen_after = _polynomials(after - nodes[:, None], terms - 1) @ response
    count = (n + terms) // 2 + 1 + 8 * (grading > 1)
    places, of_all = _over(slopes, grading, np.zeros(1), np.ones(1), count)
    # the mean over s of polynomials of xi: ds = grading xi^(grading - 1) dxi
    x, weight = _gauss(n + 2 * grading)
    mean = (weight * grading * x ** (grading - 1)) @ _polynomials(x, degree) @ to
    dense = 0.5 * (1.0 - np.cos(np.pi * np.arange(4 * degree + 1) / (4 * degree)))
    arrays: list[Any] = [
        nodes,
        zeta**grading,
        zeta,
        np.einsum("igm,igk->mik", seen_before, of_before).reshape(terms, n * n),
        np.einsum("igm,igk->mik", seen_after, of_after).reshape(terms, n * n),
        places[0],
        of_all[0],
        _polynomials(np.ones(1), degree - 1)[0] @ slopes / grading,
        mean,
        to,
        dense**grading,
        _polynomials(dense, degree) @ to,
    ]
    return RestRule(float(grading), *map(np.ascontiguousarray, arrays))


def _points(degree: int) -> Floats:
    """Return Chebyshev's extreme points of [0, 1]."""
    return np.asarray(0.5 * (1.0 - np.cos(np.pi * np.arange(degree + 1) / degree)))


def _gauss(count: int) -> tuple[Floats, Floats]:
    """Return Gauss's rule on [0, 1]."""
    x, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * (1.0 + x), 0.5 * weight


def _over(slopes: Floats, grading: int, start: Floats, stop: Floats, count: int) -> tuple[Floats, Floats]:
    """Return places in these spans of the rest, and weights of friction there of the integral over dF.

    They are [spans, count] and [spans, count, N + 1].

    Closer at both ends by eta -> (integral of (eta (1 - eta))^(grading - 1)), so that xi at the beginning of the
    rest, and zeta at the other end, are as smooth as eta."""
    eta, weight = _gauss(count)
    power = np.polynomial.Polynomial([0.0, 1.0, -1.0]) ** (grading - 1)
    whole = power.integ()
    width = (stop - start)[:, None]
    at = start[:, None] + width * whole(eta) / whole(1.0)
    x = at ** (1.0 / grading)
    with np.errstate(divide="ignore", invalid="ignore"):
        # dF = F'(xi) dxi, dxi = ds xi^(1 - grading)/grading
        per = weight * width * power(eta) / whole(1.0) * x ** (1.0 - grading) / grading
    per = np.where(width > 0.0, per, 0.0)
    return at, per[..., None] * (_polynomials(x, slopes.shape[0] - 1) @ slopes)


def _polynomials(x: Floats, degree: int) -> Floats:
    """Return Chebyshev's polynomials of [0, 1]."""
    return np.asarray(chebyshev.chebvander(2.0 * x - 1.0, degree))


def _coefficients(xi: Floats) -> Floats:
    """Return the matrix from values at xi to terms of Chebyshev's polynomials, well conditioned at any degree."""
    return np.asarray(np.linalg.inv(_polynomials(xi, len(xi) - 1)))


def _slopes(degree: int) -> Floats:
    """Return the matrix from coefficients of Chebyshev's polynomials of [0, 1] to those of the derivative."""
    return np.asarray(chebyshev.chebder(np.eye(degree + 1), axis=0, scl=2.0))
