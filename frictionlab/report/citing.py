"""What to cite for a run, as BibTeX: the publications behind it, each with what used it, and frictionlab itself."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from frictionlab.bibliography import Reference
from frictionlab.report.sources import sources
from frictionlab.saved import Saved


def bibtex(runs: Sequence[Saved]) -> str:
    """One entry for each publication, under a comment that says what used it; keys differ."""
    users: dict[Reference, list[str]] = {}
    for run in runs:
        users.setdefault(itself(str(run.account.get("frictionlab", ""))), ["the program"])
        for cited in sources(run):
            for reference in cited.references:
                users.setdefault(reference, []).append(cited.what)
    whom = [", ".join(dict.fromkeys(each)) for each in users.values()]
    entries = zip(whom, with_keys_of_their_own(users), strict=True)
    return "\n\n".join(f"% {who}\n{entry}" for who, entry in entries)


def itself(version: str) -> Reference:
    """The entry of frictionlab. version: that which made the numbers."""
    fields = {
        "author": "{The frictionlab authors}",
        "title": "frictionlab: average-friction curves of vibrated sliding bodies",
        "note": f"Python package, version {version}",
    }
    lines = "".join(f"  {name} = {{{value}}},\n" for name, value in fields.items())
    return Reference("misc", "frictionlab", fields, f"@misc{{frictionlab,\n{lines}}}")


def with_keys_of_their_own(references: Iterable[Reference]) -> list[str]:
    """The entries as written, but for a key that another entry has already: it gets a number."""
    entries, taken = [], set[str]()
    for each in references:
        key, number = each.key, 1
        while key in taken:
            number += 1
            key = f"{each.key}-{number}"
        taken.add(key)
        kind, brace, rest = each.bibtex.partition("{")
        entries.append(kind + brace + rest.replace(each.key, key, 1))
    return entries
