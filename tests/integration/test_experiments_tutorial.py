"""docs/experiments.md does what it says: its files are written, its commands run, outputs compared.

A line ``...`` in the page stands for any number of lines.
"""

import io
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
from ncsim_core.cli.main import main

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "experiments.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE_NAME = re.compile(r"# (\S+\.(?:yaml|py))\n")
NCSIM = "from ncsim_core.cli.main import main; main()"
IN_PROCESSES = ("ncsim sweep", "python")
"""What starts processes of its own needs a main module that is not this test's."""


def blocks():
    return BLOCK.findall(PAGE.read_text(encoding="utf-8"))


def commands(block):
    """Yield each command of a console block with the output that follows it."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, _, output = part.partition("\n")
        yield command, output.rstrip("\n")


def carried_out(command, folder):
    if command.startswith(IN_PROCESSES):
        name, *words = command.split()
        program = [sys.executable] if name == "python" else [sys.executable, "-c", NCSIM]
        done = subprocess.run(
            [*program, *words], cwd=folder, capture_output=True, text=True, check=False
        )
        return done.stdout, done.stderr
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit):
        main(command.split()[1:])
    return out.getvalue(), err.getvalue()


def as_pattern(expected):
    lines = [r"(.*\n)*?" if each == "..." else re.escape(each) + "\n" for each in expected]
    return re.compile("".join(lines))


@pytest.mark.slow
def test_files_and_commands_of_the_tutorial_give_what_the_page_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    ran = 0
    for language, text in blocks():
        name = FILE_NAME.match(text)
        if language in ("yaml", "python") and name:
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
        for command, expected in commands(text) if language == "console" else ():
            out, err = carried_out(command, tmp_path)
            found = "".join(f"{line.rstrip()}\n" for line in (out + err).splitlines())
            pattern = as_pattern([line.rstrip() for line in expected.splitlines()])
            assert pattern.fullmatch(found), f"$ {command}\n{found}"
            ran += 1
    assert ran > 10
