"""``make paper``: every printed row of the workflow evaluation."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "examples" / "paper" / "reproduce.py"


@pytest.mark.slow
def test_every_printed_row_comes_out_equal(tmp_path):
    done = subprocess.run(
        [sys.executable, str(SCRIPT)], cwd=tmp_path, capture_output=True, text=True, check=False
    )

    assert done.returncode == 0, done.stdout + done.stderr
    assert "51 of 51 rows equal" in done.stdout
    assert "DIFFERS" not in done.stdout


@pytest.mark.slow
def test_a_row_that_differs_is_told_and_fails(tmp_path):
    folder = tmp_path / "paper"
    folder.mkdir()
    for path in SCRIPT.parent.glob("*.yaml"):
        text = path.read_text(encoding="utf-8")
        (folder / path.name).write_text(text.replace('"57.36"', '"57.37"'), encoding="utf-8")
    (folder / "reproduce.py").write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "paper/reproduce.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 1
    assert "57.36 49.83 Min-hop  DIFFERS, printed: 57.37 49.83 Min-hop" in done.stdout
