"""The page of a fit: sentences, the figure, how well each law fits, the numbers with their errors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from frictionlab.printable import with_error
from frictionlab.report.figures import address
from frictionlab.report.page import rendered
from frictionlab.report.tables import Grid, grid, size
from frictionlab.runner.folder import write_page

FIT_CAPTION = (
    "Measured and fitted; what is left, fitted less measured; and how far neighbours in that are alike: "
    "its autocorrelation, which stays within the dashed lines where rows are independent."
)


def write_fit_page(found: Any, path: Any, title: str = "") -> Path:
    """Write the page; where it is. The figure is that of the folder ``figures`` beside it, if there is one.

    Raises SaveError.
    """
    file = Path(path)
    write_page(
        file, fit_page(found, title or "A fit to measurements", address(file.parent / "figures" / "fit"))
    )
    return file


def fit_page(found: Any, title: str, picture: str) -> str:
    """The page as HTML."""
    parts = {"sentences": found.sentences, "laws": _laws(found.laws), "numbers": _numbers(found.table)}
    return rendered("fit.html", title=title, picture=picture, caption=FIT_CAPTION, **parts)


def _laws(table: pd.DataFrame) -> Grid:
    head = ["law", "rms", "left out", "AIC", "starts that agree", "why there is no fit"]
    rows = [
        [
            str(row["law"]),
            f"{row['rms']:.4g}",
            with_error(row["left_out_rms"], row["left_out_rms_error"]),
            f"{row['aic']:.5g}",
            f"{row['starts_agreeing']:.0f}",
            "",
        ]
        if row["status"] == "ok"
        else [str(row["law"]), "", "", "", "", str(row["reason"])]
        for _, row in table.iterrows()
    ]
    return grid("Laws, by what is left over", head, rows)


def _numbers(table: pd.DataFrame) -> Grid:
    head = ["law", "number", "value", "naive error", "95 %", "profile", "on an end of its range"]
    rows = [
        [
            str(row["law"]),
            str(row["parameter"]),
            with_error(row["value"], row["block_error"]),
            size(row["naive_error"]),
            f"{row['low']:.5g} to {row['high']:.5g}",
            str(row["shape"]),
            "yes" if row["at_bound"] else "",
        ]
        for _, row in table.iterrows()
    ]
    return grid("Fitted numbers, with the error from blocks", head, rows)
