"""Steps of a trace as server-sent events (WHATWG HTML, section 9.2)."""

import json
import time
from collections.abc import Callable, Iterator
from typing import Final, assert_never

from ncsim_viz.server.tail import End, Idle, Records, Restart, Step

POLL_s: Final = 0.1
HEARTBEAT_s: Final = 10.0
"""A comment now and then tells whether anybody still listens."""


def event_bytes(steps: Iterator[Step], rest: Callable[[float], bool]) -> Iterator[bytes]:
    """Yield what is to be sent.

    Args:
        steps: What happens in the trace.
        rest: Waits that many seconds, and says whether to go on.
    """
    sent_s = time.monotonic()
    yield b"retry: 500\n\n"
    for step in steps:
        data = event_of(step)
        if data is None:
            if not rest(POLL_s):
                return
            if time.monotonic() - sent_s < HEARTBEAT_s:
                continue
            data = b":\n\n"
        yield data
        sent_s = time.monotonic()


def event_of(step: Step) -> bytes | None:
    r"""Return one event; ``None`` if there is nothing to say.

    >>> from ncsim_viz.server.tail import Mark
    >>> event_of(Records(b"one\ntwo\n", Mark(8, 255)))
    b'id: 8-000000ff\ndata: one\ndata: two\n\n'
    """
    match step:
        case Records(lines, after):
            data = lines[:-1].replace(b"\n", b"\ndata: ")
            return b"id: " + str(after).encode() + b"\ndata: " + data + b"\n\n"
        case Restart():
            return b"id: 0-00000000\nevent: restart\ndata: {}\n\n"
        case End(status):
            return b"event: end\ndata: " + json.dumps({"status": status}).encode() + b"\n\n"
        case Idle():
            return None
        case _:
            assert_never(step)
