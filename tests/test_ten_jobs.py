"""The ten jobs of the documentation run as they are pasted, and print what is shown below them."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import matplotlib
import pytest

TEXT = (Path(__file__).parent.parent / "docs" / "ten_jobs.md").read_text()
SCENE = TEXT.partition("```python\n")[2].partition("```")[0]
JOBS = dict(re.findall(r"^## \d+\. (.*?)\n.*?```python\n(.*?)```", TEXT, re.DOTALL | re.MULTILINE))
SHOWN = dict(re.findall(r"^## \d+\. (.*?)\n.*?```text\n(.*?)```", TEXT, re.DOTALL | re.MULTILINE))
LONGEST = 20
"""Lines, those of the scene included."""
EXTRAS = {"Arrays with names": "xarray"}


def test_there_are_ten_each_on_a_screen() -> None:
    assert len(JOBS) == 10
    assert [job for job, code in JOBS.items() if f"{SCENE}{code}".count("\n") > LONGEST] == []
    assert list(SHOWN) == list(JOBS)


@pytest.mark.parametrize("job", JOBS)
def test_a_job_prints_what_is_shown(
    job: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    extra = EXTRAS.get(job)
    if extra is not None and importlib.util.find_spec(extra) is None:
        pytest.skip(f"needs {extra}")
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")

    exec(SCENE + JOBS[job], {"__name__": "__main__"})

    assert capsys.readouterr().out.split() == SHOWN[job].split()
