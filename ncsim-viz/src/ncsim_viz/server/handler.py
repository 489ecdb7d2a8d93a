"""One connection: who asks, what for, and the answer in HTTP."""

import json
import os
import socket
import sys
import time
import traceback
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from typing import TYPE_CHECKING, Any, Final, cast
from urllib.parse import urlsplit

from ncsim_core.errors import NcsimError
from typing_extensions import override

from ncsim_viz.server import routes
from ncsim_viz.server.errors import RequestError, bad, missing
from ncsim_viz.server.guards import (
    COMMON_HEADERS,
    DATA_POLICY,
    is_local_host,
    is_token,
    page_policy,
)
from ncsim_viz.server.stream import event_bytes
from ncsim_viz.server.tail import START, Mark, follow
from ncsim_viz.server.tracing import source_of

if TYPE_CHECKING:
    from ncsim_viz.server.serving import ViewerServer

MAX_BODY_BYTES: Final = 8_000_000
BODY_WITHIN_s: Final = 30.0
COPY_BYTES: Final = 256 * 1024
TOKEN_HEADER: Final = "X-Ncsim-Token"
JSON: Final = "application/json"


class Handler(BaseHTTPRequestHandler):
    """Answers the requests of one connection."""

    protocol_version = "HTTP/1.1"
    server_version = "ncsim-view"
    sys_version = ""
    timeout = 15.0
    """Seconds that a client may be silent, or not take what is sent to it."""

    @property
    def _viewer(self) -> "ViewerServer":
        return cast("ViewerServer", self.server)

    def do_GET(self) -> None:
        """Answer a request to read."""
        self._guarded(self._get)

    def do_POST(self) -> None:
        """Answer a request to do something."""
        self._guarded(self._post)

    @override
    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: addresses hold the token."""

    def _guarded(self, answer: Callable[[], None]) -> None:
        """Answer, turning whatever goes wrong into a status and a sentence."""
        self._body_is_read = self.command == "GET"
        try:
            self._expect_local_name()
            answer()
        except RequestError as error:
            self._send_error(error.status, str(error), error.more)
        except NcsimError as error:
            self._send_error(HTTPStatus.BAD_REQUEST, str(error), {})
        except (ConnectionError, TimeoutError):
            self.close_connection = True
        except Exception as error:  # one request must not end the server
            if os.environ.get("NCSIM_DEBUG"):
                traceback.print_exception(error, file=sys.stderr)
            message = f"internal error: {type(error).__name__}: {error}"
            self._send_error(HTTPStatus.INTERNAL_SERVER_ERROR, message, {})

    def _get(self) -> None:
        address = urlsplit(self.path)
        query = routes.query_of(address.query)
        self._expect_token(query.get("token", [""])[0])
        if address.path == "/":
            self._send_page()
        elif address.path == "/api/trace":
            self._send_trace(routes.one(query, "run"))
        elif address.path == "/api/stream":
            self._send_stream(routes.one(query, "run"), query.get("from", [""])[0])
        elif address.path in routes.GET:
            self._send_json(routes.GET[address.path](self._viewer.site, query))
        else:
            raise missing(address.path)

    def _post(self) -> None:
        self._expect_token("")
        path = urlsplit(self.path).path
        if path not in routes.POST:
            raise missing(path)
        self._send_json(routes.POST[path](self._viewer.site, self._body()))

    def _expect_local_name(self) -> None:
        if not is_local_host(self.headers.get("Host")):
            raise RequestError(HTTPStatus.FORBIDDEN, "this server answers this machine only")

    def _expect_token(self, in_address: str) -> None:
        given = self.headers.get(TOKEN_HEADER) or in_address
        if not is_token(given, self._viewer.token):
            message = "open the address that ncsim view printed, with its token"
            raise RequestError(HTTPStatus.FORBIDDEN, message)

    def _body(self) -> Mapping[str, Any]:
        """Return the JSON object that was sent."""
        kind = (self.headers.get("Content-Type") or "").partition(";")[0].strip().lower()
        if kind != JSON:
            raise bad(f"send {JSON}, not {kind or 'nothing'}")
        length = self.headers.get("Content-Length") or ""
        if not (length.isascii() and length.isdecimal()) or "Transfer-Encoding" in self.headers:
            raise RequestError(HTTPStatus.LENGTH_REQUIRED, "say how long the request is")
        if int(length) > MAX_BODY_BYTES:
            message = f"a request may have {MAX_BODY_BYTES} bytes, not {length}"
            raise RequestError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, message)
        return _object_in(self._received(int(length)))

    def _received(self, length: int) -> bytes:
        """Return the bytes of the request, which may not trickle in for ever."""
        deadline_s = time.monotonic() + BODY_WITHIN_s
        parts: list[bytes] = []
        while length > 0:
            part = self.rfile.read1(length)
            if not part or time.monotonic() > deadline_s:
                raise ConnectionError("the request ended early, or took too long")
            parts.append(part)
            length -= len(part)
        self._body_is_read = True
        return b"".join(parts)

    def _send_page(self) -> None:
        page = self._viewer.page()
        self._send(HTTPStatus.OK, "text/html; charset=utf-8", page.encode(), page_policy(page))

    def _send_json(self, document: object, status: HTTPStatus = HTTPStatus.OK) -> None:
        body = json.dumps(document, allow_nan=False, separators=(",", ":")).encode()
        self._send(status, JSON, body)

    def _send_error(self, status: HTTPStatus, message: str, more: Mapping[str, object]) -> None:
        if not self._body_is_read:  # what is left of it would be taken for the next request
            self.close_connection = True
        try:
            self._send_json({"error": message, **more}, status)
        except (ConnectionError, TimeoutError):
            self.close_connection = True

    def _send(self, status: HTTPStatus, kind: str, body: bytes, policy: str = DATA_POLICY) -> None:
        self._head(status, kind, policy, {"Content-Length": str(len(body))})
        self.wfile.write(body)

    def _head(self, status: HTTPStatus, kind: str, policy: str, more: Mapping[str, str]) -> None:
        self.send_response(status)
        headers = {"Content-Type": kind, "Content-Security-Policy": policy}
        if self.close_connection:
            headers["Connection"] = "close"
        for name, value in {**COMMON_HEADERS, **headers, **more}.items():
            self.send_header(name, value)
        self.end_headers()

    def _send_trace(self, identity: str) -> None:
        path = self._viewer.site.library.run(identity).trace
        if path is None:
            raise missing(f"trace of {identity!r}")
        kind = "application/gzip" if path.suffix == ".gz" else "application/x-ndjson"
        with path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size  # of a file that grows, what is there now
            self._head(HTTPStatus.OK, kind, DATA_POLICY, {"Content-Length": str(size)})
            while size > 0 and (part := file.read(min(size, COPY_BYTES))):
                self.wfile.write(part)
                size -= len(part)

    def _send_stream(self, identity: str, place: str) -> None:
        """Send a trace as it grows, until it ends or nobody listens."""
        library = self._viewer.site.library
        library.run(identity)
        wish = self.headers.get("Last-Event-ID") or place
        mark = Mark.parse(wish) if wish else START
        if mark is None:
            raise bad(f"{wish!r} is no place in a trace")
        self.close_connection = True
        self._head(HTTPStatus.OK, "text/event-stream", DATA_POLICY, {})
        self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        steps = follow(lambda: source_of(library, identity), mark)
        for data in event_bytes(steps, self._viewer.rest):
            self.wfile.write(data)


def _object_in(body: bytes) -> Mapping[str, Any]:
    try:
        document = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise bad(f"this is no JSON: {error}") from error
    if not isinstance(document, dict):
        raise bad("send a JSON object")
    return document
