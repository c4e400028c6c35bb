"""Results of a fit: numbers with errors and intervals for each law, how well each foretells, and sentences."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from frictionlab.analysis.fit.errors import (
    Covariances,
    autocorrelation,
    correlation_length,
    covariances,
)
from frictionlab.analysis.fit.free import FreeNumber, Model
from frictionlab.analysis.fit.measured import Measurements
from frictionlab.analysis.fit.profiles import LeftOut, Profile, profile, without_blocks
from frictionlab.analysis.fit.residuals import ON_A_BOUND, Residuals, SearchEnds
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.theory.linear import friction_free_velocity
from frictionlab.values.printable import with_error
from frictionlab.values.quantities import Floats
from frictionlab.values.units import ShownUnit, handy_unit


class FitParameter(NamedTuple):
    """Fitted number with its standard error, range, SI unit and correlations with the others, as lmfit has them."""

    value: float
    stderr: float
    min: float
    max: float
    unit: str
    correl: dict[str, float]


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """One law at its optimum; errors, profiles and what it foretells are found when asked for.

    blocks: of each row; blocks_from: a word on where they are from. parts: blocks left out, the same for all.
    """

    residuals: Residuals
    found: SearchEnds
    blocks: NDArray[np.int64]
    blocks_from: str
    parts: NDArray[np.int64] | None = None

    @property
    def model(self) -> Model:
        """Return the law, its scene and its free numbers."""
        return self.residuals.model

    @cached_property
    def said(self) -> Floats:
        """Return what it says at each row."""
        return self.residuals.said(self.found.best.shares)

    @property
    def raw(self) -> Floats:
        """Said less measured."""
        return self.said - self.residuals.measured.values

    def autocorrelation(self, order: NDArray[np.int64], most: int) -> Floats:
        """Autocorrelation of what is left, in this order of rows, up to this lag."""
        return autocorrelation(self.raw[order], most)

    @property
    def chi2(self) -> float:
        """Sum of squares over the stated variances."""
        return 2.0 * self.found.best.cost

    @cached_property
    def covariances(self) -> Covariances:
        """Covariances of the shares of the ranges; numbers on an end of their range are held."""
        free = [place for place, bound in enumerate(self.on_a_bound) if not bound]
        slopes = np.zeros((len(self.raw), len(self.on_a_bound)))
        if free:
            slopes[:, free] = self.residuals.slopes(self.found.best.shares, free)
        stated = self.residuals.measured.sigma is not None
        return covariances(slopes, self.found.best.residuals, self.blocks, stated)

    @cached_property
    def profiles(self) -> tuple[Profile, ...]:
        """Profile of each number."""
        errors = self.covariances
        rises = np.maximum(errors.scale * (errors.quantile * errors.inflation) ** 2, 1e-300)
        return tuple(
            profile(self.residuals, self.found.best, place, float(rise), self.found.others)
            for place, rise in enumerate(rises)
        )

    @cached_property
    def left_out(self) -> LeftOut:
        """Return how well it foretells blocks that it was not fitted to."""
        parts = self.blocks if self.parts is None else self.parts
        return without_blocks(self.residuals, self.found.best, parts)

    @property
    def values(self) -> dict[str, float]:
        """Return the fitted numbers."""
        return self.model.values(self.found.best.shares)

    def errors(self, covariance: Floats) -> dict[str, float]:
        """Standard errors of the values; NaN for a number on an end of its range, or if wider than that."""
        values, found = self.values, {}
        for each, size, bound in zip(
            self.model.free, np.sqrt(np.diag(covariance)), self.on_a_bound, strict=True
        ):
            error = float(each.slope(values[each.name]) * size)
            found[each.name] = math.nan if bound or error > each.high - each.low else error
        return found

    @property
    def params(self) -> dict[str, FitParameter]:
        """Return value, error, range, unit and correlations of each number, by blocks."""
        spread, errors = self.covariances.by_blocks, self.errors(self.covariances.by_blocks)
        sizes = np.sqrt(np.diag(spread))
        with np.errstate(invalid="ignore", divide="ignore"):
            alike = spread / np.outer(sizes, sizes)
        names = list(self.values)
        return {
            each.name: FitParameter(
                self.values[each.name], errors[each.name], each.low, each.high, self.model.unit(each.name),
                {names[k]: float(alike[at, k]) for k in range(len(names)) if k != at},
            )
            for at, each in enumerate(self.model.free)
        }  # fmt: skip

    @property
    def on_a_bound(self) -> list[bool]:
        """Check which numbers are on an end of their range."""
        shares = self.found.best.shares
        return [bool(min(share, 1.0 - share) < ON_A_BOUND) for share in shares]

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Intervals of 95 %, by profiles that rise as blocks scatter."""
        return {
            each.name: (each.value(one.low), each.value(one.high))
            for each, one in zip(self.model.free, self.profiles, strict=True)
        }

    @property
    def shapes(self) -> dict[str, str]:
        """Shape of each profile, in a word."""
        return {each.name: one.form for each, one in zip(self.model.free, self.profiles, strict=True)}

    @property
    def rms(self) -> float:
        """Root mean square of said less measured."""
        return float(np.sqrt(np.mean(self.raw**2)))

    @property
    def aic(self) -> float:
        """Akaike's criterion: of stated errors by chi2, else by the residuals' own size."""
        count, numbers = len(self.raw), len(self.model.free)
        if self.residuals.measured.sigma is not None:
            return self.chi2 + 2.0 * numbers
        return count * float(np.log(np.mean(self.raw**2) or 1e-300)) + 2.0 * (numbers + 1)


