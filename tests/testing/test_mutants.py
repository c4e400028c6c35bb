"""What the mutation run changes, and where it finds the code that was changed."""

from __future__ import annotations

import math
from pathlib import Path
from types import FunctionType

from mutants import mutants

from frictionlab.laws import decay

SOURCE = '''
class Law:
    """Not this 1."""

    def nears(self, x: float) -> bool:
        """Nor this 2."""
        if x < 3:
            raise ValueError("nor this " + "or this")
        return abs(x) + 1.0 and self.far


def within(a, b):
    return min(-a, math.pow(a, b)) if a is not None else 0.0
'''


def test_each_mutant_differs_in_one_thing_and_no_words_are_changed(tmp_path: Path) -> None:
    file = tmp_path / "laws" / "law.py"
    file.parent.mkdir()
    file.write_text(SOURCE)

    changes = {(each.function, each.before, each.after) for each in mutants(file)}
    assert changes == {
        ("Law.nears", "x < 3", "x >= 3"),
        ("Law.nears", "3", "4"),
        ("Law.nears", "abs(x) + 1.0 and self.far", "abs(x) + 1.0 or self.far"),
        ("Law.nears", "abs(x) + 1.0 and self.far", "not (abs(x) + 1.0 and self.far)"),
        ("Law.nears", "abs(x) + 1.0", "abs(x) - 1.0"),
        ("Law.nears", "abs(x)", "x"),
        ("Law.nears", "1.0", "1.1"),
        ("within", "min(-a, math.pow(a, b))", "max(-a, math.pow(a, b))"),
        ("within", "-a", "a"),
        ("within", "math.pow(a, b)", "math.pow(b, a)"),
        ("within", "a is not None", "a is None"),
        ("within", "0.0", "1.0"),
    }
    assert str(next(mutants(file))).startswith("laws/law.py:7 Law.nears: ")


def test_the_code_of_a_mutant_takes_the_place_of_the_functions_own() -> None:
    changed = next(each for each in mutants(Path(decay.__file__)) if each.before == "-lengths")
    copy = FunctionType(changed.code, vars(decay))

    assert changed.function == "exp_decay"
    assert decay.exp_decay(1.0) == math.exp(-1.0)
    assert copy(1.0) == math.exp(1.0)
