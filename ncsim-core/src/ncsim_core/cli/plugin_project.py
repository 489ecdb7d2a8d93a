"""Writes the files of a new plug-in from the templates beside this module."""

import importlib.resources
import re
from collections.abc import Mapping
from dataclasses import dataclass
from keyword import iskeyword
from pathlib import Path
from string import Template
from typing import Final

from ncsim_core.errors import ScenarioError
from ncsim_core.trace.files import write_atomically

CORE_REQUIREMENT: Final = "ncsim-core>=0.1,<0.2"

NAME_PATTERN: Final = re.compile(r"[a-z][a-z0-9]*([_-][a-z0-9]+)*")


@dataclass(frozen=True)
class Starter:
    """What differs between the kinds, apart from the class itself.

    Args:
        module: Module of the class: the plural of the contract's name.
        suite: Conformance suite.
        summary: What the class of the template does.
        capabilities: What it claims, for the declaration.
        options: JSON schema of its options as Python text; ``None`` for none.
    """

    module: str
    suite: str
    summary: str
    capabilities: str
    options: str = "None"


_SPREAD = """{
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "spread": {
                        "type": "integer",
                        "minimum": 1,
                        "default": 1,
                        "description": "How many of the fastest nodes take turns.",
                    },
                },
            }"""

_PEAK = """{
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "peak": {
                        "type": "number",
                        "minimum": 0,
                        "default": 10.0,
                        "description": "Bandwidth at no distance, in MB/s.",
                    },
                    "half_distance": {
                        "type": "number",
                        "minimum": 1,
                        "default": 50.0,
                        "description": "Distance over which bandwidth halves, in metres.",
                    },
                },
            }"""

_REPEAT = """{
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "repeat": {
                        "type": "integer",
                        "minimum": 1,
                        "default": 2,
                        "description": "How often each DAG is injected.",
                    },
                    "period": {
                        "type": "number",
                        "minimum": 0,
                        "default": 1.0,
                        "description": "Time from one injection of a DAG to the next, in s.",
                    },
                },
            }"""

STARTERS: Final[Mapping[str, Starter]] = {
    "scheduler": Starter(
        module="schedulers",
        suite="SchedulerSuite",
        summary="Deals tasks out to the fastest nodes.",
        capabilities='{"scale_invariant"}',
        options=_SPREAD,
    ),
    "routing_model": Starter(
        module="routing_models",
        suite="RoutingModelSuite",
        summary="Takes the fewest links.",
        capabilities='{"objective=hops"}',
    ),
    "link_model": Starter(
        module="link_models",
        suite="LinkModelSuite",
        summary="Lets bandwidth halve with every so many metres.",
        capabilities='{"radio"}',
        options=_PEAK,
    ),
    "interference_model": Starter(
        module="interference_models",
        suite="InterferenceModelSuite",
        summary="Lets links that meet at a node take turns.",
        capabilities='{"monotone"}',
    ),
    "queue_model": Starter(
        module="queue_models",
        suite="QueueModelSuite",
        summary="Runs the cheapest waiting task first.",
        capabilities='{"order=shortest"}',
    ),
    "dag_source": Starter(
        module="dag_sources",
        suite="DAGSourceSuite",
        summary="Injects every DAG of the scenario several times.",
        capabilities="()",
        options=_REPEAT,
    ),
}


def write_project(folder: Path, name: str, kind: str) -> list[Path]:
    """Write a plug-in project and return its files.

    Args:
        folder: Where; must not exist, or be empty.
        name: Name of the distribution.
        kind: One of the six kinds.

    Raises:
        ScenarioError: The name cannot be one, or the folder is not empty.
    """
    if not NAME_PATTERN.fullmatch(name) or iskeyword(name):
        raise ScenarioError(
            f"{name!r} cannot be a package name; take lower-case letters, digits and hyphens"
        )
    if folder.exists() and any(folder.iterdir()):
        raise ScenarioError(f"{folder} is not empty; choose another folder with --output")
    values = _values(name, kind)
    written = []
    for path, template in _files(values["package"], kind).items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(file, _template(template).substitute(values))
        written.append(file)
    return written


def _files(package: str, kind: str) -> dict[str, str]:
    """Return the template of each file."""
    source = f"src/{package}"
    return {
        "pyproject.toml": "pyproject.toml.in",
        "README.md": "README.md.in",
        f"{source}/__init__.py": "init.py.in",
        f"{source}/declaration.py": "declaration.py.in",
        f"{source}/{STARTERS[kind].module}.py": f"{kind}.py.in",
        "tests/test_conformance.py": "test_conformance.py.in",
    }


def _values(name: str, kind: str) -> dict[str, str]:
    starter = STARTERS[kind]
    package = name.replace("-", "_")
    component = package.removeprefix("ncsim_")
    return {
        "distribution": name.replace("_", "-"),
        "package": package,
        "component": component,
        "class_name": "".join(word.capitalize() for word in component.split("_")),
        "kind": kind,
        "module": starter.module,
        "suite": starter.suite,
        "summary": starter.summary,
        "capabilities": starter.capabilities,
        "options": starter.options,
        "core_requirement": CORE_REQUIREMENT,
        "config_key": _config_key(kind),
    }


def _config_key(kind: str) -> str:
    from ncsim_core.plugins import KINDS

    return KINDS[kind].config_key


def _template(name: str) -> Template:
    folder = importlib.resources.files("ncsim_core.cli") / "templates"
    return Template((folder / name).read_text("utf-8"))