STOPPED = "interrupted"
"""Why a law has no fit where the search or its errors were stopped."""
PARTS_OF_A_FIT: dict[str, Callable[[FittedLaw], Any]] = {
    "profiles": lambda law: law.profiles,
    "blocks left out": lambda law: law.left_out,
}


@dataclass(frozen=True, eq=False, repr=False)
class FittedLaws:
    """Laws fitted to measurements; the best one predicts blocks left out best, and is named first.

    ``fl.fit`` returns it.

    Attributes
    ----------
    measured : Measurements
        Measurements.
    fitted : tuple of FittedLaw
        Record of each law.
    failed : dict of str to str
        Reason for each law without a fit.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> data = {"belt_speed": [5, 15, 25, 35], "mean_friction": [0.05, 0.135, 0.22, 0.29]}
    >>> found = fl.fit(data, fl.Coulomb(mu=0.3), scene, free={"mu": (0.1, 1.0)}, starts=2)
    >>> found.law.mu == found.values["mu"] == found.best.values["mu"], found.scene == scene
    (True, True)
    >>> found.block_errors["mu"] > 0, found.naive_errors["mu"] > 0, found.intervals["mu"][0] < found.values["mu"]
    (True, True, True)
    >>> found.params["mu"].min, found.params["mu"].stderr == found.block_errors["mu"]
    (0.1, True)
    >>> found.shapes, found.table["parameter"].tolist(), found.laws["status"].tolist()
    ({'mu': 'bounded'}, ['mu'], ['ok'])
    >>> len(found.residuals), found.sentences[0].partition(" with")[0]
    (4, 'Coulomb fits')
    >>> found.plot().savefig("fit.svg")
    >>> print(found.report("fit.html", title="Fit"))
    fit.html
    >>> found.complete(print).is_interrupted
    Coulomb: profiles
    Coulomb: blocks left out
    False
    """

    measured: Measurements
    fitted: tuple[FittedLaw, ...]
    failed: dict[str, str] = field(default_factory=dict)

    def complete(self, tell: Callable[[str], None]) -> FittedLaws:
        """Compute errors, profiles and predictions now, law by law; an interrupt keeps the laws that are done.

        Parameters
        ----------
        tell : callable
            Function that is called with the name of what is being computed.

        Returns
        -------
        FittedLaws
            These laws, or those that were done before an interrupt.

        Raises
        ------
        KeyboardInterrupt
            If an interrupt comes before a law is done.
        """
        done: list[FittedLaw] = []
        for each in self.fitted:
            try:
                for what, find in PARTS_OF_A_FIT.items():
                    tell(f"{each.model.words}: {what}")
                    find(each)
            except KeyboardInterrupt:
                if not done:
                    raise
                left = self.fitted[len(done) :]
                return FittedLaws(
                    self.measured, tuple(done), self.failed | {one.model.label: STOPPED for one in left}
                )
            done.append(each)
        return self

    @property
    def is_interrupted(self) -> bool:
        """True if an interrupt left laws out."""
        return STOPPED in self.failed.values()

    @property
    def best(self) -> FittedLaw:
        """Law that predicts blocks left out best."""
        if len(self.fitted) == 1:
            return self.fitted[0]
        return min(self.fitted, key=lambda each: each.left_out.rms)

    @property
    def values(self) -> dict[str, float]:
        """Fitted numbers of the best law, by name."""
        return self.best.values

    @property
    def block_errors(self) -> dict[str, float]:
        """Standard errors of the fitted numbers of the best law, from blocks."""
        return self.best.errors(self.best.covariances.by_blocks)

    @property
    def naive_errors(self) -> dict[str, float]:
        """Standard errors of the fitted numbers of the best law as if residuals were independent."""
        return self.best.errors(self.best.covariances.naive)

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Intervals of 95 % of the fitted numbers of the best law."""
        return self.best.intervals

    @property
    def shapes(self) -> dict[str, str]:
        """Shape of the profile of each fitted number, "bounded", "one-sided", "flat" or "multimodal"."""
        return self.best.shapes

    @property
    def params(self) -> dict[str, FitParameter]:
        """Fitted numbers of the best law with ``value``, ``stderr``, ``min``, ``max``, ``unit`` and ``correl``."""
        return self.best.params

    @property
    def law(self) -> FrictionLaw:
        """Best law with its fitted numbers."""
        return self.best.model.at(self.best.found.best.shares)[0]

    @property
    def scene(self) -> Scene | None:
        """Scene with the fitted numbers; None for a measured path of slip."""
        return self.best.model.at(self.best.found.best.shares)[1]

    @property
    def table(self) -> pd.DataFrame:
        """Table with a row for each law and fitted number.

        Columns: ``value``, ``unit`` in SI, ``block_error``, ``naive_error``, ``low``, ``high``, ``shape``,
        ``at_bound``.
        """
        rows = []
        for each in self.fitted:
            block, naive = each.errors(each.covariances.by_blocks), each.errors(each.covariances.naive)
            for name, bound in zip(each.values, each.on_a_bound, strict=True):
                low, high = each.intervals[name]
                row = {"law": each.model.label, "parameter": name, "value": each.values[name]}
                row["unit"] = each.model.unit(name)
                row |= {"block_error": block[name], "naive_error": naive[name], "low": low, "high": high}
                rows.append(row | {"shape": each.shapes[name], "at_bound": bound})
        return pd.DataFrame(rows)

    @property
    def laws(self) -> pd.DataFrame:
        """Table with a row for each law, on how well it fits and predicts, and how the search went."""
        rows: list[dict[str, Any]] = [
            {
                "law": each.model.label,
                "rms": each.rms,
                "chi2_per_degree": each.chi2 / max(len(each.raw) - len(each.model.free), 1),
                "left_out_rms": each.left_out.rms,
                "left_out_rms_error": each.left_out.error,
                "aic": each.aic,
                "starts_agreeing": each.found.agreeing,
                "evaluations": each.residuals.evaluations,
                "status": "ok",
                "reason": "",
            }
            for each in self.fitted
        ]
        rows += [{"law": law, "status": "failed", "reason": why} for law, why in self.failed.items()]
        return pd.DataFrame(rows)

    @property
    def residuals(self) -> pd.DataFrame:
        """Table of residuals with a row for each law and measured row.

        Columns: ``measured``, ``fitted``, ``residual`` (fitted less measured), and the inputs.
        """
        parts = [
            self.measured.table.drop(columns=[self.measured.value]).assign(
                law=each.model.label, measured=self.measured.values, fitted=each.said, residual=each.raw
            )
            for each in self.fitted
        ]
        return pd.concat(parts, ignore_index=True)

    @property
    def sentences(self) -> list[str]:
        """Results as sentences."""
        return [*_which(self), *_how_sure(self), *_what_to_know(self)]

    def plot(self) -> Any:
        """Draw data and fitted curves, residuals, and autocorrelation of the residuals.

        Returns
        -------
        matplotlib.figure.Figure
            Figure.
        """
        from frictionlab.charts.fits import fit_figure  # with matplotlib, which takes a second

        return fit_figure(self)

    def report(self, path: Any, title: str = "") -> Any:
        """Write a page with sentences and tables, and the figure beside it.

        Parameters
        ----------
        path : str or path-like
            Path of the page.
        title : str, default ""
            Title of the page.

        Returns
        -------
        Path
            Path of the page.

        Raises
        ------
        SaveError
            If the page cannot be written.
        OSError
            If the figure cannot be written.
        """
        from pathlib import Path

        from frictionlab.charts.fits import draw_fit
        from frictionlab.report.page import write_fit_page

        draw_fit(self, title, Path(path).parent / "figures")
        return write_fit_page(self, path, title)

    def __repr__(self) -> str:
        """Its sentences, a line each."""
        return "\n".join(self.sentences)


MOST_WORSE = 10.0
"""Excess of a law's sum of squares over that of the best, in variances of a row (Burnham & Anderson, 2002)."""


