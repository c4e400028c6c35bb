"""Pins today's numbers: python tests/reference/make_golden.py [--only PATTERN] [--out FOLDER].

Solves every group of golden_scenes.py and writes golden.csv and golden_curves.csv beside itself,
or into FOLDER. With --only, groups whose name matches PATTERN (of fnmatch) are solved anew and the other rows kept.
Make the tables anew only for a change of behaviour that is meant; one of the path of computation alone is listed in
golden_changes.csv (see tests/golden).
"""

from __future__ import annotations

import argparse
import sys
import time
from fnmatch import fnmatchcase
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2]))

import golden_files
import golden_scenes

import conftest  # noqa: F401  # opens the folders of plugins/

HERE = Path(__file__).parent


def main(only: str, out: Path) -> None:
    """Solve and write."""
    results, curves = (
        golden_files.read(path) if path.exists() and only != "*" else {}
        for path in (golden_files.RESULTS, golden_files.CURVES)
    )
    for group in golden_scenes.GROUPS:
        if not fnmatchcase(group.name, only):
            continue
        start = time.perf_counter()
        found, along = golden_scenes.solved(group.name)
        results = {key: row for key, row in results.items() if key.split("/")[0] != group.name} | found
        curves = {key: row for key, row in curves.items() if key.split("/")[0] != group.name} | along
        print(f"{time.perf_counter() - start:7.2f} s, {len(found):3d} rows: {group.name}", flush=True)
    order = {group.name: place for place, group in enumerate(golden_scenes.GROUPS)}
    for name, rows in (("golden.csv", results), ("golden_curves.csv", curves)):
        kept = {key: row for key, row in rows.items() if key.split("/")[0] in order}
        golden_files.write(
            out / name, dict(sorted(kept.items(), key=lambda row: order[row[0].split("/")[0]]))
        )
    print(f"{len(results)} rows, {len(curves)} curves")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default="*")
    parser.add_argument("--out", type=Path, default=HERE)
    given = parser.parse_args()
    main(given.only, given.out)
