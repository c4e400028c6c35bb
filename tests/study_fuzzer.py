"""Studies as nobody would write them: sound ones, changed at random in their values, their keys or their text."""

from __future__ import annotations

import copy
import random
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from frictionlab.study.load import load_study, parse_study, read_back
from frictionlab.study.study import Study
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError
from frictionlab.values.printable import printable

LONGEST = 10.0
"""Time [s] of one processor that one study may take."""
WORDS = re.split(" ", " kind mu start stop num spacing log coulomb dahl scene.belt_speed yes ~")
ODD = (
    *"\x00\x7f\x85\u2028\u202e\ufeff\U0001f600é\\\t\n\r'\"#{[|>%@",
    *("\x1b[31m", "? ", "- ", "&a", "*a", "<<", "!!python/object"),
)
NUMBERS = (
    *(0, -0.0, 1, -1, 2, 7.5, 1e-300, 5e-324, 1e300, 1.7976931348623157e308, float("nan"), float("inf")),
    *(10**6, 10**6 + 1, 10**20, 10**400, 0.1, 1 / 3, True, False, 2**53 + 1, -(10**9)),
)
SI = {
    "mass_kg": 2.0,
    "stiffness_N_per_m": 8e5,
    "damping_N_s_per_m": 120,
    "length_m": 1e-3,
    "gravity_m_per_s2": 9.81,
    "belt_speed_m_per_s": 0.1,
    "drive": {"unbalance_kg_m": 1e-3, "frequency_rad_per_s": 400},
}


def sound(draw: random.Random) -> dict[str, Any]:
    """A study without a mistake, or nearly so."""
    size = draw.choice(["unbalance", "amplitude"])
    scene: dict[str, Any] = {
        "damping_ratio": draw.choice([0, 0.1, 1.5]),
        "normal_load": positive(draw),
        "belt_speed": draw.uniform(-20, 20),
        "drive": {size: positive(draw), "frequency": positive(draw), "phase": draw.choice([0, 30, -400])},
    }
    if draw.random() < 0.4:
        scene["transverse"] = {"natural_frequency": positive(draw), "damping_ratio": 0.1, "load": {size: 1}}
    if draw.random() < 0.2:
        scene = {"belt_speed": 1, "slip": {"velocity_amplitude": 2, "frequency": positive(draw)}}
    if draw.random() < 0.15:
        scene = {"dimensional": copy.deepcopy(SI)}
    kinds = draw.sample(["coulomb", "stribeck", "dahl"], draw.randint(1, 3))
    law = {
        "coulomb": {"mu": positive(draw)},
        "stribeck": {"mu_static": 0.6, "mu_kinetic": 0.3, "stribeck_speed": positive(draw)},
        "dahl": {"mu": 0.4, "presliding_length": positive(draw)},
    }
    tree = {
        "schema": 1,
        "title": text(draw),
        "scene": scene,
        "laws": [{"kind": kind, **law[kind]} for kind in kinds],
        "methods": draw.sample(
            ["auto", "exact", "shooting", {"kind": "march", "label": "m"}], draw.randint(1, 4)
        ),
        "tolerance": draw.choice([1e-12, 1e-6, 0.1]),
        "sweep": {},
        "expect": [{"where": {"law": kinds[0]}, "column": "error", "below": 1, "because": text(draw)}],
        "keep": {"orbit": draw.choice([2, 100])},
    }
    if "damping_ratio" in scene:
        tree["sweep"] = {"scene.belt_speed": swept(draw), f"laws.{kinds[0]}.mu": swept(draw)}
        if kinds[0] == "stribeck":
            del tree["sweep"]["laws.stribeck.mu"]
    return {
        key: value for key, value in tree.items() if key in ("schema", "scene", "laws") or draw.random() < 0.8
    }


def positive(draw: random.Random) -> float:
    return draw.choice([1, 10, 0.25, 10.0 ** draw.uniform(-12, 12), draw.uniform(0.1, 100)])


def swept(draw: random.Random) -> Any:
    number = draw.choice([2, 3, *[10] * 30, 1000, 30_000, draw.choice([999, 1_000_000])])
    if draw.random() < 0.5:
        return sorted({draw.uniform(0.1, 9) for _ in range(min(number, 12))})
    start = draw.uniform(0.01, 5)
    spacing = {"spacing": draw.choice(["linear", "log"])} if draw.random() < 0.5 else {}
    return {"start": start, "stop": start * draw.uniform(1.0, 9), "num": number, **spacing}


def text(draw: random.Random) -> str:
    """Words and whatever else text may hold."""
    parts = [draw.choice([draw.choice(ODD), draw.choice(WORDS), chr(draw.randrange(0xD800)), " ", "a"])
             for _ in range(draw.randrange(6))]  # fmt: skip
    return "".join(parts) * (5000 if draw.random() < 0.02 else 1)


