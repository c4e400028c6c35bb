"""The solver in the explorer's page, under node, against ``exact``: two programs written apart."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fig_4b import LAW
from profiles import deep, some

import frictionlab as fl
from frictionlab.report import explorer as page
from frictionlab.runner.curve_table import curve_table

NODE = shutil.which("node") or shutil.which("nodejs")
pytestmark = pytest.mark.skipif(NODE is None, reason="node is not installed: the page's solver is not run")

BEGIN = f"const solver = require({json.dumps(str(page.PAGE_PARTS / 'solver.js'))});\n" + (
    "const given = JSON.parse(require('fs').readFileSync(0, 'utf8'));\n"
    "const sceneOf = (each) => solver.makeScene(each.frequency, each.damping, each.friction);\n"
    "const told = (value) => console.log(JSON.stringify(value));\n"
)
MU = LAW.mu


def in_node(script: str, given: Any = None) -> Any:
    """What a script tells that has the solver."""
    assert NODE is not None
    command = [NODE, "-e", BEGIN + script]
    done = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A scene of the page with six belt speeds over V_lin; some graze it, or are far below it."""
    frequency = 1.0 if rng.random() < 0.1 else float(rng.uniform(0.2, 5.0))
    damping = 1.0 if rng.random() < 0.05 else float(10.0 ** rng.uniform(-2.0, math.log10(2.0)))
    friction = 1.0 if rng.random() < 0.05 else float(rng.uniform(1e-3, 1.5))
    graze = 1.0 - 10.0 ** rng.uniform(-9, -2)
    slow = 10.0 ** rng.uniform(-3.0, -1.0)
    ratios = [0.0, graze, slow, *rng.uniform(0.0, 1.2, 3)]
    return {"frequency": frequency, "damping": damping, "friction": friction, "ratios": ratios}


def draw_of_a_run(rng: np.random.Generator) -> dict[str, Any]:
    """A scene that a run may have, beyond where the sliders end on their own."""
    frequency, damping, friction = 10.0 ** rng.uniform([-1.3, -3.0, -3.0], [1.3, 0.7, 0.7])
    ratios = [0.0, 1.0 - 1e-6, 10.0 ** rng.uniform(-3.0, 0.0), *rng.uniform(0.0, 1.2, 3)]
    return {"frequency": frequency, "damping": damping, "friction": friction, "ratios": ratios}


def v_lin(scene: dict[str, Any]) -> float:
    frequency = scene["frequency"]
    stiffness = (1.0 - frequency) * (1.0 + frequency)
    return float(frequency / math.hypot(stiffness, 2.0 * scene["damping"] * frequency))


def exact_curve(scene: dict[str, Any], ratios: Any) -> pd.DataFrame:
    body = {"damping_ratio": scene["damping"], "normal_load": scene["friction"] / MU, "belt_speed": 1.0}
    body["drive"] = fl.Drive(amplitude=1.0, frequency=scene["frequency"])
    speeds = np.array(ratios) * v_lin(scene)
    return fl.curve(fl.Scene(**body), LAW, speeds, method="exact", columns="all")


POINTS = """
told(given.map((each) => each.ratios.map((ratio) => {
  const scene = sceneOf(each), point = solver.solvePoint(scene, ratio * scene.limitSpeed);
  return [point.mean, point.stick, scene.friction * point.work, point.unique];
})));
"""


@some(1, "a process of node each")
@pytest.mark.parametrize(
    ("drawn", "seed", "size"),
    [
        (draw, 1, 60),
        (draw_of_a_run, 3, 20),
        pytest.param(draw, 2, 500, marks=deep("five hundred scenes")),
        pytest.param(draw_of_a_run, 4, 500, marks=deep("five hundred scenes of runs")),
    ],
)
def test_the_page_finds_what_exact_finds(drawn: Any, seed: int, size: int) -> None:
    rng = np.random.default_rng(seed)
    scenes = [drawn(rng) for _ in range(size)]

    found = in_node(POINTS, scenes)

    for scene, points in zip(scenes, found, strict=True):
        table = exact_curve(scene, scene["ratios"])
        for (mean, stick, work, unique), (_, row) in zip(points, table.iterrows(), strict=True):
            assert unique == (row["status"] == "ok"), (scene, row["reason"])
            if unique:
                assert mean == pytest.approx(row["mean_friction"] / MU, abs=1e-10), scene
                assert stick == pytest.approx(row["stick_fraction"], abs=1e-9), scene
                assert work == pytest.approx(row["energy_friction"], abs=1e-9, rel=1e-9), scene
            else:
                assert row["mean_high"] == pytest.approx(MU * (1.0 - 1.0 / scene["friction"]), abs=1e-12)


