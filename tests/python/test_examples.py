"""Every example of examples/python and of the guides runs."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples" / "python").glob("[0-9]*.py"))


def test_there_are_ten() -> None:
    assert len(EXAMPLES) == 10


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples(example: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    matplotlib.use("Agg")
    monkeypatch.syspath_prepend(str(example.parent))
    runpy.run_path(str(example))["main"](tmp_path)
    pyplot.close("all")
    assert (tmp_path / f"{example.stem}.png").stat().st_size > 5000


def snippets(guide: str) -> str:
    """The blocks of a guide in Python, one after the other."""
    text = (ROOT / "docs" / guide).read_text(encoding="utf-8")
    return "\n".join(re.findall(r"```python\n(.*?)```", text, flags=re.S))


@pytest.mark.parametrize("guide", ["python.md", "cohorts.md"])
def test_guides(guide: str, tmp_path: Path) -> None:
    code = snippets(guide)
    assert code
    (tmp_path / "guide.py").write_text(code, encoding="utf-8")
    done = subprocess.run([sys.executable, "guide.py"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
