"""Every block of docs/write-a-plugin.md works, in order, in a fresh environment."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "write-a-plugin.md"
UV = Path(sys.executable).with_name("uv")
BLOCK = re.compile(r"^```(sh|python file=(\S+))\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_every_block_of_the_guide_works(tmp_path):
    if not UV.exists():
        pytest.skip("uv is not installed beside this Python")
    wheels = tmp_path / "wheels"
    subprocess.run(
        [UV, "build", "--quiet", "--wheel", "--out-dir", wheels, ROOT / "ncsim-core"], check=True
    )
    work = tmp_path / "work"
    work.mkdir()
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("NCSIM", "PYTHON"))}
    environment |= {"PIP_FIND_LINKS": str(wheels), "PIP_CONSTRAINT": str(ROOT / "constraints.txt")}
    blocks = BLOCK.findall(GUIDE.read_text(encoding="utf-8"))
    activate = ""
    for kind, file, text in blocks:
        if file:
            (work / file).write_text(text, encoding="utf-8")
            continue
        done = subprocess.run(
            ["bash", "-ec", activate + text],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, f"{kind}:\n{text}\n{done.stdout}\n{done.stderr}"
        activate = ". venv/bin/activate\n"
    assert len(blocks) == 7
