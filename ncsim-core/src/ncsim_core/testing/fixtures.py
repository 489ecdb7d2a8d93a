"""Pretends that a distribution is installed, without pip.

Import the fixture into a ``conftest.py`` or test module: ``from ncsim_core.testing.fixtures import
fake_dist``. There is no pytest plug-in in ncsim-core, so nothing happens unasked.
"""

import importlib
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from textwrap import dedent
from typing import Protocol

import pytest

from ncsim_core.plugins import PLUGIN_GROUP
from ncsim_core.registry import get_registry

DECLARATION = """
from ncsim_core.plugins import Component, Section, hookimpl

NCSIM_PLUGIN_API = "1.0"

"""
"""Top of a declaration module, for the modules of ``fake_dist``."""


class FakeDist(Protocol):
    """What the fixture ``fake_dist`` gives."""

    def __call__(
        self,
        name: str,
        modules: Mapping[str, str],
        *,
        version: str = "1.0",
        entry_points: Mapping[str, str] | None = None,
    ) -> Path:
        """Put a distribution on ``sys.path`` and return its folder.

        Args:
            name: Name of the distribution.
            modules: Source by file path, such as ``{"my_plugin/declaration.py": "..."}``; it is
                dedented. A path without suffix is a module: ``.py`` is added.
            version: Version of the distribution.
            entry_points: Entry points in group ``ncsim.plugins``; by default one to the
                first module.
        """


@pytest.fixture
def fake_dist(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeDist]:
    """Return a function that installs a pretended distribution until the test ends."""
    before = set(sys.modules)

    def install(
        name: str,
        modules: Mapping[str, str],
        *,
        version: str = "1.0",
        entry_points: Mapping[str, str] | None = None,
    ) -> Path:
        folder = tmp_path / f"site_{name}"
        write_dist(folder, name, modules, version=version, entry_points=entry_points)
        monkeypatch.syspath_prepend(folder)
        importlib.invalidate_caches()
        get_registry.cache_clear()
        return folder

    get_registry.cache_clear()
    yield install
    get_registry.cache_clear()
    for module in set(sys.modules) - before:
        if str(tmp_path) in str(getattr(sys.modules[module], "__file__", "")):
            del sys.modules[module]


def write_dist(
    folder: Path,
    name: str,
    modules: Mapping[str, str],
    *,
    version: str = "1.0",
    entry_points: Mapping[str, str] | None = None,
) -> None:
    """Write modules and a ``*.dist-info`` that ``importlib.metadata`` takes for installed."""
    for path, source in modules.items():
        file = folder / (path if Path(path).suffix else f"{path}.py")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dedent(source), "utf-8")
    first = next(iter(modules), "missing").removesuffix(".py").replace("/", ".")
    points = {name: first} if entry_points is None else entry_points
    info = folder / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [f"{key} = {value}" for key, value in points.items()]
    (info / "entry_points.txt").write_text("\n".join([f"[{PLUGIN_GROUP}]", *lines, ""]))
