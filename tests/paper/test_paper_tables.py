"""``make paper``: every printed row and figure of the workflow evaluation."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "examples" / "paper" / "reproduce.py"
FIGURES = ("regret", "payload", "concurrent", "route_load")


def reproduced(script, folder):
    return subprocess.run(
        [sys.executable, str(script)], cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.mark.slow
def test_every_printed_row_and_figure_comes_out_and_a_difference_is_told(tmp_path):
    done = reproduced(SCRIPT, tmp_path)

    assert done.returncode == 0, done.stdout + done.stderr
    assert "53 of 53 rows equal" in done.stdout
    assert "DIFFERS" not in done.stdout
    out = tmp_path / "out" / "paper"
    matrix = (out / "tables" / "winner_matrix.tex").read_text(encoding="utf-8")
    assert r"4x4 5T & 1.52 & 1.52 & 1.00 & H/C & 1.00 & 1.00 & 3.23 & H/C \\" in matrix
    assert matrix.count(r" \\") == 10
    assert (out / "tables" / "routing.md").read_text(encoding="utf-8").count("\n") == 13
    for name in FIGURES:
        assert (out / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF")
        assert (out / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")

    shutil.copytree(SCRIPT.parent, tmp_path / "paper")
    expected = tmp_path / "paper" / "expected.yaml"
    expected.write_text(expected.read_text().replace('"57.36"', '"57.37"'), encoding="utf-8")
    done = reproduced(tmp_path / "paper" / "reproduce.py", tmp_path)  # its studies are reused

    assert done.returncode == 1
    assert "57.36 49.83 Min-hop  DIFFERS, printed: 57.37 49.83 Min-hop" in done.stdout
    assert "52 of 53 rows equal" in done.stdout
