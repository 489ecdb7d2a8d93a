"""What docs/trust.md promises of the sources themselves, and that the tests it names exist."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = sorted(ROOT.glob("ncsim-*/src/**/*.py"))
WRITERS = {"write_text", "write_bytes", "savefig", "write_table", "to_parquet"}
OWN_FOLDERS = {
    "trace/files.py": "the writer itself",
    "cli/running.py": "into a folder that gets its name when it is whole",
    "server/jobs.py": "into a temporary folder",
    "server/processes.py": "into a temporary folder",
    "ncsim_viz/notebook.py": "into a temporary folder",
    "testing/fixtures.py": "a distribution in a test's folder",
    "testing/runs.py": "into a temporary folder",
    "sweep/drawing.py": "into memory",
}
"""Modules that may write files by themselves, and why nothing half-written has a final name."""


def calls_in(tree):
    return (node for node in ast.walk(tree) if isinstance(node, ast.Call))


def is_written_to(call, places):
    """Return whether a call writes to a file other than one that ``appearing`` has given."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    if name == "open":
        return any(isinstance(each, ast.Constant) and "w" in str(each.value) for each in call.args)
    words = {each.id for each in ast.walk(call) if isinstance(each, ast.Name)}
    return name in WRITERS and not words & places


def places_in(tree):
    """Return the names that ``with appearing(...) as NAME`` binds."""
    items = (item for node in ast.walk(tree) if isinstance(node, ast.With) for item in node.items)
    return {
        item.optional_vars.id
        for item in items
        if isinstance(item.context_expr, ast.Call)
        and getattr(item.context_expr.func, "id", "") == "appearing"
    }


def test_every_file_is_written_by_the_one_writer_that_names_it_when_it_is_whole():
    assert len(SOURCES) > 200
    found = {}
    for path in SOURCES:
        if not str(path).endswith(tuple(OWN_FOLDERS)):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            places = places_in(tree)
            calls = [each for each in calls_in(tree) if is_written_to(each, places)]
            found |= {f"{path.name}:{each.lineno}": ast.unparse(each) for each in calls}

    assert found == {}


def test_every_test_that_the_page_names_exists():
    page = (ROOT / "docs" / "trust.md").read_text(encoding="utf-8")
    folders = [*ROOT.glob("tests"), *ROOT.glob("ncsim-*/tests")]
    files = [path for folder in folders for path in folder.glob("**/test_*.py")]
    named = re.findall(r"`(?:([\w/-]+/)?(test_\w+\.py))(?:::(\w+))?`", page)

    assert len(named) > 10
    for folder, file, function in named:
        meant = [path for path in files if str(path).endswith(f"/{folder}{file}")]
        assert len(meant) == 1, f"{folder}{file}: {meant}"
        source = meant[0].read_text(encoding="utf-8")
        assert not function or f"def {function}(" in source, f"{file}::{function}"
