"""The drawing of the package's rooms, made from its imports: python tests/architecture.py.

Writes docs/figures/architecture.svg. Left, every folder (and file beside the folders) on its floor, above all it
imports; right, the same inside ``methods``. A line leads from a room down to one it imports; what follows from other
lines is left out.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from structure import arrows, floors, tree_of

PROJECT = Path(__file__).parents[1]
PICTURE = PROJECT / "docs" / "figures" / "architecture.svg"
WIDE, HIGH, STEP_X, STEP_Y, MARGIN = 92, 26, 104, 62, 24
STYLE = (
    "text{font:13px sans-serif;text-anchor:middle;fill:#1a1a1a}.title{font-weight:bold}"
    "rect{fill:#eef3f8;stroke:#4a6785;rx:4px}line{stroke:#7d8fa3;stroke-width:1.1}"
)


def reduced(drawn: dict[str, set[str]]) -> dict[str, set[str]]:
    """The arrows that do not follow from others."""
    reach: dict[str, set[str]] = {}

    def below(name: str) -> set[str]:
        if name not in reach:
            reach[name] = set(drawn.get(name, ())).union(*(below(other) for other in drawn.get(name, ())))
        return reach[name]

    return {
        name: {one for one in direct if not any(one in below(other) for other in direct)}
        for name, direct in drawn.items()
    }


def places(drawn: dict[str, set[str]]) -> dict[str, tuple[float, int]]:
    """The place of each room: across, in units of a column, and its floor; near the rooms it imports."""
    height = floors(drawn)
    rows: dict[int, list[str]] = defaultdict(list)
    for name in sorted(height):
        rows[height[name]].append(name)
    widest = max(map(len, rows.values()))
    at: dict[str, tuple[float, int]] = {}
    for floor in sorted(rows):

        def pull(name: str) -> float:
            below = [at[other][0] for other in drawn.get(name, ()) if other in at]
            return sum(below) / len(below) if below else 0.0

        row = sorted(rows[floor], key=lambda name: (pull(name), name))
        gap = widest / len(row)
        for k, name in enumerate(row):
            at[name] = ((k + 0.5) * gap - 0.5, floor)
    return at


def panel(title: str, drawn: dict[str, set[str]], left: float, top: int) -> tuple[list[str], float]:
    """The elements of one drawing whose highest floor is ``top``, and how wide it is."""
    at = places(drawn)
    across = {name: left + MARGIN + WIDE / 2 + STEP_X * x for name, (x, _floor) in at.items()}
    down = {name: MARGIN + 40 + STEP_Y * (top - floor) for name, (_x, floor) in at.items()}
    width = max(across.values()) + WIDE / 2 + MARGIN - left
    lines = [
        f'<line x1="{across[name]:.1f}" y1="{down[name] + HIGH / 2:.1f}" '
        f'x2="{across[other]:.1f}" y2="{down[other] - HIGH / 2:.1f}"/>'
        for name, below in sorted(reduced(drawn).items())
        for other in sorted(below)
    ]
    boxes = [
        f'<rect x="{across[name] - WIDE / 2:.1f}" y="{down[name] - HIGH / 2:.1f}" width="{WIDE}" height="{HIGH}"/>'
        f'<text x="{across[name]:.1f}" y="{down[name] + 4.5:.1f}">{name}</text>'
        for name in sorted(at)
    ]
    heading = f'<text class="title" x="{left + width / 2:.1f}" y="{MARGIN}">{title}</text>'
    return [heading, *lines, *boxes], width


def picture() -> str:
    """The drawing as SVG."""
    tree = tree_of(PROJECT)
    whole, methods = arrows(tree), arrows(tree, "methods")
    methods.pop("methods", None)
    top = max(floors(whole).values())
    first, width = panel("rooms of the package", whole, 0.0, top)
    second, more = panel("inside methods", methods, width, max(floors(methods).values()))
    wide, high = width + more, MARGIN + 40 + STEP_Y * top + HIGH + MARGIN
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide:.0f} {high:.0f}" width="{wide:.0f}">'
    ground = f'<rect x="0" y="0" width="{wide:.0f}" height="{high:.0f}" style="fill:#ffffff;stroke:none"/>'
    return "\n".join([head, f"<style>{STYLE}</style>", ground, *first, *second, "</svg>\n"])


if __name__ == "__main__":
    PICTURE.write_text(picture())
