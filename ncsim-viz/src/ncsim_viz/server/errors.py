"""What the server refuses, with the status of HTTP that says so."""

from collections.abc import Mapping
from http import HTTPStatus

from ncsim_core.errors import NcsimError


class RequestError(NcsimError):
    """A request that is answered with an error.

    Args:
        status: Of HTTP.
        message: What is wrong, for people.
        more: What the answer says besides.
    """

    def __init__(
        self, status: HTTPStatus, message: str, more: Mapping[str, object] | None = None
    ) -> None:
        super().__init__(message)
        self.status = status
        self.more = dict(more or {})


def missing(what: str) -> RequestError:
    """Return the error for what is not there, or not for everybody's eyes."""
    return RequestError(HTTPStatus.NOT_FOUND, f"{what}: there is no such thing here")


def bad(message: str, more: Mapping[str, object] | None = None) -> RequestError:
    """Return the error for a request that makes no sense."""
    return RequestError(HTTPStatus.BAD_REQUEST, message, more)


def conflict(message: str) -> RequestError:
    """Return the error for a request that comes too early or too late."""
    return RequestError(HTTPStatus.CONFLICT, message)
