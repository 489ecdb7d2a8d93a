"""A process with limits: ``python -m ncsim_viz.server.child LIMITS PARENT ENTRY ...``.

``PARENT`` is the id of the process that asks, ``ENTRY`` is ``package.module:function``, called
without arguments; what follows becomes ``sys.argv``. The limits are set here, in the child, for the
server has threads and must not fork with work to do in between.
"""

import ctypes
import importlib
import json
import os
import signal
import sys
from dataclasses import asdict, dataclass
from typing import Final

MEGABYTE: Final = 1_000_000
_PR_SET_PDEATHSIG: Final = 1  # include/uapi/linux/prctl.h


@dataclass(frozen=True)
class Limits:
    """What a process may take.

    Args:
        wall_s: Time on the clock.
        memory_MB: Address space.
        output_MB: Each file that it writes.
    """

    wall_s: float = 3600.0
    memory_MB: int = 4000
    output_MB: int = 4000


def command(limits: Limits, entry: str, *arguments: str) -> list[str]:
    """Return the command line of a process with limits."""
    own = json.dumps(asdict(limits))
    module = ["-m", "ncsim_viz.server.child"]
    return [sys.executable, *module, own, str(os.getpid()), entry, *arguments]


def main() -> None:
    """Set limits, then do what the command line says."""
    _, limits, parent, entry, *arguments = sys.argv
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have had it ignored
    _restrict(Limits(**json.loads(limits)))
    _leave_with(int(parent))
    module, _, name = entry.partition(":")
    sys.argv = ["ncsim", *arguments]
    getattr(importlib.import_module(module), name)()


def _restrict(limits: Limits) -> None:
    if sys.platform == "win32":
        return  # has no such limits; the time is watched by the server
    import resource

    memory, output = limits.memory_MB * MEGABYTE, limits.output_MB * MEGABYTE
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    resource.setrlimit(resource.RLIMIT_FSIZE, (output, output))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _leave_with(parent: int) -> None:
    """Ask Linux to end this process when the server is killed without warning."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # it was killed before we asked
            sys.exit(1)


if __name__ == "__main__":
    main()
