"""Checks, how one is run, and what comes of it as data.

A check is a method ``check_<name>`` of a suite. Its parameters after ``subject`` are drawn by
hypothesis, always the same ones on every machine, so that a green run stays green.
"""

import inspect
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Protocol, TypeVar, cast

from hypothesis import HealthCheck, Phase, given, reject, settings
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable
from hypothesis.strategies import SearchStrategy

from ncsim_core.errors import ModelScopeError, NcsimError, PlacementError, ScenarioError, told
from ncsim_core.testing.questions import Case
from ncsim_core.testing.results import Check, CheckResult, CheckStatus
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.telling import example_text

if TYPE_CHECKING:
    from ncsim_core.registry import Registry
    from ncsim_core.testing.suites.base import ComponentSuite

CheckBody = TypeVar("CheckBody", bound=Callable[..., None])

PREFIX = "check_"

REFUSALS = (ScenarioError, ModelScopeError, PlacementError)
"""How a component says that an input is not for it, which is no fault of either."""

ENOUGH_s = 5.0
"""Time after which a check that has not failed draws no further examples."""


class ComponentChecks(Protocol):
    """What running a check needs to know of a suite."""

    examples: int

    def subject(self) -> Subject:
        """Return the component with default options."""

    def standstill(self) -> str | None:
        """Return why the component answers nothing at all."""

    def option_values(self, subject: Subject) -> SearchStrategy[Mapping[str, object]]:
        """Return the options to draw."""

    def section_values(
        self, subject: Subject
    ) -> SearchStrategy[Mapping[str, Mapping[str, object]]]:
        """Return the config sections to draw."""

    def strategies(self) -> Mapping[str, SearchStrategy[object]]:
        """Return what each parameter of a check may be."""


def check(
    *, capability: str | None = None, is_drawn: bool = True, asks: bool = True
) -> Callable[[CheckBody], CheckBody]:
    """Mark a method ``check_<name>(self, subject, ...)`` as a check."""

    def mark(body: CheckBody) -> CheckBody:
        parameters = list(inspect.signature(body).parameters)[2:]
        name = body.__name__.removeprefix(PREFIX)
        body.ncsim_check = Check(  # type: ignore[attr-defined]
            name, body, capability, is_drawn, tuple(parameters), asks
        )
        return body

    return mark


def result_of(suite: ComponentChecks, one: Check, expected: Mapping[str, str]) -> CheckResult:
    """Return what comes of one check; it raises nothing.

    Args:
        suite: The suite.
        one: A check of it.
        expected: Reasons, by name of the check, why it is known to fail.
    """
    started_s = time.perf_counter()
    subject = suite.subject()
    who = subject.registered.qualified_name

    def finish(
        status: CheckStatus, detail: str = "", error: BaseException | None = None
    ) -> CheckResult:
        return CheckResult(who, one.name, status, detail, time.perf_counter() - started_s, error)

    if one.capability is not None and subject.capability(one.capability) is None:
        return finish("skipped", f"does not declare {one.capability}")
    reason = expected.get(one.name)
    standstill = suite.standstill() if one.asks else None
    try:
        assert standstill is None, standstill
        note = run(suite, one, subject)
    except (Exception, SystemExit) as error:  # a check of a stranger's code reports, never breaks
        if reason is not None:
            return finish("expected_failure", reason, error)
        return finish("failed", described(error), error)
    if reason is not None:
        return finish("unexpected_pass", f"expected to fail: {reason}")
    return finish("passed", note)


def run(suite: ComponentChecks, one: Check, subject: Subject) -> str:
    """Run one check, let what it raises pass, and return what is worth a note.

    A component so slow that the examples take longer than ``ENOUGH_s`` gets fewer of them.
    """
    if not one.is_drawn:
        one.body(suite, subject)
        return ""
    known = suite.strategies()
    drawn = st.fixed_dictionaries({name: known[name] for name in one.drawn})
    patience, usual = _Patience(), subject.sections

    def on_example(
        options: Mapping[str, object],
        sections: Mapping[str, Mapping[str, object]],
        values: Mapping[str, object],
    ) -> None:
        if patience.is_over:
            return
        chosen = Subject(subject.registry, subject.registered, options, sections)
        try:
            one.body(suite, chosen, **{name: _settled(chosen, v) for name, v in values.items()})
        except REFUSALS:
            reject()  # a component may say that an input is not for it
        except BaseException:
            patience.has_failed = True
            others = {name: each for name, each in sections.items() if each != usual.get(name)}
            patience.example = example_text(options, others, values)
            raise
        patience.examples += 1

    test = given(
        options=suite.option_values(subject), sections=suite.section_values(subject), values=drawn
    )(on_example)
    try:
        steady_settings(suite.examples)(test)()
    except BaseException as error:
        _put_example(error, patience.example)  # the last that failed is the smallest
        raise
    return f"stopped after {patience.examples} examples, it is slow" if patience.is_over else ""


class _Patience:
    """Says when to leave it at the examples so far; never while a failure is being reduced."""

    def __init__(self) -> None:
        self.has_failed = False
        self.examples = 0
        self.example = ""
        self._until_s = time.perf_counter() + ENOUGH_s

    @property
    def is_over(self) -> bool:
        """Return whether time is up and at least one example has counted."""
        is_late = time.perf_counter() > self._until_s
        return is_late and self.examples > 0 and not self.has_failed


def check_component(
    kind: str,
    name: str,
    *,
    registry: "Registry | None" = None,
    expected_failures: Mapping[str, str] | None = None,
) -> list[CheckResult]:
    """Return the results of all checks of one component.

    Args:
        kind: One of the six kinds.
        name: Bare or qualified name.
        registry: Where it is registered, by default the process's own.
        expected_failures: Reasons by check, on top of those that the component declares.

    Raises:
        UnknownComponentError: There is no such component.
        ValueError: ``expected_failures`` names no check.
    """
    from ncsim_core.testing.suites import SUITES

    members = {"component": name, "expected_failures": expected_failures or {}}
    suite_class = cast("type[ComponentSuite]", type("AdHocSuite", (SUITES[kind],), members))
    suite = suite_class()
    suite.registry = registry
    suite.subject()
    return [suite.result(one) for one in suite.checks()]


def described(error: BaseException) -> str:
    """Return an error with the failing example, for people."""
    if isinstance(error, Unsatisfiable):
        return "it refused every example that was tried"
    if isinstance(error, AssertionError):
        text = str(error)
    else:
        text = str(error) if isinstance(error, NcsimError) else told(error)
    return "\n".join([text, *getattr(error, "__notes__", ())])


def _put_example(error: BaseException, example: str) -> None:
    """Put the example in place of hypothesis's own, which shows every field of every object."""
    if example:
        error.__notes__ = [f"the smallest example found:\n{example}"]


def _settled(subject: Subject, value: object) -> object:
    return subject.settle(value) if isinstance(value, Case) else value


def steady_settings(examples: int) -> settings:
    """Return settings under which a run takes no notice of clocks, disks and earlier runs."""
    return settings(
        max_examples=examples,
        derandomize=True,
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
