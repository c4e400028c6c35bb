"""Laws compared from Python: the same numbers as those of a run, and every way to hand them on."""

from __future__ import annotations

import builtins
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fig_4b import LAW, SCENE
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab.values.notes import StudyError

LAWS = {"rough": LAW, "smooth": fl.Coulomb(mu=0.2)}
SPEEDS = np.linspace(1.0, 58.0, 20).tolist()


@pytest.fixture(scope="module")
def compared() -> fl.Run:
    return fl.compare(SCENE, LAWS, SPEEDS)


def test_numbers_are_those_of_single_curves(compared: fl.Run) -> None:
    for label, law in LAWS.items():
        own = compared.table[compared.table["law"] == label]["mean_friction"].to_numpy()
        np.testing.assert_array_equal(own, fl.curve(SCENE, law, SPEEDS)["mean_friction"].to_numpy())
    assert len(compared.curves) == 2


def test_arrays_have_a_dimension_for_each_input_that_is_swept() -> None:
    over = {"scene.drive.frequency": [1.0, 1.5], "scene.belt_speed": SPEEDS}
    found = fl.sweep(SCENE, LAWS, over, columns=["mean_friction"]).to_xarray()
    assert dict(found.sizes) == {"law": 2, "scene.drive.frequency": 2, "scene.belt_speed": 20}
    one = found["mean_friction"].sel(law="rough")
    alone = fl.curve(SCENE.with_(**{"drive.frequency": 1.5}), LAWS["rough"], SPEEDS)["mean_friction"]
    np.testing.assert_array_equal(one.loc[{"scene.drive.frequency": 1.5}].to_numpy(), alone.to_numpy())


def test_without_xarray_the_extra_is_named(compared: fl.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    bring = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == "xarray":
            raise ImportError(name)
        return bring(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="pip install"):
        compared.to_xarray()


@deep("seconds of reports")
def test_a_saved_comparison_is_a_run_that_goes_on(compared: fl.Run, tmp_path: Path) -> None:
    folder = compared.save(tmp_path / "run")
    assert (folder / "report.html").exists()
    assert (folder / "figures" / "mean_friction.svg").exists()
    again = fl.run(compared.study, out=folder)
    assert again.computed == 0
    assert_frame_equal(again.table, compared.table)


@deep("seconds of reports")
def test_the_report_is_one_file(compared: fl.Run, tmp_path: Path) -> None:
    page = compared.report(tmp_path / "page.html")
    assert "<svg" in page.read_text() or "data:image" in page.read_text()
    assert "<title>page</title>" in page.read_text()
    assert list(tmp_path.iterdir()) == [page]


def test_a_notebook_shows_a_row_for_each_curve(compared: fl.Run) -> None:
    shown = compared._repr_html_()
    assert shown.count("<tr>") == 1 + 2
    assert shown.count("<polyline") == 2
    assert "concave" in shown or "convex" in shown
    assert str(compared).startswith("40 points: 40 ok")


def test_a_figure_is_handed_over_and_nothing_written(
    compared: fl.Run, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    figure = compared.plot("differences", width="single", title=False, against="smooth")
    assert "smooth" in figure.axes[0].get_ylabel()
    assert figure.get_figwidth() == pytest.approx(85 / 25.4)
    assert not list(tmp_path.iterdir())

    with pytest.raises(ValueError, match="no figure 'shapes'; this table has: differences"):
        compared.plot("shapes")
    with pytest.raises(ValueError, match=r"figures: widths: unknown key"):
        compared.plot(widths="single")


def test_names_of_laws_are_text_not_markup() -> None:
    shown = fl.compare(SCENE, {"<b>": LAWS["rough"]}, [5.0])._repr_html_()
    assert "&lt;b&gt;" in shown
    assert "<b>" not in shown


def test_mistakes_are_told_before_anything_is_solved() -> None:
    with pytest.raises(StudyError, match=r"did you mean 'scene.belt_speed'"):
        fl.sweep(SCENE, LAWS, {"scene.belt_sped": [1.0]})
    with pytest.raises(TypeError, match=r"scene must be an fl.Scene"):
        fl.compare({}, LAWS, [1.0])  # type: ignore[arg-type]


def test_laws_of_one_kind_are_told_apart_by_their_labels() -> None:
    soft, stiff = (fl.Dahl(mu=0.4, stiffness=k, label=f"Dahl {k}") for k in (4.0, 40.0))
    study = fl.Study.of(SCENE, [soft, stiff])
    assert [law.label for law in study.laws] == ["Dahl 4.0", "Dahl 40.0"]
    assert "label: Dahl 40.0" in study.to_yaml()
    assert repr(soft).endswith("label='Dahl 4.0')")
    assert soft.under_load(2.0).label == "Dahl 4.0"
    assert soft == fl.Dahl(mu=0.4, stiffness=4.0)
    assert pickle.loads(pickle.dumps(soft)).label == "Dahl 4.0"
    assert "label" not in soft.model_dump_json()
    rough = fl.Coulomb(mu=0.4, label="rough")
    assert fl.curve(SCENE, rough, [60.0])["law"].tolist() == ["rough"]

    with pytest.raises(StudyError, match=r"laws\[1\].label: laws\[0\] has the label 'rough' too"):
        fl.compare(SCENE, [rough, fl.Dahl(mu=0.4, stiffness=4, label="rough")])
    with pytest.raises(StudyError, match=r"laws\[1\]: laws\[0\] has the label 'coulomb' too"):
        fl.compare(SCENE, [fl.Coulomb(mu=0.4), fl.Coulomb(mu=0.2)])
    with pytest.raises(ValueError, match="label must be one line of visible text, got 3"):
        fl.Coulomb(mu=0.4, label=3)


def test_dupont_is_the_elasto_plastic_law() -> None:
    assert fl.Dupont is fl.ElastoPlastic
