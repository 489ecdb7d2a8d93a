"""The server itself: bound to this machine, one thread per connection, nothing left behind."""

import contextlib
import os
import secrets
import signal
import socket
import threading
from http.server import ThreadingHTTPServer
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from typing_extensions import override

from ncsim_viz.server.child import Limits
from ncsim_viz.server.entries import Entries
from ncsim_viz.server.handler import Handler
from ncsim_viz.server.jobs import Jobs
from ncsim_viz.server.library import Library
from ncsim_viz.server.page import served_page
from ncsim_viz.server.routes import Site

LOOPBACK: Final = "127.0.0.1"
MAX_CONNECTIONS: Final = 64
TOKEN_BYTES: Final = 24
TOO_MANY: Final = (
    b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
)


class ViewerServer(ThreadingHTTPServer):
    """Serves a folder of runs and studies on 127.0.0.1.

    Args:
        root: The folder.
        port: 0 takes a free one.
        limits: What each run may take.

    Raises:
        OSError: The port is taken.
    """

    daemon_threads = True
    block_on_close = False
    request_queue_size = 32

    def __init__(self, root: Path, port: int = 0, limits: Limits | None = None) -> None:
        super().__init__((LOOPBACK, port), Handler)
        self.token = secrets.token_urlsafe(TOKEN_BYTES)
        library = Library(root)
        entries = Entries(library)
        can_run = os.access(library.root, os.W_OK)
        jobs = Jobs(library, entries, limits or Limits()) if can_run else None
        self.site = Site(library, entries, jobs)
        self._is_stopping = threading.Event()
        self._free = threading.BoundedSemaphore(MAX_CONNECTIONS)

    @override
    def __enter__(self) -> Self:
        return self

    @override
    def __exit__(
        self,
        error_type: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def port(self) -> int:
        """Return the port it listens on."""
        return int(self.server_address[1])

    @property
    def url(self) -> str:
        """Return the address to open, with the token."""
        return f"http://{LOOPBACK}:{self.port}/?token={self.token}"

    def page(self) -> str:
        """Return the viewer as it is served."""
        return served_page(self.site.library.title, self.token, can_run=self.site.jobs is not None)

    def rest(self, for_s: float) -> bool:
        """Wait; ``False`` when the server stops."""
        return not self._is_stopping.wait(for_s)

    def close(self) -> None:
        """Stop streams and runs, and let go of the port."""
        self._is_stopping.set()
        self.server_close()
        if self.site.jobs is not None:
            self.site.jobs.close()

    @override
    def process_request(self, request: Any, client_address: Any) -> None:
        if not self._free.acquire(blocking=False):
            with contextlib.suppress(OSError):
                request.sendall(TOO_MANY)
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    @override
    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._free.release()

    @override
    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of connections that break."""


def serve(server: ViewerServer) -> None:
    """Serve until Ctrl-C, a polite signal, or the end of the terminal."""
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.default_int_handler)
    with server, contextlib.suppress(KeyboardInterrupt):
        server.serve_forever(poll_interval=0.2)


def instructions(server: ViewerServer) -> str:
    """Return how to reach the server, from here and from elsewhere."""
    port, host = server.port, socket.gethostname()
    return (
        f"{server.url}\n"
        f"  from elsewhere: ssh -L {port}:{LOOPBACK}:{port} {host}, then open the same address\n"
        "  Ctrl-C stops the server and the runs that it started"
    )
