"""Record of a study: frozen, complete, with every default filled in.

A study from Python objects, read and checked as the study file that would say the same.
"""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from frictionlab.laws.base import FrictionLaw, Record
from frictionlab.methods.base import Method
from frictionlab.scene.scene import Scene
from frictionlab.scene.waveforms import Form
from frictionlab.study import registry
from frictionlab.study.axes import FRICTION, LINKED, SpeedRange
from frictionlab.study.expectations import Expectation
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions
from frictionlab.study.grid import StudyGrid
from frictionlab.study.keys import (
    NOT_KEPT,
    STUDY_KEYS,
    USUAL_LIMIT,
    DataFiles,
    FreeRange,
    Keep,
    Limit,
    StudyKeys,
)
from frictionlab.study.law_files import StudyLaws
from frictionlab.study.parts import SCHEMA, LawChoice, natural, plain_values
from frictionlab.study.reader import read_values
from frictionlab.study.registry import LawFile
from frictionlab.study.written import yaml_text
from frictionlab.study.yaml_source import read_mapping
from frictionlab.values import columns
from frictionlab.values.notes import Notes, python_text
from frictionlab.values.quantities import typed

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
    """Return the values of a study of these objects; see ``Study.of``."""
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
    for kind, (label, law) in zip(kinds, labelled, strict=True):
        if type(law) is not classes[kind]:
            raise TypeError(
                f"laws: {label or kind} and another law are two classes named {kind!r}; rename one"
            )
    own = {kind: law for kind, law in classes.items() if kind not in registry.law_names()}
    source = read_mapping(tree | {key: value for key, value in told.items() if value is not None}, "study")

    def bring(_tree: dict[str, Any], _folder: FilePath, _notes: Notes) -> StudyLaws:
        return StudyLaws((), registry.Laws(own))

    return read_values(source, bring=bring)


def kind_of(law: FrictionLaw) -> str:
    """Return the registered name of a law, of several that of its file; its class's where it is not registered."""
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


LAW_COPIES = "laws"
"""Folder in which a run keeps the files of laws it used."""


