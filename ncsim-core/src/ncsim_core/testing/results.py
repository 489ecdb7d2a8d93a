"""Checks and what comes of them, as data."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

CheckStatus: TypeAlias = Literal[
    "passed", "failed", "skipped", "expected_failure", "unexpected_pass"
]


@dataclass(frozen=True)
class Check:
    """One property of a contract.

    Args:
        name: What it claims, in words joined by ``_``.
        body: The suite's method.
        capability: Run only for components that declare it.
        is_drawn: Whether options and cases are drawn; otherwise it runs once.
        drawn: Names of the parameters to be drawn.
        asks: Whether a component is built and asked; otherwise only its declaration is read.
    """

    name: str
    body: Callable[..., None]
    capability: str | None
    is_drawn: bool
    drawn: tuple[str, ...]
    asks: bool = True


@dataclass(frozen=True)
class CheckResult:
    """What came of one check of one component.

    Args:
        component: Qualified name; a distribution for checks of a whole plug-in.
        check: Name of the check.
        status: How it ended.
        detail: Why it failed or was skipped.
        duration_s: Time it took.
        error: What was raised, for those who want the traceback.
    """

    component: str
    check: str
    status: CheckStatus
    detail: str = ""
    duration_s: float = 0.0
    error: BaseException | None = None

    @property
    def is_bad(self) -> bool:
        """Return whether it should keep a plug-in from being published."""
        return self.status in ("failed", "unexpected_pass")
