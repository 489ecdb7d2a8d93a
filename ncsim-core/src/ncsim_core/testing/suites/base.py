"""What holds for components of every kind, and how a subclass becomes tests."""

import pickle
import random
from collections.abc import Callable, Mapping
from typing import ClassVar, cast

import pytest
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.errors import NcsimError, place_of
from ncsim_core.registry import Registry, get_registry
from ncsim_core.testing.checking import PREFIX, REFUSALS, check, described, result_of
from ncsim_core.testing.child import answers_in_new_process
from ncsim_core.testing.option_strategies import options_for
from ncsim_core.testing.questions import Answer, Case, fixed_cases
from ncsim_core.testing.results import Check, CheckResult
from ncsim_core.testing.strategies import runs
from ncsim_core.testing.subject import Subject, default_sections
from ncsim_core.testing.suites.declaration import DeclarationChecks
from ncsim_core.testing.suites.runs import RunChecks
from ncsim_core.testing.telling import example_text

DRAW = "draw from context.rng('a name of yours') instead"
STEADY = (
    "keep nothing from one question to the next, look at no clock, and take "
    "context.rng('a name of yours') anew where you draw"
)


class ComponentSuite(RunChecks, DeclarationChecks):
    """Checks of one component; subclass the suite of its kind and name the component.

    Each ``check_<name>`` becomes ``test_<name>`` of every subclass that has a ``component``. A
    check bound to a capability that the component does not declare is skipped, and says so.

    Attributes:
        component: Name in the registry, bare or ``distribution/name``.
        options: Options to build it with; ``None`` draws them from its schema.
        sections: Config sections to build it with; ``None`` takes their defaults.
        examples: How many examples each check draws.
        expected_failures: Reasons, by name of the check, why it is known to fail. Such a check
            has to fail: once it passes, the entry must go.
    """

    kind: ClassVar[str]
    component: ClassVar[str] = ""
    options: ClassVar[Mapping[str, object] | None] = None
    sections: ClassVar[Mapping[str, Mapping[str, object]] | None] = None
    examples: int = 20
    expected_failures: ClassVar[Mapping[str, str]] = {}

    registry: Registry | None = None
    _standstill: ClassVar[str | None] = None

    @override
    def __init_subclass__(cls) -> None:
        """Turn the checks into fresh tests of this subclass.

        Raises:
            ValueError: ``expected_failures`` names something that is no check.
        """
        super().__init_subclass__()
        checks = cls.checks()
        unknown = set(cls.expected_failures) - {each.name for each in checks}
        if unknown:
            raise ValueError(f"{cls.__name__}.expected_failures: no checks {sorted(unknown)}")
        if cls.component:
            for each in checks:
                setattr(cls, f"test_{each.name}", _test_of(each))

    @classmethod
    def checks(cls) -> tuple[Check, ...]:
        """Return all checks of this suite, those for every kind first."""
        found: dict[str, Check] = {}
        for ancestor in reversed(cls.__mro__):
            for name, value in vars(ancestor).items():
                if name.startswith(PREFIX) and hasattr(value, "ncsim_check"):
                    found[name] = value.ncsim_check
        return tuple(found.values())

    def result(self, one: Check) -> CheckResult:
        """Return what comes of one check."""
        declared = self.subject().component.expected_failures
        return result_of(self, one, {**declared, **self.expected_failures})

    def subject(self) -> Subject:
        """Return the component with default options.

        Raises:
            UnknownComponentError: It is not registered.
        """
        registry = self.registry or get_registry()
        sections = default_sections(registry) if self.sections is None else self.sections
        registered = registry.find(self.kind, self.component)
        return Subject(registry, registered, self.options or {}, sections)

    def standstill(self) -> str | None:
        """Return why it cannot be built or asked one ordinary question, found out once per class.

        Each check would fail for that reason; it is said once, not in as many ways.
        """
        cls = type(self)
        if "_standstill" not in vars(cls):
            cls._standstill = _standstill_of(self, self.subject())
        return cls._standstill

    def option_values(self, subject: Subject) -> SearchStrategy[Mapping[str, object]]:
        """Return the options to draw."""
        if self.options is not None:
            return st.just(self.options)
        return cast("SearchStrategy[Mapping[str, object]]", options_for(subject.registered.schema))

    def section_values(
        self, subject: Subject
    ) -> SearchStrategy[Mapping[str, Mapping[str, object]]]:
        """Return the config sections to draw; override it to vary them."""
        return st.just(subject.sections)

    def cases(self) -> SearchStrategy[Case]:
        """Return the questions to draw."""
        raise NotImplementedError

    def ordinary_cases(self, subject: Subject) -> list[Case]:
        """Return a few questions, always the same, for what is too slow to draw."""
        del subject
        return fixed_cases(self.kind)

    def strategies(self) -> Mapping[str, SearchStrategy[object]]:
        """Return what each parameter of a check may be."""
        return {"case": self.cases(), "other": self.cases(), "run": runs()}

    @check()
    def check_same_question_same_answer(self, subject: Subject, case: Case, other: Case) -> None:
        """The answer is the same when asked again, after another question, and built anew."""
        answer = self.fresh_answer(subject, case)
        self.fresh_answer(subject, other)
        anew = self.fresh_answer(subject, case)
        assert anew == answer, f"built anew, it answers otherwise: {answer}, then {anew}; {STEADY}"
        if self.kind == "queue_model":
            return
        component = subject.build(case)
        subject.ask(component, case)
        again = subject.ask(component, case)
        assert again == answer, (
            f"asked again, it answers otherwise: {answer}, then {again}; {STEADY}"
        )

    @check()
    def check_global_generators_stay_untouched(self, subject: Subject, case: Case) -> None:
        """Neither ``random`` nor ``numpy.random`` is drawn from or seeded."""
        import numpy as np

        before, numpy_before = random.getstate(), pickle.dumps(np.random.get_state())
        self.fresh_answer(subject, case)
        assert random.getstate() == before, f"the global generator of random was used; {DRAW}"
        numpy_after = pickle.dumps(np.random.get_state())
        assert numpy_after == numpy_before, f"the global generator of numpy was used; {DRAW}"

    @check()
    def check_arguments_stay_unchanged(self, subject: Subject, case: Case) -> None:
        """Neither the network nor anything else it is given is changed."""
        before = pickle.dumps(_plain(case))
        self.fresh_answer(subject, case)
        assert pickle.dumps(_plain(case)) == before, "an argument was changed"

    @check()
    def check_pickled_copy_gives_same_answer(self, subject: Subject, case: Case) -> None:
        """It can be sent to another process."""
        component = subject.build(case)
        copy = pickle.loads(pickle.dumps(component))
        ours, its = subject.ask(component, case), subject.ask(copy, case)
        assert its == ours, f"its pickled copy answers {its} instead of {ours}"

    @check(is_drawn=False)
    def check_hash_seed_changes_nothing(self, subject: Subject) -> None:
        """A new process with another ``PYTHONHASHSEED`` gives the same answers."""
        cases = [
            case
            for each in self.ordinary_cases(subject)
            for case in [subject.settle(each)]
            if not _is_refused(self, subject, case)
        ]
        assert cases, "it refuses all ordinary questions"
        here = [self.fresh_answer(subject, case) for case in cases]
        there = answers_in_new_process(subject, cases)
        assert there == here, (
            "the hash seed decides: an answer follows the order of a set, or hash(); sort first"
        )

    def fresh_answer(self, subject: Subject, case: Case) -> Answer:
        """Return the answer of a component built for this question alone."""
        return subject.ask(subject.build(case), case)


