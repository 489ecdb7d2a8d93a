"""What ``ncsim doctor`` looks at, one finding after the other."""

import platform
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

from ncsim_core.cli.front_page import plugin_verbs

if TYPE_CHECKING:
    from packaging.requirements import Requirement

    from ncsim_core.registry import Registry

State: TypeAlias = Literal["ok", "warning", "trouble"]

OLDEST_PYTHON: Final = (3, 11)


class Finding(NamedTuple):
    """One thing that was looked at.

    Args:
        what: Its name.
        state: ``trouble`` is what must be mended; a ``warning`` can be lived with.
        text: What was found.
    """

    what: str
    state: State
    text: str


def findings() -> Iterator[Finding]:
    """Yield everything that is known about this installation, then what a self-test gives."""
    from ncsim_core.registry import get_registry

    registry = get_registry()
    yield _interpreter()
    yield Finding("ncsim-core", "ok", version("ncsim-core"))
    yield from _needs(["ncsim-core", *(each.distribution for each in registry.plugins)])
    yield _yaml_reader()
    yield from _plugins(registry)
    yield from _components(registry)
    yield from _verbs()
    for what, test in SELF_TESTS.items():
        yield _tested(what, test)


def _interpreter() -> Finding:
    state: State = "ok" if sys.version_info >= OLDEST_PYTHON else "trouble"
    text = f"{platform.python_implementation()} {platform.python_version()}, {platform.platform()}"
    return Finding("python", state, text)


def _needs(distributions: Iterable[str]) -> Iterator[Finding]:
    """Yield what these packages need, and whether the installed version is right."""
    from packaging.requirements import Requirement

    needs: dict[str, Requirement] = {}
    for text in (text for each in distributions for text in requires(each) or ()):
        need = Requirement(text)
        is_asked = need.marker is None or need.marker.evaluate({"extra": ""})
        if is_asked and not need.name.startswith("ncsim-"):
            needs.setdefault(need.name, need).specifier &= need.specifier
    yield from map(_need, needs.values())


def _need(need: "Requirement") -> Finding:
    try:
        found = version(need.name)
    except PackageNotFoundError:
        return Finding(need.name, "trouble", f"not installed; needed: {need}")
    if need.specifier.contains(found, prereleases=True):
        return Finding(need.name, "ok", found)
    return Finding(need.name, "trouble", f"{found} does not fit: {need}")


def _yaml_reader() -> Finding:
    import yaml

    if yaml.__with_libyaml__:
        return Finding("yaml reader", "ok", "libyaml")
    return Finding("yaml reader", "warning", "no libyaml, so scenarios are read slowly")


def _plugins(registry: "Registry") -> Iterator[Finding]:
    for record in registry.plugins:
        what = f"plug-in {record.distribution}"
        unmet = ", ".join(_unmet(record.distribution))
        if unmet:
            yield Finding(what, "trouble", f"{record.version} needs {unmet}")
        elif record.status == "ok":
            yield Finding(what, "ok", f"{record.version}, {_count(registry, record.distribution)}")
        else:
            state: State = "trouble" if record.is_broken else "warning"
            yield Finding(what, state, f"{record.version} is {record.status}: {record.detail}")


def _unmet(distribution: str) -> Iterator[str]:
    """Yield which other packages of ncsim a plug-in asks for in vain."""
    from ncsim_core.registry.records import requirement_fault

    for text in requires(distribution) or ():
        fault = requirement_fault(text) if text.startswith("ncsim-") and ";" not in text else None
        if fault is not None:
            yield fault


def _count(registry: "Registry", distribution: str) -> str:
    from ncsim_core.plugins import KINDS

    every = [each for kind in KINDS for each in registry.components(kind)]
    count = sum(each.distribution == distribution for each in every)
    return f"{count} component" + "s" * (count != 1)


def _components(registry: "Registry") -> Iterator[Finding]:
    """Yield the components that cannot be used."""
    from ncsim_core.plugins import KINDS
    from ncsim_core.registry.building import factory_fault

    for kind in KINDS:
        for each in registry.components(kind):
            what = f"{kind} {each.qualified_name}"
            if not each.is_available:
                yield Finding(what, "warning", f"needs {', '.join(each.missing_requirements)}")
            elif (fault := factory_fault(each)) is not None:
                yield Finding(what, "trouble", fault)


def _verbs() -> Iterator[Finding]:
    for name, entry_point in plugin_verbs().items():
        try:
            entry_point.load()
        except Exception as error:  # whatever a package does when it is imported
            yield Finding(f"verb {name}", "trouble", f"{type(error).__name__}: {error}")


def _tested(what: str, test: Callable[[], str]) -> Finding:
    try:
        return Finding(what, "ok", test())
    except Exception as error:  # a self-test says what went wrong, whatever it is
        return Finding(what, "trouble", f"{type(error).__name__}: {error}")


def _worked_example() -> str:
    """Run Appendix B and compare it with the paper."""
    from ncsim_core.api import result_of
    from ncsim_core.testing.worked_example import SERVED_MB, MAKESPAN_us, worked_example

    simulation = worked_example()
    outcome = simulation.run()
    served_MB = {link.link: link.served_MB for link in result_of(simulation).links}
    if (outcome.makespan_us, served_MB) != (MAKESPAN_us, SERVED_MB):
        raise ValueError(f"gives {outcome.makespan_us} us and {served_MB}, not as printed")
    return "5 s, with 4 and 5 MB served, as printed"


def _traces() -> str:
    """Write the trace of Appendix B twice, compare the bytes, and check one."""
    from ncsim_core.testing.worked_example import worked_example
    from ncsim_core.trace.check import check_trace
    from ncsim_core.trace.writer import TraceWriter

    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("one.jsonl", "other.jsonl")]
        for path in paths:
            with TraceWriter(path) as writer:
                worked_example(writer).run()
        if paths[0].read_bytes() != paths[1].read_bytes():
            raise ValueError("two runs give different bytes")
        faults = [fault.message for fault in check_trace(paths[0])]
    if faults:
        raise ValueError("; ".join(faults))
    return "two runs give the same bytes, and they add up"


SELF_TESTS: Final = {"self-test: Appendix B": _worked_example, "self-test: trace": _traces}
