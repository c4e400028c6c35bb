"""Bodies known by a table of their receptance: reading, interpolation, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import frictionlab as fl
from frictionlab.scene.receptance import read_receptance
from frictionlab.scene.scene import Receptance
from frictionlab.values.notes import StudyError, WrongValues


def two_modes(p, damping=0.2, coupling=0.5, mass=0.3, loss=0.1):
    """x1 over force of a mass with spring 1, to which another one is tied by a spring and a dashpot."""
    tie = coupling + loss * p
    return 1.0 / (p**2 + damping * p + 1.0 + tie - tie**2 / (tie + mass * p**2))


def write(folder, omega, values, name="h.csv"):
    rows = [f"{float(a)!r},{float(b.real)!r},{float(b.imag)!r}" for a, b in zip(omega, values, strict=True)]
    file = folder / name
    file.write_text("\n".join(["frequency,real,imaginary", *rows]) + "\n")
    return str(file)


def test_of_one_mode_between_any_frequencies_nothing_is_lost(tmp_path):
    omega = np.linspace(0.0, 12.0, 40)
    file = write(tmp_path, omega, 1.0 / (1.0 - omega**2 + 0.2j * omega))

    at = np.linspace(0.0, 12.0, 777)

    np.testing.assert_allclose(
        read_receptance(file, 1.0).receptance(at), 1.0 / (1.0 - at**2 + 0.2j * at), rtol=1e-11
    )


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        (["1,1,0", "2,1,-1"], "h.csv:2: begins at frequency 1: frequency 0 is required"),
        (["0,1,0", "2,1,-1", "1,1,-1"], "h.csv:4: frequency 1 after 2: frequencies must rise"),
        (["0,1,0", "1,1,-1", "1,1,-1"], "h.csv:4: frequency 1 is repeated"),
        (["0,1,0", "1,1,-1", "2,1,0.5"], "h.csv:4: not passive at frequency 2"),
        (["0,1,0", "1,one,-1"], "h.csv:3: needs three numbers, got '1,one,-1'"),
        (["0,1,0.1", "1,1,-1"], "h.csv:2: at frequency 0 the receptance is real and above 0"),
        (["0,1,0"], "h.csv: needs at least two rows"),
    ],
)
def test_a_wrong_table_is_told_with_its_line(tmp_path, rows, sentence):
    file = tmp_path / "h.csv"
    file.write_text("\n".join(["frequency,real,imaginary", *rows]) + "\n")

    with pytest.raises(WrongValues, match=r"h\.csv") as told:
        Receptance(file=str(file))

    assert sentence in str(told.value)


def test_a_study_names_the_file_from_its_own_folder_and_is_told_what_is_wrong(tmp_path):
    omega = np.linspace(0.0, 12.0, 481)
    write(tmp_path, omega, two_modes(1j * omega))
    text = """
schema: 1
scene:
  normal_load: 10
  belt_speed: 3
  drive: {amplitude: 10, frequency: 1}
  body: {receptance: {file: h.csv, free_mass: 1}}
laws: [{kind: coulomb, mu: 0.4}]
tolerance: 0.01
"""
    study = tmp_path / "study.yaml"
    study.write_text(text)

    assert fl.run(study).table["status"].tolist() == ["ok"]

    study.write_text(text.replace("normal_load: 10", "normal_load: 10\n  damping_ratio: 0.1"))
    with pytest.raises(
        StudyError, match=r"damping_ratio: leave it out, body\.receptance stands for the whole body"
    ):
        fl.run(study)
    study.write_text(text.replace("h.csv", "g.csv"))
    with pytest.raises(StudyError, match="there is no file"):
        fl.run(study)