@dataclass(frozen=True, repr=False, kw_only=True)
class Study(StudyGrid):
    """Study: scenes, laws and methods, their full grid, and what is asked of the table.

    ``Study.of`` makes a study of Python objects, ``fl.run`` solves it.

    Attributes
    ----------
    scene : Scene
        Scene without sweeps.
    laws : tuple of LawChoice
        Laws with their labels.
    methods : tuple of MethodChoice
        Methods with their labels.
    sweep : dict of str to tuple
        Swept values by path: ``scene.<path>``, ``laws.<label>.<parameter>`` or ``friction``. Words and
        waveforms of a scene can be swept, too.
    ranges : dict of str to SweepRange or SpeedRange
        Sweeps that were given as ranges.
    links : tuple of tuple of str
        Paths of sweeps that advance together.
    chosen : tuple of tuple of float
        Belt speeds of each scene, if a run chooses them.
    path : Path, optional
        File of the study.
    tolerance : float
        Absolute bound [-] on the error of ``mean_friction``.
    expect : tuple of Expectation
        Expectations that a run judges.
    keep : Keep
        Counts of what is written beside the table: ``orbit``, ``attractors``, ``harmonics``; None for none.
    data : DataFiles, optional
        Files of measurements.
    free : dict of str to FreeRange, optional
        Ranges by name of the numbers that ``frictionlab fit`` may change.
    columns : tuple of str, optional
        Result columns and groups of them; None for the default ones.
    limit : Limit
        Longest time that a point may take, ``seconds_per_point`` [s].
    figures : FigureOptions
        Options of the figures.
    boundaries : dict of str to tuple of float
        Measures of curves, and the levels whose lines over the two swept numbers are computed.
    title : str
        Title.
    source : str
        Source of the scene, such as a paper and its figure.
    plugins : tuple of LawFile
        Files of laws.
    code : dict of str to str
        SHA-256 of every law that is not frictionlab's own.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
    >>> fl.Study.of(scene, fl.Coulomb(mu=0.4))
    Study.of(Scene(belt_speed=1, slip=Slip(velocity_amplitude=2, frequency=1)), Coulomb(mu=0.4))
    >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [1, 2]})
    >>> fl.run(study)
    Run(2 points: 2 ok)
    """

    tolerance: float
    expect: tuple[Expectation, ...] = ()
    keep: Keep = NOT_KEPT
    data: DataFiles | None = None
    free: Mapping[str, FreeRange] | None = None
    columns: tuple[str, ...] | None = None
    limit: Limit = USUAL_LIMIT
    figures: FigureOptions = USUAL_FIGURES
    boundaries: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    title: str = ""
    source: str = ""
    plugins: tuple[LawFile, ...] = ()
    code: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        scene: Scene,
        laws: Any,
        methods: Any = "auto",
        sweep: Mapping[str, Any] | None = None,
        **told: Any,
    ) -> Study:
        """Make a study of Python objects.

        Parameters
        ----------
        scene : Scene
            Body and belt, and what shakes them.
        laws : FrictionLaw, list of FrictionLaw, or dict of str to FrictionLaw
            One law, a list of laws, or a mapping label -> law. Two laws of one kind in a list need a
            ``label=``.
        methods : str, Method, or a list or dict of them, default "auto"
            Name of a method, a method such as ``fl.March(steps=1000)``, a list of them, or a mapping
            label -> method.
        sweep : dict of str to list or dict, optional
            Lists or ranges of values by path: ``scene.<path>`` or ``laws.<label>.<parameter>``.
        **told : Any
            Other keys of a study file, such as ``tolerance=1e-6``, ``title=``, ``keep={"orbit": 200}``.

        Returns
        -------
        Study
            Study, as one from a file.

        Raises
        ------
        StudyError
            If the study has mistakes; the message has every one.
        TypeError
            If something is no scene, law or method.

        Examples
        --------
        >>> import frictionlab as fl
        >>> drive = fl.Drive(unbalance=10, frequency=1)
        >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
        >>> study = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": [5, 25]})
        >>> len(study.cases())
        2
        """
        return cls(**values_of_objects(scene, laws, methods, sweep, **told))

    def __repr__(self) -> str:
        """Return what one would type to make it of objects; of long lists the ends."""
        laws = _as_given({choice.label: (choice.kind, choice.law()) for choice in self.laws})
        methods = _as_given(
            {one.label: (one.name, one.method if one.parameters else one.name) for one in self.methods}
        )
        parts = [repr(self.scene), laws, *([] if methods == "'auto'" else [f"methods={methods}"])]
        told = self.resolved()
        usual = {*_OBJECTS, *(["tolerance"] if told["tolerance"] == StudyKeys().tolerance else [])}
        parts += [f"{key}={_typed(value)}" for key, value in told.items() if key not in usual]
        return f"Study.of({', '.join(parts)})"

    def to_yaml(self) -> str:
        """Write the study as the text of a study file, which loads to an equal study.

        Its files of laws must lie beside it.

        Returns
        -------
        str
            Text in YAML.

        Examples
        --------
        >>> import frictionlab as fl
        >>> scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
        >>> print(fl.Study.of(scene, fl.Coulomb(mu=0.4)).to_yaml().rstrip())
        schema: 1
        scene: {normal_load: 1, belt_speed: 1, slip: {velocity_amplitude: 2, frequency: 1, phase: 0}}
        laws: [{kind: coulomb, mu: 0.4}]
        methods: [auto]
        tolerance: 1.0e-08
        """
        return yaml_text(self.resolved())

    def resolved(self) -> dict[str, Any]:
        """Return the study as plain values; with its ``law_texts`` beside it they load to an equal study."""
        keys = {
            name: _as_written(getattr(self, name))
            for name, key in StudyKeys.model_fields.items()
            if name == "tolerance" or getattr(self, name) != key.get_default(call_default_factory=True)
        }
        parts = {
            "scene": natural(self.scene.given()),
            "plugins": list(self.law_texts()),
            "laws": [law.resolved() for law in self.laws],
            "methods": [method.resolved() for method in self.methods],
            "sweep": self._told_sweep(),
        }
        told = {"schema": SCHEMA, **keys, **{key: part for key, part in parts.items() if part}}
        return {key: told[key] for key in STUDY_KEYS if key in told}

    def _told_sweep(self) -> dict[str, Any]:
        told: dict[str, Any] = {}
        for axis in self.axes:
            values = {
                path: natural(self.ranges[path].resolved() if path in self.ranges else list(values))
                for path, values in axis.values.items()
            }
            if tuple(values) in self.links:
                told.setdefault(LINKED, []).append(values)
            else:
                told |= values
        return told

    def selected(self) -> frozenset[str]:
        """Result columns of its table: asked for, of every table, judged by ``expect`` or of ``figures.finding``."""
        judged = [
            each.column for each in self.expect if each.column and each.column not in columns.CURVE_MEASURES
        ]
        of_curves = bool(self.boundaries) or any(
            each.shape or each.column in columns.CURVE_MEASURES for each in self.expect
        )
        of_shape = columns.OF_SHAPE if of_curves else ()
        of_figure = columns.columns_of(self.figures.finding or "")
        return columns.selected(self.columns, [*judged, *of_shape, *of_figure])

    def asks_for(self, group: str) -> bool:
        """Check whether a group of columns is asked for by its name."""
        return columns.asks_for(self.columns, group)

    def law_texts(self) -> dict[str, str]:
        """Return the files of laws, by the names under which a run keeps copies of them."""
        found: dict[str, str] = {}
        for file in self.plugins:
            stem = f"{LAW_COPIES}/{file.path.stem}"
            others = (f"{stem}_{number}.py" for number in itertools.count(2))
            names = itertools.chain([f"{stem}.py"], others)
            found[next(name for name in names if name not in found)] = file.text
        return found

    def digest(self) -> str:
        """SHA-256 of what determines the numbers: scene, laws, methods, tolerance and sweep, nothing else."""
        swept = {path.removeprefix("scene.") for path in self.sweep}
        numbers = {
            "scene": {path: value for path, value in self.scene.given_values().items() if path not in swept},
            "laws": [[law.label, law.kind, self._fixed(law)] for law in self.laws],
            "methods": [[method.label, method.name, method.parameters] for method in self.methods],
            "tolerance": self.tolerance,
            "sweep": {path: self._swept(path) for path in self.sweep},
            **({"code": self.code} if self.code else {}),
            **({"links": [list(entry) for entry in self.links]} if self.links else {}),
        }
        if FRICTION in self.sweep:
            under = {law.label: law.under_friction(self.sweep[FRICTION]) for law in self.laws}
            numbers["friction"] = [[label, list(map(list, each.values()))] for label, each in under.items()]
        plain = natural(json.loads(json.dumps(natural(numbers))))  # a text with a unit is its number
        return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()

    def _swept(self, path: str) -> Any:
        along = self.ranges.get(path)
        return along.resolved() if isinstance(along, SpeedRange) else list(self.sweep[path])

    def _fixed(self, law: LawChoice) -> dict[str, Any]:
        swept = self.swept_parameters(law)
        return {name: v for name, v in law.parameters.items() if name not in swept}