def test_without_friction_the_curve_is_the_arcsine() -> None:
    scene = {"frequency": 1.3, "damping": 0.1, "friction": 0.0}
    script = "const {speeds, means} = solver.solveCurve(sceneOf(given), 40); told([speeds, means]);"

    speeds, means = np.array(in_node(script, scene))
    assert means == pytest.approx(2.0 / math.pi * np.arcsin(speeds), abs=1e-12)


CURVES = """
told(given.map((each) => {
  const curve = solver.solveCurve(sceneOf(each), 120);
  return { ...curve, ...solver.shapeVerdict(curve) };
}));
"""
SHAPES = [
    {"frequency": 1.0, "damping": 0.1, "friction": 0.4},
    {"frequency": 1.5, "damping": 0.1, "friction": 0.2},
    {"frequency": 4.0, "damping": 0.1, "friction": 0.6},
    {"frequency": 1.0, "damping": 0.05, "friction": 1.2},
    {"frequency": 0.5, "damping": 0.3, "friction": 0.5},
]


@deep("a process of node")
def test_the_page_gives_the_verdict_of_the_table_of_curves() -> None:
    found = in_node(CURVES, SHAPES)

    for scene, curve in zip(SHAPES, found, strict=True):
        table = exact_curve(scene, curve["speeds"])
        table["mean_friction"] = table["mean_friction"].astype(float)
        (row,) = curve_table(table).to_dict("records")
        assert curve["verdict"] == row["shape"], scene
        assert curve["area"] == pytest.approx(row["shape_area"], abs=curve["error"] + row["shape_area_error"])
        assert curve["means"][:-1] == pytest.approx(table["mean_friction"].iloc[:-1] / MU, abs=1e-10)
    assert len({curve["verdict"] for curve in found}) > 1


ORBIT = """
const scene = sceneOf(given), belt = given.ratio * scene.limitSpeed, point = solver.solvePoint(scene, belt);
told({ samples: solver.sampleOrbit(scene, belt, point, 200), mean: point.mean, belt, period: scene.period });
"""


def test_the_orbit_drawn_closes_and_obeys_the_law_of_friction() -> None:
    found = in_node(ORBIT, {"frequency": 4.0, "damping": 0.1, "friction": 0.8, "ratio": 0.4})

    samples = pd.DataFrame(found["samples"])
    first, last = samples.iloc[0], samples.iloc[-1]
    wanted = [found["period"], first["x"], first["w"]]
    assert last[["t", "x", "w"]].tolist() == pytest.approx(wanted, abs=1e-12)
    rests = samples["stick"].astype(bool)
    assert rests.any()
    assert not rests.all()
    assert (samples["w"][rests] == 0.0).all()
    assert samples["friction"][rests].abs().max() <= 1.0 + 1e-12
    assert (samples["friction"][~rests] * samples["w"][~rests] >= -1e-12).all()
    impulse = np.trapezoid(samples["friction"], samples["t"])
    assert -impulse / found["period"] == pytest.approx(found["mean"], abs=1e-4)


def test_newton_closes_the_period_within_a_few_maps() -> None:
    script = """
    told(given.map((each) => {
      const scene = sceneOf(each);
      return [0.05, 0.2, 0.4, 0.6, 0.8, 0.95].map((r) => solver.solvePoint(scene, r * scene.limitSpeed).maps);
    }));
    """
    maps = np.array(in_node(script, SHAPES))

    assert maps.mean() < 8.0
    assert maps.max() < 20


@deep("measures time")
def test_a_curve_of_120_points_takes_less_than_a_tenth_of_a_second() -> None:
    script = """
    const spent = [];
    for (let i = 0; i < 8; i++) {
      const before = process.cpuUsage();
      solver.solveCurve(sceneOf(given), 120);
      const { user, system } = process.cpuUsage(before);
      spent.push((user + system) / 1000);
    }
    told(Math.min(...spent));
    """
    assert in_node(script, SHAPES[0]) < 100.0
