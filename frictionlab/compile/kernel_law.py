"""A law as machine code sees it: a record of its numbers, and a class whose methods they lead to."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.dispatch import KnownLaw
from frictionlab.laws.base import FrictionLaw


class KernelLaw(NamedTuple):
    """A law, the class of its methods and their structure, its numbers; held: what the addresses among them need."""

    law: FrictionLaw
    kind: KnownLaw
    numbers: dict[str, Any]
    held: tuple[Any, ...] = ()


def by_itself(law: FrictionLaw) -> KernelLaw:
    """The law with its own methods: a kernel is compiled for it alone."""
    return KernelLaw(law, KnownLaw(type(law), law.structure()), dict(law.numbers()))
