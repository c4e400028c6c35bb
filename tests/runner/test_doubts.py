"""A number of a law that was meant in another unit is doubted; one with a unit, or of the scene's size, is not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from frictionlab.runner.batch import doubts
from frictionlab.study.load import load_study

STUDY = """schema: 1
scene:
  dimensional:
    {{mass: 0.5 kg, stiffness: 5 kN/m, damping: 5 N s/m, normal_load: 20 N, belt_speed: 2 mm/s,
    belt_vibration: {{frequency: 60 Hz, displacement_amplitude: 5 um}}}}
laws:
  - {{kind: lugre, mu_kinetic: 0.3, mu_static: 0.4, stribeck_speed: {speed}, presliding_length: {length}}}
sweep: {{scene.dimensional.belt_speed: [2 mm/s, 20 mm/s]}}
"""


@pytest.mark.parametrize(
    ("speed", "length", "told"),
    [
        ("1 mm/s", "1 um", []),
        ("0.001", "0.000001", []),
        ("1 m/s", "1 m", []),
        ("1 mm/s", "1", ["presliding_length: 1 m is taken, 200,000 times the amplitude"]),
        ("1", "1 um", ["stribeck_speed: 1 m/s is taken, 50 times the fastest speed of the scene, 20 mm/s"]),
    ],
)
def test_a_bare_number_out_of_all_proportion_is_doubted(
    speed: str, length: str, told: list[str], tmp_path: Path
) -> None:
    file = tmp_path / "study.yaml"
    file.write_text(STUDY.format(speed=speed, length=length))
    said: Any = doubts(load_study(file))

    assert len(said) == len(told)
    for sentence, expected in zip(said, told, strict=True):
        assert sentence.startswith(f"{file}:7: laws[0].{expected}")