def _as_written(value: Any) -> Any:
    """Return the value of a key as a study file writes it."""
    if isinstance(value, Record):
        return natural(
            value.resolved() if hasattr(value, "resolved") else value.model_dump(exclude_defaults=True)
        )
    if isinstance(value, Mapping):
        alone = {
            key: each[0] if isinstance(each, tuple) and len(each) == 1 else each
            for key, each in value.items()
        }
        return {key: _as_written(each) for key, each in alone.items()}
    return [_as_written(each) for each in value] if isinstance(value, tuple) else natural(value)


_OBJECTS = {"schema", "scene", "plugins", "laws", "methods"}
_MOST_TYPED = 8
"""Values of a list that are shown."""


def _as_given(named: Mapping[str, tuple[str, Any]]) -> str:
    """One as it is, several as a list, those with a label of their own by it."""
    if any(label != kind for label, (kind, _) in named.items()):
        return repr({label: each for label, (_, each) in named.items()})
    each = [one for _, one in named.values()]
    return repr(each[0] if len(each) == 1 else each)


def _typed(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_typed(item)}' for key, item in value.items())}}}"
    if isinstance(value, list):
        shown = [_typed(item) for item in value]
        return f"[{', '.join([*shown[:2], '...', shown[-1]] if len(shown) > _MOST_TYPED else shown)}]"
    return typed(value)
