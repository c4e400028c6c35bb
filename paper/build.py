"""Make build/paper.pdf from paper.md: ``pip install pypandoc_binary typst``, then ``python paper/build.py``."""

from __future__ import annotations

import os
from pathlib import Path

import pypandoc
import typst

HERE = Path(__file__).parent
BUILT = HERE.parent / "build"


def main() -> None:
    """The paper as Typst writes it, its figures and bibliography those of the repository."""
    BUILT.mkdir(exist_ok=True)
    os.chdir(HERE)
    source = BUILT / "paper.typ"
    pypandoc.convert_file(
        "paper.md", "typst", outputfile=str(source), extra_args=["--standalone", "--citeproc"]
    )
    text = source.read_text(encoding="utf-8").replace("../docs/", "/docs/")
    source.write_text(text, encoding="utf-8")
    typst.compile(str(source), output=str(BUILT / "paper.pdf"), root=str(HERE.parent))


if __name__ == "__main__":
    main()
