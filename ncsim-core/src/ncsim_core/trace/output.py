"""The folder of a run: it appears whole, or not at all."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from ncsim_core.errors import ScenarioError
from ncsim_core.trace.files import TRACE_NAMES, temporary_sibling

SCENARIO_NAME: Final = "scenario.yaml"
METRICS_NAME: Final = "metrics.json"
RUN_NAME: Final = "run.json"
RUN_FILE_NAMES: Final = frozenset({SCENARIO_NAME, METRICS_NAME, RUN_NAME, *TRACE_NAMES})


@contextmanager
def atomic_output_folder(path: Path, *, force: bool = False) -> Iterator[Path]:
    """Yield a temporary folder beside ``path`` that takes its name when the block ends well.

    If the block raises, the temporary folder goes; if the process is killed, a hidden
    ``.NAME.partial-*`` stays, never a half-written ``path``.

    Args:
        path: The folder to make; its parents are made too.
        force: Replace an earlier run. Files that no run wrote are never deleted.

    Raises:
        ScenarioError: ``path`` exists and may not be replaced, or cannot be made.
    """
    path = Path(path)
    refuse_existing(path, force=force)
    folder = temporary_sibling(path.absolute())
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise _fault(path, error) from error
    try:
        yield folder
        _replace(path, folder, force=force)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def refuse_existing(path: Path, *, force: bool) -> None:
    """Raise unless ``path`` is free, or holds an earlier run and ``force`` is given.

    Raises:
        ScenarioError: It is taken.
    """
    if not path.exists() and not path.is_symlink():
        return
    if not force:
        raise ScenarioError(f"{path}: exists already; choose another name or give --force")
    if path.is_symlink() or not path.is_dir():
        raise ScenarioError(f"{path}: is no folder, so --force does not replace it")
    foreign = sorted(each.name for each in path.iterdir() if each.name not in RUN_FILE_NAMES)
    if foreign:
        raise ScenarioError(
            f"{path}: holds what no run wrote ({', '.join(foreign[:5])}), so --force does not "
            "replace it; choose another name"
        )


def _replace(path: Path, folder: Path, *, force: bool) -> None:
    """Give ``folder`` the name ``path``; what was there goes only once that has worked."""
    refuse_existing(path, force=force)
    old = temporary_sibling(path.absolute())
    try:
        if path.exists():
            path.rename(old)
        folder.rename(path)
    except OSError as error:
        if old.exists():
            old.rename(path)
        raise _fault(path, error) from error
    shutil.rmtree(old, ignore_errors=True)


def _fault(path: Path, error: OSError) -> ScenarioError:
    return ScenarioError(f"{path}: cannot be written: {error.strerror or error}")
