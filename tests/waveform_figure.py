"""Waveforms of a drive compared at equal mean square of the force: python tests/waveform_figure.py.

Writes docs/figures/waveforms.svg. A study sweeps every waveform over every amplitude; here each has its own.
"""

from __future__ import annotations

import math
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

import frictionlab as fl
from frictionlab.charts.figures import draw_figures

PICTURE = Path(__file__).parents[1] / "docs" / "figures" / "waveforms.svg"
TITLE = "Four forces of equal mean square"
PEAKS = {"sine": math.sqrt(2.0), "square": 1.0, "triangle": math.sqrt(3.0), "sawtooth": math.sqrt(3.0)}
"""Over the root of the mean square."""
FORCE = 30.0


def compared() -> pd.DataFrame:
    """A curve for each waveform, of the scene of studies/michaux_waveforms.yaml."""
    tables = [
        fl.curve(
            fl.Scene(
                damping_ratio=0.05,
                normal_load=0.1,
                belt_speed=0.0,
                drive=fl.Drive(amplitude=FORCE * peak, frequency=30.0, waveform=waveform),
            ),
            fl.Coulomb(mu=1.0),
            belt_speed=np.linspace(0.02, 2.0, 100),
        )
        for waveform, peak in PEAKS.items()
    ]
    return pd.concat(tables, ignore_index=True).drop(columns="scene.drive.amplitude")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        draw_figures(compared(), TITLE, Path(folder))
        shutil.copy(Path(folder) / "mean_friction.svg", PICTURE)
        shutil.copy(Path(folder) / "mean_friction.png", Path(tempfile.gettempdir()) / "waveforms.png")
