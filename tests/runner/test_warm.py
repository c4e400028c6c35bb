"""Kernels compiled ahead: of every law, for every kind of scene; a run then compiles none."""

from __future__ import annotations

from unittest.mock import Mock

import pytest

import frictionlab as fl
from frictionlab import cli
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.runner import warm as module
from frictionlab.runner.warm import SCENES, Warmed, _form, forms, warm
from frictionlab.study import registry


@pytest.mark.parametrize("name", registry.law_names())
def test_every_law_has_a_form(name: str) -> None:
    found = forms(registry.law_class(name))

    assert found
    assert len(set(map(_form, found))) == len(found)


def test_a_law_has_all_forms_that_kernels_are_compiled_for() -> None:
    falling = fl.LuGre(mu_kinetic=0.4, mu_static=0.5, stribeck_speed=1, stiffness=1)
    constant = fl.LuGre(mu_kinetic=0.4, stiffness=1)

    assert set(map(_form, forms(fl.LuGre))) == {_form(falling), _form(constant)}
    assert _form(falling) != _form(constant)


def test_each_kind_of_scene_is_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here by Python: which kernels are compiled ahead is the same."""
    asked = Mock(), Mock()
    monkeypatch.setattr(module, "steady_state", asked[0])
    monkeypatch.setattr(module, "curve", asked[1])
    done = [each._replace(seconds=0.0) for each in warm({"coulomb": fl.Coulomb})]

    assert done == [Warmed("coulomb", scene, 0, 0.0) for scene in SCENES]
    freedoms = [{call.args[0].degrees_of_freedom for call in each.call_args_list} for each in asked]
    assert freedoms == [{0, 1, 2}, {2}]


@pytest.mark.parametrize("scene", SCENES)
def test_its_scenes_have_answers(scene: str) -> None:
    assert fl.steady_state(SCENES[scene], fl.Coulomb(mu=0.5), tolerance=1e-4).status == "ok"


def test_a_kernel_compiled_ahead_serves_the_next_process(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.setenv("FRICTIONLAB_CACHE", str(tmp_path))
    monkeypatch.setattr(module, "SCENES", {"a point": SCENES["slip given along the belt"]})
    monkeypatch.setattr(module, "steady_state", lambda _, law, **__: KernelCall(friction_at, law)(1.0))

    assert cli.main(["warm", "coulomb"]) == 0
    assert capsys.readouterr().out.startswith("coulomb, a point: 1 compiled in ")
    assert len(list(tmp_path.glob("*.kernel"))) == 1
    assert cli.main(["warm", "coulomb"]) == 0
    assert capsys.readouterr().out == "coulomb, a point: all kept already\n"


@njit
def friction_at(law, v):
    return law.sliding_vector(v)


def test_an_unknown_law_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["warm", "colomb"]) == 2
    assert "unknown law 'colomb'; installed: " in capsys.readouterr().err
