"""Reference values of bristle laws by two unrelated ways: python tests/reference/make_bristle.py [PART].

Writes bristle_w4.csv and bristle_more.csv beside itself, and with PART bench the curves of the bench list, known by
collocation alone. Each mean is that of the collocation; ``accuracy`` is ten
times its distance from the steps (or from its own refinement), and never below 1e-12. Where the bristle is too
stiff for shooting by explicit steps, the guess is the orbit of a softer one, and one period of steps from the
collocated state is what confirms it. Stops where an accuracy would be above 1e-11.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import bristle_collocation
import bristle_law
import bristle_steps

HERE = Path(__file__).parent
SOFT_ENOUGH = 1e-4, 1e-3
"""Presliding lengths for shooting by steps, on the line and in the plane."""
W4 = {
    "W4a": ("lugre", 5e-2, 4e-4),
    "W4b": ("lugre", 5e-4, 4e-4),
    "W4c": ("dahl", 5e-2, 0.0),
    "W4d": ("dahl", 5e-4, 0.0),
}
W4_SPEEDS = 0.5, 2.0, 5.0, 10.0, 18.3, 27.0, 36.0, 43.0, 47.0, 49.9
LENGTHS = 1.0, 1e-2, 1e-4
STRIBECK = {"mu_kinetic": 0.25, "mu_static": 0.4}


def w4():
    """LuGre and Dahl friction of constant steady friction on W1."""
    head = "workload", "kind", "presliding_length", "damping", "belt_speed", "mean_friction", "accuracy"
    rows = []
    for name, (kind, presliding, damping) in W4.items():
        for speed in W4_SPEEDS:
            law = {"presliding": presliding, "damping": damping}
            n = bristle_law.one_degree_of_freedom(speed, bristle_law.lugre(**law))
            rows.append((name, kind, presliding, damping, speed, *means(n)))
            print(*rows[-1], flush=True)
    write("bristle_w4.csv", head, rows)


def more():
    """A falling Stribeck curve and elasto-plastic friction on W1; Dahl, LuGre and elasto-plastic on W3."""
    head = (
        *("omega_r", "kind", "mu_kinetic", "mu_static", "stribeck_speed", "presliding_length", "damping"),
        *("belt_speed", "mean_friction", "accuracy"),
    )
    rows = []
    for omega_r, kind, told, speed in _cases():
        law = bristle_law.dupont(**told) if kind == "dupont" else bristle_law.lugre(**told)
        n = bristle_law.one_degree_of_freedom(speed, law)
        if omega_r:
            n = bristle_law.two_degrees_of_freedom(speed, omega_r, law)
        given = told.get("presliding"), told.get("damping", 0.0)
        curve = n.mu_kinetic, n.mu_static, n.stribeck_speed
        rows.append((omega_r or "none", kind, *curve, *given, speed, *means(n)))
        print(*rows[-1], flush=True)
    write("bristle_more.csv", head, rows)


def _cases():
    for presliding in (1.0, 1e-2, 1e-4):
        for speed in (0.5, 5.0, 20.0, 45.0):
            for width in (10.0, 1.0):
                yield None, "lugre", STRIBECK | {"stribeck_speed": width, "presliding": presliding}, speed
            yield None, "dupont", {"presliding": presliding}, speed
    for omega_r in (0.5, 4.0):
        for presliding in (1.0, 1e-2, 1e-4):
            for speed in (5.0, 15.0, 30.0):
                yield omega_r, "dahl", {"presliding": presliding}, speed
                falling = STRIBECK | {"stribeck_speed": 10.0, "damping": 4e-4}
                yield omega_r, "lugre", falling | {"presliding": presliding}, speed
                yield omega_r, "dupont", {"presliding": presliding}, speed


def means(n):
    """The mean friction and its accuracy."""
    least, own = SOFT_ENOUGH[int(n.planar)], n.mu_kinetic / n.stiffness
    stiffer = max(1.0, least / own)
    soft = n._replace(stiffness=n.stiffness / stiffer, breaks_at=n.breaks_at * stiffer)
    _, mean, gap, track = bristle_steps.shoot(soft)
    track[:, 2 + 2 * n.size // 3 :] /= stiffer
    found = bristle_collocation.solve(n, track)
    if stiffer > 1.0:
        mean, gap = bristle_steps.confirm(n, found.state)
    off = abs(found.mean - mean)
    accuracy = max(1e-12, 10.0 * off, 10.0 * found.change)
    if not (accuracy <= 1e-11 and gap < 1e-10):
        raise ArithmeticError(f"not known to 1e-11: {off:.1e}, {found.change:.1e}, gap {gap:.1e}, {n}")
    return float(found.mean), float(f"{accuracy:.0e}")


def bench():
    """The curves of the bench list by collocation, each orbit guessed from that of softer bristles."""
    falling = STRIBECK | {"stribeck_speed": 10.0}
    for name, (kind, told, omega_r, points) in {
        **{
            name: ("lugre", {"presliding": length, "damping": d}, 0, 64)
            for name, (_, length, d) in W4.items()
        },
        **{
            f"W4_{length:g}": ("lugre", {"presliding": length, "damping": 4e-4}, 0, 64)
            for length in (0.5, 5e-6)
        },
        **{f"lugre_{length:g}": ("lugre", falling | {"presliding": length}, 0, 32) for length in LENGTHS},
        **{f"dupont_{length:g}": ("dupont", {"presliding": length}, 0, 32) for length in LENGTHS},
        **{
            f"lugre_plane_{length:g}": ("lugre", falling | {"presliding": length}, 4.0, 32)
            for length in LENGTHS
        },
        **{f"dupont_plane_{length:g}": ("dupont", {"presliding": length}, 4.0, 32) for length in LENGTHS},
    }.items():
        law = bristle_law.dupont(**told) if kind == "dupont" else bristle_law.lugre(**told)
        rows, known = [], 0.0
        for k in range(points):
            speed = 0.5 + 59.5 * k / (points - 1)
            line = bristle_law.one_degree_of_freedom(speed, law)
            found = _collocated(bristle_law.two_degrees_of_freedom(speed, omega_r, law) if omega_r else line)
            if found is None:
                print(name, speed, "left out", flush=True)
            else:
                known = max(known, found.change)
                rows.append((speed, float(found.mean)))
        print(name, len(rows), f"{known:.1e}", flush=True)
        write(f"../benchmarks/bristle_{name}.csv", ("belt_speed", "mean_friction"), rows)


def _collocated(n):
    """The orbit from the guess of ten times softer bristles, else from its own steps; None without one."""
    try:
        return bristle_collocation.solve(n, _guess(n, 10.0))
    except (ArithmeticError, np.linalg.LinAlgError):
        pass
    try:
        return bristle_collocation.solve(n, _guess(n, 1.0))
    except (ArithmeticError, np.linalg.LinAlgError):
        return None


def _guess(n, softer):
    """The orbit with bristles so much softer, its deflections scaled; by steps where those are quick."""
    own = n.mu_kinetic / n.stiffness
    if own >= 2e-3:
        return bristle_steps.shoot(n, 1e-11)[-1]
    if softer == 1.0 and own >= 1e-4:
        return bristle_steps.shoot(n, 1e-11)[-1]
    if softer == 1.0:
        raise ArithmeticError(f"too stiff for steps: {n}")
    soft = n._replace(stiffness=n.stiffness / softer, breaks_at=n.breaks_at * softer)
    track = bristle_steps.shoot(soft, 1e-11)[-1] if 10.0 * own >= 2e-3 else _collocated(soft)
    if track is None:
        raise ArithmeticError(f"no guess: {n}")
    track = track.track if isinstance(track, bristle_collocation.Found) else track
    track[:, 2 + 2 * n.size // 3 :] /= softer
    return track


def write(name, head, rows):
    """One file."""
    with (HERE / name).open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(head)
        lines.writerows([[repr(item) if isinstance(item, float) else item for item in row] for row in rows])


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    for part in sys.argv[1:] or ("w4", "more"):
        {"w4": w4, "more": more, "bench": bench}[part]()
