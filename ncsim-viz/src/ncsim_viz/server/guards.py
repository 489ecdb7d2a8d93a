"""Who may ask, and what a page may do: hosts, tokens, response headers, paths."""

import base64
import hashlib
import hmac
import re
from pathlib import Path
from typing import Final

from ncsim_viz.server.errors import missing

LOCAL_NAMES: Final = frozenset({"127.0.0.1", "localhost", "[::1]"})

COMMON_HEADERS: Final = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
DATA_POLICY: Final = "default-src 'none'; frame-ancestors 'none'; sandbox"
"""For everything that is no page."""

MAX_ID: Final = 1000
MAX_NAME_BYTES: Final = 255

_INLINE_SCRIPT = re.compile(r'<script type="module">(.*?)</script>', re.DOTALL)


def is_local_host(header: str | None) -> bool:
    """Return whether a ``Host`` header names this machine.

    Any port will do, as a tunnel may end at another one. A name of somebody else's that resolves
    to 127.0.0.1 (DNS rebinding) is refused.

    >>> is_local_host("localhost:8000"), is_local_host("evil.example:8000"), is_local_host(None)
    (True, False, False)
    """
    name, _, port = (header or "").rpartition(":")
    if not name or header in LOCAL_NAMES:
        return header in LOCAL_NAMES
    return name.lower() in LOCAL_NAMES and port.isdecimal()


def is_token(given: str, token: str) -> bool:
    """Return whether a token is the right one, in a time that tells nothing."""
    return hmac.compare_digest(given.encode(), token.encode())


def page_policy(page: str) -> str:
    """Return the Content-Security-Policy of a page: its own script and server only."""
    digests = [
        base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        for script in _INLINE_SCRIPT.findall(page)
    ]
    scripts = " ".join(f"'sha256-{digest}'" for digest in digests) or "'none'"
    return (
        f"default-src 'none'; script-src {scripts}; worker-src blob:; style-src 'unsafe-inline'; "
        "img-src data: blob:; connect-src 'self' data: blob:; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'"
    )


def path_below(root: Path, identity: str) -> Path:
    """Return the path that an id names below ``root``; it need not exist.

    Raises:
        RequestError: It is hidden, leads out of ``root``, or is no id at all.
    """
    if identity == ".":
        return root
    steps = identity.split("/")
    if len(identity) <= MAX_ID and all(map(_is_visible_name, steps)):
        path = root.joinpath(*steps)
        if is_inside(path, root):
            return path
    raise missing(repr(identity[:MAX_ID]))


def _is_visible_name(step: str) -> bool:
    is_short = 0 < len(step.encode(errors="replace")) <= MAX_NAME_BYTES
    return is_short and not step.startswith(".") and "\0" not in step and "\\" not in step


def is_inside(path: Path, root: Path) -> bool:
    """Return whether a path, all links followed, lies below ``root``, itself free of links."""
    try:
        return path.resolve().is_relative_to(root)
    except (OSError, RuntimeError, ValueError):  # a loop of links, a name too long
        return False
