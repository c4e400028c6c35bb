"""Four laws at two frequencies, and maps: python tests/law_figures.py [FOLDER].

Writes docs/figures/laws_*.svg and map_*.svg; the same as pixels in colour and in grey, to look at, into FOLDER, a
folder of temporary files where it is left out. What FOLDER has of the runs is not computed again.
"""

from __future__ import annotations

import re
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import pandas as pd
from PIL import Image
from ruamel.yaml import YAML

import frictionlab as fl
from frictionlab.charts.figures import figure_of
from frictionlab.charts.style import STYLE, write_figure
from frictionlab.cli.figures import kept_of
from frictionlab.results.run import Run
from frictionlab.runner.api import with_onsets
from frictionlab.runner.saved import saved_as

PROJECT = Path(__file__).parents[1]
PICTURES = PROJECT / "docs" / "figures"
STUDIES = PROJECT / "studies"
OF_LAWS = {
    name: f"laws_{name}"
    for name in (
        *("mean_friction", "differences", "shape", "velocity", "energies"),
        *("hysteresis", "phase", "time_series", "velocity_harmonics", "friction_harmonics"),
    )
}
"""The figures of the study of four laws, and their files."""
CURVES = {
    "scene.drive.frequency": {"start": 0.7, "stop": 1.5, "num": 17},
    "scene.normal_load": {"start": 1, "stop": 20, "num": 20},
    "scene.belt_speed": {"start": 0.5, "stop": 60, "num": 120},
}
"""A curve of Coulomb friction for each frequency and load."""


def _draw(run: Run, names: dict[str, str], pixels: Path, onsets: pd.DataFrame | None = None) -> None:
    """Draw these figures of a written run."""
    saved = saved_as(run)
    options = replace(saved.study.figures, title=False)
    for name, file in names.items():
        figure = figure_of(saved.table, name, "", onsets, saved.curves, options, kept_of(saved))
        with mpl.rc_context(STYLE):
            drawn, picture = write_figure(figure, pixels / file)
        text = _shortened(drawn.read_text(encoding="utf-8"))
        (PICTURES / drawn.name).write_text(text, encoding="utf-8")
        Image.open(picture).convert("L").save(pixels / f"{file}_grey.png")


def _shortened(svg: str) -> str:
    """The same drawing to a hundredth of a point, without what nobody sees of it."""
    svg = re.sub(r"<!--.*?-->\n?|<metadata>.*?</metadata>\n?", "", svg, flags=re.DOTALL)
    svg = re.sub(r'<g id="[^"]*"', "<g", re.sub(r"\n +", "\n", svg))
    svg = svg.replace("DejaVuSans-Oblique-", "o").replace("DejaVuSans-", "g")
    svg = re.sub(r' d="[^"]*"', _lines_shortened, svg)
    places = r'(?: d="|translate\(|[ <][xy]=")[^")]*'
    return re.sub(places, lambda part: re.sub(r"\d+\.\d{3,}", _rounded, part[0]), svg)


def _lines_shortened(path: re.Match[str]) -> str:
    """Points that follow one another in a path of straight lines need no letter."""
    straight = not re.search("[QC]", path[0])
    return re.sub(r" *\nL ", " ", path[0]) if straight else path[0]


def _rounded(number: re.Match[str]) -> str:
    return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")


def main(folder: Path) -> None:
    """Draw all of them."""
    laws = with_onsets(fl.run(STUDIES / "four_laws.yaml", out=folder / "laws"))
    _draw(laws, OF_LAWS, folder, laws.onsets)
    means = STUDIES / "frequency_map.yaml"
    _draw(fl.run(means, out=folder / "means"), {"mean_friction": "map_mean"}, folder)
    study = YAML(typ="safe").load(means)
    curves = {key: value for key, value in study.items() if key != "expect"} | {"sweep": CURVES}
    _draw(fl.run(curves, out=folder / "curves"), {"map": "map_shape"}, folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(tempfile.mkdtemp()))
