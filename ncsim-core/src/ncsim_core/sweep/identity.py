"""Which software answers in a run, so precisely that old results are never taken for new ones.

A package counts by its version and those of what it needs. A package installed from a working copy
(editable) changes without a new version; it counts by its files.
"""

import hashlib
import importlib.metadata
import importlib.util
import json
import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path
from typing import Final

CORE: Final = "ncsim-core"
NUMPY: Final = "numpy"
"""The one requirement of ncsim-core that a result can depend on."""

_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


@lru_cache(maxsize=256)
def software(distribution: str, packages: tuple[str, ...]) -> str:
    """Return what identifies a package, as text; looked up once per process.

    Args:
        distribution: Its name for installers, such as ``ncsim-wifi``.
        packages: The top-level packages that its components come from, such as ``ncsim_wifi``.
    """
    try:
        installed = importlib.metadata.distribution(distribution)
    except importlib.metadata.PackageNotFoundError:
        return distribution
    parts = [f"{distribution}=={installed.version}"]
    parts += _needed(distribution, installed.requires or ())
    if _is_working_copy(installed):
        parts += [f"source={_source_digest(package)}" for package in packages]
    return ",".join(parts)


def _needed(distribution: str, requirements: Iterable[str]) -> Iterator[str]:
    """Yield the direct requirements with the versions that are installed."""
    for requirement in sorted(requirements):
        name = _NAME.match(requirement)
        if name is None or "extra ==" in requirement:
            continue
        if name[0] == CORE or (distribution == CORE and name[0] != NUMPY):
            continue
        try:
            yield f"{name[0]}=={importlib.metadata.version(name[0])}"
        except importlib.metadata.PackageNotFoundError:
            yield f"{name[0]}=absent"


def _is_working_copy(installed: importlib.metadata.Distribution) -> bool:
    text = installed.read_text("direct_url.json")
    return bool(text and json.loads(text).get("dir_info", {}).get("editable"))


def _source_digest(package: str) -> str:
    """Return what only equal files of a package have in common; nothing if it cannot be found."""
    found = importlib.util.find_spec(package)
    digest = hashlib.sha256()
    for folder in (found.submodule_search_locations or ()) if found else ():
        for path in sorted(Path(folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(f"{path.relative_to(folder)}\n".encode())
                digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()