def _as_well(law: FittedLaw, best: FittedLaw) -> bool:
    """Check that a law foretells blocks left out no worse than the best does, beyond scatter and noise.

    Scatter between parts alone would not see a misfit that lies in one of them: what is worse is held against the
    noise of as many rows as are independent, too.
    """
    more, error = law.left_out.apart(best.left_out)
    independent = len(best.raw) / correlation_length(best.raw)
    return more <= 2.0 * error and independent * more <= MOST_WORSE * best.left_out.rms**2


def _which(fit: FittedLaws) -> list[str]:
    best, told = fit.best, []
    out = f"{with_error(best.left_out.rms, best.left_out.error)} on blocks left out"
    told.append(f"{best.model.words} fits with an rms of {best.rms:.4g}, {out}")
    for each in sorted(fit.fitted, key=lambda each: each.left_out.rms):
        if each is best:
            continue
        fewer = len(each.model.free) < len(best.model.free)
        if _as_well(each, best):
            what = (
                "it is simpler: the data do not ask for more" if fewer else "the data do not tell them apart"
            )
            told.append(f"{each.model.words} fits as well ({each.left_out.rms:.4g} left out); {what}")
        else:
            told.append(f"{each.model.words} fits worse: {each.left_out.rms:.4g} on blocks left out")
    return told + [f"{law} has no fit: {why}" for law, why in fit.failed.items()]


