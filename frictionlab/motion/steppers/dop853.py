"""DOP853: step of the explicit Runge-Kutta method of order 8, for second-order equations x'' = f(tau, x, x').

Coefficients: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), section
II.10, program DOP853. The stages are written out over named scalars, which compiles to faster code than loops
over tables; positions and velocities are ``float`` on the line and ``complex`` in the plane.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, fast_embedded


# fmt: off
@fast
def _sum1(k0: Any) -> Any:
    return (
        + 0.05260015195876773 * k0
    )


@fast
def _sum2(k0: Any, k1: Any) -> Any:
    return (
        + 0.0197250569845379 * k0
        + 0.0591751709536137 * k1
    )


@fast
def _sum3(k0: Any, k2: Any) -> Any:
    return (
        + 0.02958758547680685 * k0
        + 0.08876275643042054 * k2
    )


@fast
def _sum4(k0: Any, k2: Any, k3: Any) -> Any:
    return (
        + 0.2413651341592667 * k0
        - 0.8845494793282861 * k2
        + 0.924834003261792 * k3
    )


@fast
def _sum5(k0: Any, k3: Any, k4: Any) -> Any:
    return (
        + 0.037037037037037035 * k0
        + 0.17082860872947386 * k3
        + 0.12546768756682242 * k4
    )


@fast
def _sum6(k0: Any, k3: Any, k4: Any, k5: Any) -> Any:
    return (
        + 0.037109375 * k0
        + 0.17025221101954405 * k3
        + 0.06021653898045596 * k4
        - 0.017578125 * k5
    )


@fast
def _sum7(k0: Any, k3: Any, k4: Any, k5: Any, k6: Any) -> Any:
    return (
        + 0.03709200011850479 * k0
        + 0.17038392571223998 * k3
        + 0.10726203044637328 * k4
        - 0.015319437748624402 * k5
        + 0.008273789163814023 * k6
    )


@fast
def _sum8(k0: Any, k3: Any, k4: Any, k5: Any, k6: Any, k7: Any) -> Any:
    return (
        + 0.6241109587160757 * k0
        - 3.3608926294469414 * k3
        - 0.868219346841726 * k4
        + 27.59209969944671 * k5
        + 20.154067550477894 * k6
        - 43.48988418106996 * k7
    )


@fast
def _sum9(k0: Any, k3: Any, k4: Any, k5: Any, k6: Any, k7: Any, k8: Any) -> Any:
    return (
        + 0.47766253643826434 * k0
        - 2.4881146199716677 * k3
        - 0.590290826836843 * k4
        + 21.230051448181193 * k5
        + 15.279233632882423 * k6
        - 33.28821096898486 * k7
        - 0.020331201708508627 * k8
    )


@fast
def _sum10(k0: Any, k3: Any, k4: Any, k5: Any, k6: Any, k7: Any, k8: Any, k9: Any) -> Any:
    return (
        - 0.9371424300859873 * k0
        + 5.186372428844064 * k3
        + 1.0914373489967295 * k4
        - 8.149787010746927 * k5
        - 18.52006565999696 * k6
        + 22.739487099350505 * k7
        + 2.4936055526796523 * k8
        - 3.0467644718982196 * k9
    )


@fast
def _sum11(k0: Any, k3: Any, k4: Any, k5: Any, k6: Any, k7: Any, k8: Any, k9: Any, k10: Any) -> Any:
    return (
        + 2.273310147516538 * k0
        - 10.53449546673725 * k3
        - 2.0008720582248625 * k4
        - 17.9589318631188 * k5
        + 27.94888452941996 * k6
        - 2.8589982771350235 * k7
        - 8.87285693353063 * k8
        + 12.360567175794303 * k9
        + 0.6433927460157636 * k10
    )


@fast
def _sum12(k0: Any, k5: Any, k6: Any, k7: Any, k8: Any, k9: Any, k10: Any, k11: Any) -> Any:
    return (
        + 0.054293734116568765 * k0
        + 4.450312892752409 * k5
        + 1.8915178993145003 * k6
        - 5.801203960010585 * k7
        + 0.3111643669578199 * k8
        - 0.1521609496625161 * k9
        + 0.20136540080403034 * k10
        + 0.04471061572777259 * k11
    )


@fast
def _error3(k0: Any, k5: Any, k6: Any, k7: Any, k8: Any, k9: Any, k10: Any, k11: Any) -> Any:
    return (
        - 0.18980075407240762 * k0
        + 4.450312892752409 * k5
        + 1.8915178993145003 * k6
        - 5.801203960010585 * k7
        - 0.4226823213237919 * k8
        - 0.1521609496625161 * k9
        + 0.20136540080403034 * k10
        + 0.02265179219836082 * k11
    )


@fast
def _error5(k0: Any, k5: Any, k6: Any, k7: Any, k8: Any, k9: Any, k10: Any, k11: Any) -> Any:
    return (
        + 0.01312004499419488 * k0
        - 1.2251564463762044 * k5
        - 0.4957589496572502 * k6
        + 1.6643771824549864 * k7
        - 0.35032884874997366 * k8
        + 0.3341791187130175 * k9
        + 0.08192320648511571 * k10
        - 0.022355307863886294 * k11
    )


@fast
def _sum14(k0: Any, k6: Any, k7: Any, k8: Any, k9: Any, k10: Any, k11: Any, k12: Any) -> Any:
    return (
        + 0.056167502283047954 * k0
        + 0.25350021021662483 * k6
        - 0.2462390374708025 * k7
        - 0.12419142326381637 * k8
        + 0.15329179827876568 * k9
        + 0.00820105229563469 * k10
        + 0.007567897660545699 * k11
        - 0.008298 * k12
    )


@fast
def _sum15(k0: Any, k5: Any, k6: Any, k7: Any, k10: Any, k11: Any, k12: Any, k13: Any) -> Any:
    return (
        + 0.03183464816350214 * k0
        + 0.028300909672366776 * k5
        + 0.053541988307438566 * k6
        - 0.05492374857139099 * k7
        - 0.00010834732869724932 * k10
        + 0.0003825710908356584 * k11
        - 0.00034046500868740456 * k12
        + 0.1413124436746325 * k13
    )


@fast
def _sum16(k0: Any, k5: Any, k6: Any, k7: Any, k8: Any, k12: Any, k13: Any, k14: Any) -> Any:
    return (
        - 0.42889630158379194 * k0
        - 4.697621415361164 * k5
        + 7.683421196062599 * k6
        + 4.06898981839711 * k7
        + 0.3567271874552811 * k8
        - 0.0013990241651590145 * k12
        + 2.9475147891527724 * k13
        - 9.15095847217987 * k14
    )


@fast
def _dense4(k: Any, extra: Any) -> Any:
    k0, k5, k6, k7, k8, k9, k10, k11 = k
    k12, k13, k14, k15 = extra
    return (
        - 8.428938276109013 * k0
        + 0.5667149535193777 * k5
        - 3.0689499459498917 * k6
        + 2.38466765651207 * k7
        + 2.117034582445028 * k8
        - 0.871391583777973 * k9
        + 2.2404374302607883 * k10
        + 0.6315787787694688 * k11
        - 0.08899033645133331 * k12
        + 18.148505520854727 * k13
        - 9.194632392478356 * k14
        - 4.436036387594894 * k15
    )


@fast
def _dense5(k: Any, extra: Any) -> Any:
    k0, k5, k6, k7, k8, k9, k10, k11 = k
    k12, k13, k14, k15 = extra
    return (
        + 10.427508642579134 * k0
        + 242.28349177525817 * k5
        + 165.20045171727028 * k6
        - 374.5467547226902 * k7
        - 22.113666853125306 * k8
        + 7.733432668472264 * k9
        - 30.674084731089398 * k10
        - 9.332130526430229 * k11
        + 15.697238121770845 * k12
        - 31.139403219565178 * k13
        - 9.35292435884448 * k14
        + 35.81684148639408 * k15
    )


@fast
def _dense6(k: Any, extra: Any) -> Any:
    k0, k5, k6, k7, k8, k9, k10, k11 = k
    k12, k13, k14, k15 = extra
    return (
        + 19.985053242002433 * k0
        - 387.0373087493518 * k5
        - 189.17813819516758 * k6
        + 527.8081592054236 * k7
        - 11.57390253995963 * k8
        + 6.8812326946963 * k9
        - 1.0006050966910838 * k10
        + 0.7777137798053443 * k11
        - 2.778205752353508 * k12
        - 60.19669523126412 * k13
        + 84.32040550667716 * k14
        + 11.99229113618279 * k15
    )


@fast
def _dense7(k: Any, extra: Any) -> Any:
    k0, k5, k6, k7, k8, k9, k10, k11 = k
    k12, k13, k14, k15 = extra
    return (
        - 25.69393346270375 * k0
        - 154.18974869023643 * k5
        - 231.5293791760455 * k6
        + 357.6391179106141 * k7
        + 93.40532418362432 * k8
        - 37.45832313645163 * k9
        + 104.0996495089623 * k10
        + 29.8402934266605 * k11
        - 43.53345659001114 * k12
        + 96.32455395918828 * k13
        - 39.17726167561544 * k14
        - 149.72683625798564 * k15
    )


# fmt: on


class State(NamedTuple):
    """Position, velocity, acceleration and friction coefficient at one time."""

    x: Any
    v: Any
    a: Any
    f: Any


class Step(NamedTuple):
    """State after a step, its error estimates (order 5 and 3) and the integral of friction over the step."""

    x: Any
    v: Any
    x_error5: Any
    x_error3: Any
    v_error5: Any
    v_error3: Any
    friction_impulse: Any


class Stages(NamedTuple):
    """Velocities, accelerations and friction coefficients of the stages 1 and 6 to 12.

    A step ends at a weighted sum of these.
    """

    v: Any
    a: Any
    f: Any


class Dense(NamedTuple):
    """Coefficients [8] of a step of h, as polynomials of degree 7 in the time since its start."""

    h: float
    x: Any
    v: Any


@fast_embedded
def unprepared(problem: Any, tau: float, h: float) -> None:
    """Prepare nothing: for rates that know all times alike."""


TIMES = (
    0.0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726, 0.3333333333333333,
    0.25, 0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571, 1.0,
)  # fmt: skip
"""Times of the stages, in shares of a step."""
LAST_STAGE = len(TIMES) - 1
"""Stage at the end of the step."""


@cache
def _stages_of(rates: Any, prepare: Any) -> Any:
    """Return ``stages(problem, tau, state, h)`` of one step, for the rates of ``stepper``.

    It is compiled only once.
    """

    @fast_embedded
    def stages(problem: Any, tau: float, state: State, h: float) -> Stages:
        x, v0, a0, f0 = state
        prepare(problem, tau, h)
        v1 = v0 + h * _sum1(a0)
        a1, _f1 = rates(problem, 1, tau + 0.05260015195876773 * h, x + h * _sum1(v0), v1)
        v2 = v0 + h * _sum2(a0, a1)
        a2, _f2 = rates(problem, 2, tau + 0.0789002279381516 * h, x + h * _sum2(v0, v1), v2)
        v3 = v0 + h * _sum3(a0, a2)
        a3, _f3 = rates(problem, 3, tau + 0.1183503419072274 * h, x + h * _sum3(v0, v2), v3)
        v4 = v0 + h * _sum4(a0, a2, a3)
        a4, _f4 = rates(problem, 4, tau + 0.2816496580927726 * h, x + h * _sum4(v0, v2, v3), v4)
        v5 = v0 + h * _sum5(a0, a3, a4)
        a5, f5 = rates(problem, 5, tau + 0.3333333333333333 * h, x + h * _sum5(v0, v3, v4), v5)
        v6 = v0 + h * _sum6(a0, a3, a4, a5)
        a6, f6 = rates(problem, 6, tau + 0.25 * h, x + h * _sum6(v0, v3, v4, v5), v6)
        v7 = v0 + h * _sum7(a0, a3, a4, a5, a6)
        a7, f7 = rates(problem, 7, tau + 0.3076923076923077 * h, x + h * _sum7(v0, v3, v4, v5, v6), v7)
        v8 = v0 + h * _sum8(a0, a3, a4, a5, a6, a7)
        a8, f8 = rates(problem, 8, tau + 0.6512820512820513 * h, x + h * _sum8(v0, v3, v4, v5, v6, v7), v8)
        v9 = v0 + h * _sum9(a0, a3, a4, a5, a6, a7, a8)
        a9, f9 = rates(problem, 9, tau + 0.6 * h, x + h * _sum9(v0, v3, v4, v5, v6, v7, v8), v9)
        v10 = v0 + h * _sum10(a0, a3, a4, a5, a6, a7, a8, a9)
        a10, f10 = rates(
            problem, 10, tau + 0.8571428571428571 * h, x + h * _sum10(v0, v3, v4, v5, v6, v7, v8, v9), v10
        )
        v11 = v0 + h * _sum11(a0, a3, a4, a5, a6, a7, a8, a9, a10)
        a11, f11 = rates(problem, 11, tau + h, x + h * _sum11(v0, v3, v4, v5, v6, v7, v8, v9, v10), v11)
        return Stages(
            (v0, v5, v6, v7, v8, v9, v10, v11),
            (a0, a5, a6, a7, a8, a9, a10, a11),
            (f0, f5, f6, f7, f8, f9, f10, f11),
        )

    return stages


def stepper(rates: Any, prepare: Any) -> Any:
    """Return ``step(problem, tau, state, h)`` for a kernel function ``rates(problem, stage, tau, x, v)``.

    prepare(problem, tau, h) is called before the stages 1 to 11 of a step.

    The rates return (x'', friction). They are bound here because numba caches no kernel that is handed a
    function.
    """
    stages = _stages_of(rates, prepare)

    @fast
    def step(problem: Any, tau: float, state: State, h: float) -> Step:
        v, a, f = stages(problem, tau, state, h)
        return Step(
            state.x + h * _sum12(*v),
            state.v + h * _sum12(*a),
            h * _error5(*v),
            h * _error3(*v),
            h * _error5(*a),
            h * _error3(*a),
            h * _sum12(*f),
        )

    return step


@fast
def _coefficients(h: float, start: Any, end: Any, k: Any, extra: Any) -> Any:
    """Return the coefficients of the polynomial with this start and end, and slopes at all stages.

    k: slopes at the stages of the step; extra: slopes at the four stages added for the interpolant.
    """
    rise = end - start
    return (
        start,
        rise,
        h * k[0] - rise,
        2.0 * rise - h * (k[0] + extra[0]),
        h * _dense4(k, extra),
        h * _dense5(k, extra),
        h * _dense6(k, extra),
        h * _dense7(k, extra),
    )


def interpolant(rates: Any, prepare: Any, rates_near: Any) -> Any:
    """Return ``dense(problem, tau, state, h)``, the whole step that ``stepper`` takes for the same rates.

    rates_near(problem, tau, x, v) are the same at any other time of the step.
    """
    stages = _stages_of(rates, prepare)

    @fast
    def dense(problem: Any, tau: float, state: State, h: float) -> Dense:
        v, a, _f = stages(problem, tau, state, h)
        x, v0, a0, _f0 = state
        _v0, v5, v6, v7, v8, v9, v10, v11 = v
        _a0, a5, a6, a7, a8, a9, a10, a11 = a
        ended, v12 = x + h * _sum12(*v), v0 + h * _sum12(*a)
        a12, _f12 = rates_near(problem, tau + h, ended, v12)
        v13 = v0 + h * _sum14(a0, a6, a7, a8, a9, a10, a11, a12)
        x13 = x + h * _sum14(v0, v6, v7, v8, v9, v10, v11, v12)
        a13, _f13 = rates_near(problem, tau + 0.1 * h, x13, v13)
        v14 = v0 + h * _sum15(a0, a5, a6, a7, a10, a11, a12, a13)
        x14 = x + h * _sum15(v0, v5, v6, v7, v10, v11, v12, v13)
        a14, _f14 = rates_near(problem, tau + 0.2 * h, x14, v14)
        v15 = v0 + h * _sum16(a0, a5, a6, a7, a8, a12, a13, a14)
        x15 = x + h * _sum16(v0, v5, v6, v7, v8, v12, v13, v14)
        a15, _f15 = rates_near(problem, tau + 0.7777777777777778 * h, x15, v15)
        return Dense(
            h,
            _coefficients(h, x, ended, v, (v12, v13, v14, v15)),
            _coefficients(h, v0, v12, a, (a12, a13, a14, a15)),
        )

    return dense


@fast
def _polynomial(f: Any, s: float) -> Any:
    r = 1.0 - s
    return f[0] + s * (f[1] + r * (f[2] + s * (f[3] + r * (f[4] + s * (f[5] + r * (f[6] + s * f[7]))))))


@fast
def motion_within(dense: Dense, part: float) -> Any:
    """Return position and velocity at the time ``part`` after the start of a step."""
    s = part / dense.h
    return _polynomial(dense.x, s), _polynomial(dense.v, s)
