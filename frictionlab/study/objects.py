"""A study from Python objects, read and checked as the study file that would say the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path as FilePath
from typing import Any

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.mistakes.notes import Notes, python_text
from frictionlab.scene.scene import Scene
from frictionlab.scene.waveforms import Form
from frictionlab.study.law_files import StudyLaws
from frictionlab.study.parts import SCHEMA, plain_values
from frictionlab.study.reader import read_values
from frictionlab.study.yaml_source import read_mapping

LawsGiven = FrictionLaw | Sequence[FrictionLaw] | Mapping[str, FrictionLaw]
"""One law, several, or several by label."""
MethodsGiven = str | Method | Sequence[str | Method] | Mapping[str, str | Method]


def values_of_objects(
    scene: Scene,
    laws: LawsGiven,
    methods: MethodsGiven = "auto",
    sweep: Mapping[str, Any] | None = None,
    **told: Any,
) -> dict[str, Any]:
    """The values of a study of these objects; see ``Study.of``."""
    if not isinstance(scene, Scene):
        raise TypeError(f"scene must be an fl.Scene, got {python_text(scene)}")
    labelled = list(_labelled(laws, "laws", FrictionLaw, "a friction law such as fl.Coulomb(mu=0.4)"))
    kinds = [kind_of(law) for _, law in labelled]
    tree: dict[str, Any] = {"schema": SCHEMA, "scene": _plain(scene.given())}
    tree["laws"] = [
        {
            "kind": kind,
            **plain_values(law),
            **({"label": label} if label else {}),
        }
        for kind, (label, law) in zip(kinds, labelled, strict=True)
    ]
    what = "a name such as 'auto', or a method such as fl.March()"
    tree["methods"] = [
        _method(label, one) for label, one in _labelled(methods, "methods", str | Method, what)
    ]
    tree |= {"sweep": _plain(sweep)} if sweep else {}
    classes = {kind: type(law) for kind, (_, law) in zip(kinds, labelled, strict=True)}
    own = {kind: law for kind, law in classes.items() if kind not in registry.law_names()}
    source = read_mapping(tree | {key: value for key, value in told.items() if value is not None}, "study")

    def bring(_tree: dict[str, Any], _folder: FilePath, _notes: Notes) -> StudyLaws:
        return StudyLaws((), registry.Laws(own))

    return read_values(source, bring=bring)


def kind_of(law: FrictionLaw) -> str:
    """The registered name of a law, of several that of its file; its class's where it is not registered."""
    names = []
    for name in registry.law_names():
        with suppress(registry.BrokenPlugin):  # another law's trouble
            if registry.law_class(name) is type(law):
                names.append(name)
    file = type(law).__module__.rpartition(".")[2].replace("_", "-")
    return file if file in names else next(iter(names), type(law).__name__)


def _labelled(given: Any, name: str, kind: Any, what: str) -> Iterator[tuple[str, Any]]:
    """Each with its label, '' where that is left to the study."""
    if isinstance(given, Mapping):
        pairs = list(given.items())
    else:
        one = isinstance(given, str) or not isinstance(given, Sequence)
        pairs = [(getattr(each, "label", ""), each) for each in ([given] if one else given)]
    for label, each in pairs:
        if not isinstance(each, kind):
            raise TypeError(f"{name} must be {what}, several of them or a mapping, got {python_text(each)}")
        yield label, each


def _method(label: str, given: str | Method) -> str | dict[str, Any]:
    if isinstance(given, str):
        return {"kind": given, "label": label} if label else given
    told = {"kind": given.name, **given.model_dump(exclude_unset=True)}
    return told | ({"label": label} if label else {})


def _plain(value: Any) -> Any:
    """Waveforms as a study file writes them."""
    if isinstance(value, Form):
        return value.plain()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value