def _how_sure(fit: FittedLaws) -> list[str]:
    best = fit.best
    block, naive = fit.block_errors, fit.naive_errors
    told = [_told(best, number, block[number.name]) for number in best.model.free]
    ratios = [block[name] / naive[name] for name in block if block[name] > 1.5 * naive[name] > 0.0]
    if ratios:
        times = dict.fromkeys(f"{ratio:.2g}" for ratio in (min(ratios), max(ratios)))
        alike = correlation_length(best.raw)
        samples = (
            f": residuals are correlated over about {alike:.0f} samples, and AIC takes each for independent"
        )
        told.append(
            f"errors from {best.blocks.max() + 1} blocks ({best.blocks_from}) are {' to '.join(times)} times the "
            f"naive ones{samples if alike >= 1.5 else ''}"
        )
    return told


def _told(law: FittedLaw, number: FreeNumber, error: float) -> str:
    """Tell a number with its error and interval, in a unit of a handy size."""
    value, (low, high), name = law.values[number.name], law.intervals[number.name], number.name
    unit = handy_unit(law.model.unit(name), abs(value)) if law.model.unit(name) else ShownUnit("")
    said = with_error(value / unit.size, error / unit.size, 4)
    whole = low <= number.low * (1.0 + 1e-9) and high >= number.high * (1.0 - 1e-9)
    wide = math.isnan(error) and not min(value - number.low, number.high - value) <= 0.0
    untold = "; blocks tell less than its range" if wide else ""
    end = ", the whole range: the data do not tell" if whole else untold
    of = f" {unit.unit}" if unit.unit else ""
    return f"{name} = {said}{of} (95 %: {low / unit.size:.4g} to {high / unit.size:.4g}{of}{end})"


def _what_to_know(fit: FittedLaws) -> list[str]:
    told = []
    if (end := _beyond(fit)) is not None:
        told.append(
            f"all rows lie beyond V_lin = {end}, where friction is that of steady sliding whatever vibrates"
        )
    if fit.measured.missing:
        told.append(f"{fit.measured.missing} samples are missing and were left out")
    for each in fit.fitted:
        label, several = each.model.words, "" if len(fit.fitted) == 1 else f"{each.model.words}: "
        for number, bound in zip(each.model.free, each.on_a_bound, strict=True):
            if bound:
                told.append(
                    f"{several}{number.name} is on an end of its range, {each.values[number.name]:.4g}"
                )
        for number, (name, form) in zip(each.model.free, each.shapes.items(), strict=True):
            if form == "flat" and each is not fit.best:
                told.append(f"{several}{_told(each, number, math.nan)}")
            elif form != "bounded":
                told.append(f"{several}the profile of {name} is {form}")
        if each.found.others:
            other = each.found.others[0]
            at = ", ".join(f"{name} = {x:.4g}" for name, x in each.model.values(other.shares).items())
            worse = np.sqrt(other.cost / each.found.best.cost) if each.found.best.cost else np.inf
            larger = f"{worse:.3g} times as large" if worse >= 1.005 else "as large"
            told.append(f"{several}another minimum: {at}, rms {larger}")
        if each.found.agreeing < 2:
            told.append(
                f"{label}: only {each.found.agreeing} of {each.found.starts} starts found this minimum"
            )
    return told


def _beyond(fit: FittedLaws) -> str | None:
    """Return V_lin in words if all rows of a curve of one scene are beyond it."""
    scene = fit.best.model.scene
    if fit.measured.is_path or scene is None or len(fit.measured.groups) > 1:
        return None
    si = scene.dimensional
    unit, scale = ("", 1.0) if si is None else ("m/s", si.scales.velocity)
    end = scale * friction_free_velocity(scene)
    slowest = float(fit.measured.table[fit.measured.along].abs().min())
    return ShownUnit(unit).text(end).strip() if 0.0 < end < slowest else None
