"""The figure of needs: a panel a curve, verdicts told apart without colour, what cannot be drawn said in words."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd

from frictionlab.charts.needs import needs_figure
from frictionlab.values.columns import NEEDS


def row(curve: str, without: str, verdict: str, change: float, smallest: bool = False) -> dict[str, object]:
    nothing = dict.fromkeys(NEEDS, "")
    told = {"curve": curve, "without": without, "verdict": verdict, "change": change, "smallest": smallest}
    return nothing | told | {"change_error": 1e-6, "within": 4e-3}


def test_verdicts_differ_by_more_than_colour_and_every_curve_has_a_panel() -> None:
    rows = [
        row("slow", "transverse motion", "needed", -0.1),
        row("slow", "contact compliance", "not needed", 4e-4, smallest=True),
        row("slow", "viscosity", "refused", float("nan")),
        row("quick", "transverse motion", "undecided", 4e-3),
    ]
    slow, quick = needs_figure(pd.DataFrame(rows), "A $ title").axes

    assert [axes.get_title(loc="left") for axes in (slow, quick)] == ["slow", "quick"]
    looks = [(bar.get_hatch(), bar.get_facecolor()) for axes in (slow, quick) for bar in axes.patches]
    assert len({hatch for hatch, _ in looks}) == 3
    assert looks[1] == looks[2]  # contact compliance, and the smallest model that is without it
    assert {text.get_text() for text in slow.texts} == {"cannot go alone"}
    assert [text.get_text() for text in quick.texts] == ["no such part", "no such part", "the full one"]
    assert slow.get_xlim() == quick.get_xlim()
    assert slow.get_xlim()[1] > 0.1


def test_one_curve_is_drawn_into_axes_of_ones_own() -> None:
    figure, axes = plt.subplots()

    assert needs_figure(pd.DataFrame([row("slow", "viscosity", "needed", -0.1)]), into=axes) is figure

    assert axes.get_title(loc="left") == "slow"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["needed", "error", "tolerance"]
    plt.close(figure)