def junk(draw: random.Random, depth: int = 0) -> Any:
    """Any value at all."""
    kinds: list[Callable[[], Any]] = [
        lambda: draw.choice(NUMBERS),
        lambda: text(draw),
        lambda: None,
        lambda: draw.uniform(-1e3, 1e3),
        lambda: [junk(draw, depth + 1) for _ in range(draw.randrange(4))],
        lambda: {draw.choice(WORDS) or text(draw): junk(draw, depth + 1) for _ in range(draw.randrange(4))},
        lambda: [draw.choice(NUMBERS)] * draw.choice([3, 2000]),
        lambda: _nested(draw.choice([5, 30, 400])),
    ]
    return draw.choice(kinds[:4] if depth > 3 else kinds)()


def _nested(depth: int) -> Any:
    value: Any = 1
    for level in range(depth):
        value = [value] if level % 2 else {"a": value}
    return value


def places(tree: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Every path of nested values, but for the deepest."""
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    inner = inner if len(path) < 12 else ()
    return [path] + [found for key, item in inner for found in places(item, (*path, key))]


def changed(draw: random.Random, tree: dict[str, Any]) -> dict[str, Any]:
    """The study with a few of its values replaced, removed, copied or added."""
    for _ in range(draw.choice([1, 1, 1, 2, 3, 8])):
        path = draw.choice(places(tree)[1:] or [()])
        at: Any = tree
        for step in path[:-1]:
            at = at[step]
        if path:
            _change(draw, at, path[-1])
    return tree


def _change(draw: random.Random, at: Any, key: Any) -> None:
    deed = draw.randrange(5)
    if deed == 0:
        del at[key]
    elif deed == 1 and isinstance(at, dict):
        at[text(draw) or "x"] = at[key]
    elif deed == 2 and isinstance(at, dict):
        at[str(key)[:-1] + draw.choice("abc")] = at.pop(key)
    elif deed == 3 and isinstance(at[key], int | float) and not isinstance(at[key], bool):
        at[key] = draw.choice([-at[key], -1e-9, str(at[key]), [at[key]], *NUMBERS])
    else:
        at[key] = junk(draw)


def broken(draw: random.Random, written: str) -> bytes:
    """The text of a study with letters lost, doubled, moved or put in."""
    for _ in range(draw.choice([1, 1, 2, 5])):
        at, length = draw.randrange(len(written) + 1), draw.choice([1, 2, 10, 100])
        put = draw.choice(
            [draw.choice(ODD), draw.choice(WORDS), written[:length], "\n", ": ", "  ", ", " * length]
        )
        put *= draw.choice([1, 1, 1, 1, 300])
        written = written[:at] + put + written[at + draw.choice([0, 0, 1, length]) :]
    whole = written.encode("utf-8", "surrogatepass")
    at = draw.randrange(len(whole) + 1)
    return whole[:at] + bytes(draw.randrange(256) for _ in range(draw.choice([0, 0, 0, 1, 3]))) + whole[at:]


def fuzzed(draw: random.Random, file: Path) -> Study:
    """One study, from a mapping or a file. Raises StudyError, and whatever else it finds."""
    tree = sound(draw)
    way = draw.choice(["sound", "sound", "sound", "mapping", "mapping", "yaml", "text", "override"])
    if way == "sound":
        return parse_study(tree)
    if way == "mapping":
        return parse_study(changed(draw, tree))
    if way == "override":
        return parse_study(
            tree, [draw.choice(["scene.", "sweep.", "laws.", ""]) + text(draw) + "=" + text(draw)]
        )
    try:
        written = yaml_text(changed(draw, tree) if way == "yaml" else tree)
    except (TypeError, ValueError, RecursionError):  # what no YAML can hold
        return parse_study(tree)
    file.write_bytes(broken(draw, written) if way == "text" else written.encode("utf-8", "surrogatepass"))
    return load_study(file)


def complaint(seed: int, folder: Path) -> str:
    """What is wrong with how the study of this seed was answered: '' where nothing is, ``refused`` where it was."""
    file, before = folder / "study.yaml", time.process_time()
    try:
        study = fuzzed(random.Random(seed), file)
        wrong = _of_accepted(study, folder)
    except StudyError as problem:
        said = str(problem)
        wrong = "refused" if said and printable(said) == said else f"not printable: {said!a}"
    except Exception as problem:  # any other is what is looked for
        wrong = f"{type(problem).__name__}: {str(problem)[:200]!a}"
    taken = time.process_time() - before
    return f"took {taken:.1f} s" if taken > LONGEST else wrong


def _of_accepted(study: Study, folder: Path) -> str:
    """Whether a study is the same when it was saved and read again."""
    saved = folder / "saved.yaml"
    saved.write_text(yaml_text(study.resolved()), encoding="utf-8", newline="")
    again = read_back(saved, {})
    if again != study or again.resolved() != study.resolved():
        return "is another study when saved and read again"
    few = sum(map(len, study.sweep.values())) < 20_000
    return "has another digest when saved and read again" if few and again.digest() != study.digest() else ""
