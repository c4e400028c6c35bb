"""Which number moves the mean friction most along a curve: python tests/sensitivity_figure.py.

Writes docs/figures/sensitivities.svg, of the scene of docs/sensitivities.md.
"""

from __future__ import annotations

import tempfile
from itertools import cycle
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

import frictionlab as fl
import frictionlab.charts

PICTURE = Path(__file__).parents[1] / "docs" / "figures" / "sensitivities.svg"
STYLE = Path(frictionlab.charts.__file__).parent / "frictionlab.mplstyle"
SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
NAMES = {
    "law.mu": "friction coefficient",
    "scene.normal_load": "normal load",
    "scene.belt_speed": "belt speed",
    "scene.damping_ratio": "damping ratio",
    "scene.drive.unbalance": "unbalance",
    "scene.drive.frequency": "frequency",
}
SPEEDS = np.concatenate((np.linspace(1.0, 49.0, 25), np.linspace(49.5, 50.4, 10), np.linspace(51.0, 60.0, 4)))


def along_the_curve() -> pd.DataFrame:
    """The elasticities, a row for each belt speed."""
    tables = [
        fl.sensitivities(SCENE.with_(belt_speed=float(speed)), fl.Coulomb(mu=0.4), [*NAMES])
        for speed in SPEEDS
    ]
    return pd.DataFrame([table.set_index("parameter").elasticity for table in tables], index=SPEEDS)


def draw(elasticities: pd.DataFrame, picture: Path) -> None:
    """A line for each number, by colour and dashes."""
    dashes = cycle(["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))])
    with (
        mpl.rc_context(fname=STYLE),
        mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "sensitivities"}),
    ):
        figure, axes = plt.subplots(figsize=(7.0, 4.0), layout="constrained")
        for (path, name), dash in zip(NAMES.items(), dashes, strict=False):
            axes.plot(elasticities.index, elasticities[path], linestyle=dash, label=name)
        axes.axvline(50.0, color="0.7", linewidth=0.8, zorder=0)
        axes.set_xlabel("belt speed")
        axes.set_ylabel("elasticity of the mean friction")
        axes.set_title("Frequency and unbalance move the mean most, until slip no longer reverses")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
        figure.savefig(picture, metadata={"Date": None} if picture.suffix == ".svg" else None)
        plt.close(figure)


if __name__ == "__main__":
    found = along_the_curve()
    for place in (PICTURE, Path(tempfile.gettempdir()) / "sensitivities.png"):
        draw(found, place)
