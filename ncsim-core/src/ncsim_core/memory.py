"""A limit on memory for a while."""

import contextlib
import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from ncsim_core.errors import ScenarioError

BYTES_PER_MB: Final = 1_000_000
MOST_BYTES: Final = 1 << 62


def is_memory_limited() -> bool:
    """Return whether allocations of this process fail from some size on."""
    try:
        resource = importlib.import_module("resource")
    except ImportError:
        return False
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return bool(limit != resource.RLIM_INFINITY)


@contextlib.contextmanager
def limited_memory(memory_MB: float | None) -> Iterator[None]:
    """Let allocations fail in the block once this process has grown by so much.

    Args:
        memory_MB: What the block may take beyond what is taken already; ``None`` is no limit.

    Raises:
        ScenarioError: This system cannot limit memory.
    """
    if memory_MB is None:
        yield
        return
    try:
        resource = importlib.import_module("resource")
        pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
    except (ImportError, OSError):
        raise ScenarioError("a limit on memory needs Linux") from None
    before = resource.getrlimit(resource.RLIMIT_AS)
    most = min(MOST_BYTES, pages * resource.getpagesize() + round(memory_MB * BYTES_PER_MB))
    resource.setrlimit(resource.RLIMIT_AS, (most, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)