def _test_of(one: Check) -> Callable[[ComponentSuite], None]:
    """Return a new test function for one check; hypothesis must not see one function twice."""

    def test(self: ComponentSuite) -> None:
        __tracebackhide__ = True
        result = self.result(one)
        if result.status == "skipped":
            pytest.skip(result.detail)
        if result.status == "expected_failure":
            pytest.xfail(result.detail)
        if result.status == "unexpected_pass":
            pytest.fail(f"[XPASS(strict)] {result.detail}")
        if isinstance(result.error, AssertionError) and place_of(result.error) is None:
            pytest.fail(f"{(one.body.__doc__ or '').strip()}\n{result.detail}", pytrace=False)
        if result.error is not None:
            raise result.error

    test.__name__ = f"test_{one.name}"
    test.__doc__ = one.body.__doc__
    return test


def _standstill_of(suite: ComponentSuite, subject: Subject) -> str | None:
    for each in suite.ordinary_cases(subject)[:1]:
        try:
            case = subject.settle(each)
            component = subject.build(case)
            if suite.kind != "dag_source":  # whose answer may have no end
                subject.ask(component, case)
        except REFUSALS:
            return None
        except (Exception, SystemExit) as error:
            if isinstance(error, NcsimError):
                return f"it answers nothing: {error}"
            asked = example_text(subject.options, {}, {"asked about": each})
            return f"it answers nothing: {described(error)}\n{asked}"
    return None


def _is_refused(suite: ComponentSuite, subject: Subject, case: Case) -> bool:
    try:
        suite.fresh_answer(subject, case)
    except REFUSALS:
        return True
    return False


def _plain(case: Case) -> object:
    """Return everything of a case that a component could change, without lazily kept values."""
    network, dag = case.network, case.dag
    return (
        (network.nodes, network.links, network.rates, dict(network.node_index)),
        dag and (dag.id, dag.tasks, dag.dependencies, dict(dag.task_index)),
        case.injections,
    )
