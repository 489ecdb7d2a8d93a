"""What a plug-in declares, and the hooks through which ncsim asks for it.

A distribution becomes a plug-in by an entry point in the group ``ncsim.plugins`` whose value is a
*declaration module*: it sets ``NCSIM_PLUGIN_API`` and implements hooks, and importing it imports
nothing but this module. What it declares stays text (``"package.module:callable"``) until a run
needs it, so listing plug-ins is cheap and one broken plug-in breaks nothing else.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import pluggy

if TYPE_CHECKING:
    from ncsim_core.models import ComponentIdentity

PLUGIN_API: Final = (1, 0)
"""Major and minor version of what plug-ins may rely on, apart from release numbers.

A plug-in loads if its major is equal and its minor not above. A minor only adds.
"""

PLUGIN_GROUP: Final = "ncsim.plugins"
RUN_FIGURE_GROUP: Final = "ncsim.run_figures"
"""Entry points by kind of figure: functions of a ``RunTrace`` and the path of a picture."""

NAME_PATTERN: Final = re.compile(r"[a-z][a-z0-9_]*\Z")

hookspec = pluggy.HookspecMarker("ncsim")
hookimpl = pluggy.HookimplMarker("ncsim")


@dataclass(frozen=True)
class Kind:
    """One of the six extension points.

    Args:
        name: Name in declarations and on the command line, such as ``routing_model``.
        config_key: Key under ``config`` in a scenario, such as ``routing``.
        contract: Import string of the abstract base class.
        question: What components of this kind answer.
        capabilities: What they may claim, without the ``=value`` of some.
    """

    name: str
    config_key: str
    contract: str
    question: str
    capabilities: frozenset[str] = frozenset()


KINDS: Final[Mapping[str, Kind]] = {
    kind.name: kind
    for kind in (
        Kind(
            "scheduler",
            "scheduler",
            "ncsim_core.contracts.scheduler:Scheduler",
            "where does each task run?",
            frozenset({"scale_invariant", "max_tasks"}),
        ),
        Kind(
            "routing_model",
            "routing",
            "ncsim_core.contracts.routing_model:RoutingModel",
            "which links does a transfer occupy?",
            frozenset({"objective", "single_hop", "pure"}),
        ),
        Kind(
            "link_model",
            "link_model",
            "ncsim_core.contracts.link_model:LinkModel",
            "what does a link offer alone?",
            frozenset({"radio"}),
        ),
        Kind(
            "interference_model",
            "interference",
            "ncsim_core.contracts.interference_model:InterferenceModel",
            "how much does concurrent traffic slow a link?",
            frozenset({"needs_radio", "decides_routes", "monotone"}),
        ),
        Kind(
            "queue_model",
            "queue",
            "ncsim_core.contracts.queue_model:QueueModel",
            "which waiting task is next?",
            frozenset({"order"}),
        ),
        Kind(
            "dag_source",
            "dag_source",
            "ncsim_core.contracts.dag_source:DAGSource",
            "which DAGs arrive, and when?",
        ),
    )
}


@dataclass(frozen=True)
class Component:
    """A named implementation of one contract, described without importing it.

    Args:
        kind: A key of ``KINDS``.
        name: ``[a-z][a-z0-9_]*``, unique within the distribution and kind.
        factory: ``"package.module:callable"``, called as ``factory(context, **params,
            **options)`` with a ``BuildContext``; returns an instance of the contract.
        summary: One line for ``ncsim plugins list``.
        options: JSON Schema (draft-07) of an object with the user's options: descriptions
            with units, defaults equal to the factory's, ``additionalProperties: false``. Or
            ``"package:folder/file.json"``. ``None`` means that it has no options.
        params: Fixed keyword arguments, for one factory behind several names.
        requires: Requirements beyond the distribution's own, such as ``"anrg-saga>=2.1"``,
            checked from metadata.
        capabilities: Claims that choose defaults and conformance checks. ``radio``: a
            link model that derives rates from positions. ``needs_radio``: an interference
            model that wants such a link model. ``decides_routes``: one that, with some of
            its options, gives whole routes their rates. ``monotone``, ``scale_invariant``,
            ``objective=hops|latency|bottleneck``, ``order=fifo|lifo|shortest|longest``:
            extra properties to be tested. ``single_hop``: a routing model that only ever
            takes one link. ``pure``: a routing model whose answers follow from network
            and options alone, no seed and no section, so that runs share them. ``max_tasks=<n>``: a
            scheduler to be checked on small DAGs only.
        expected_failures: Conformance checks that it is known to fail, name to reason.
        source: Where the method is described: equation, paper, DOI.
    """

    kind: str
    name: str
    factory: str
    summary: str
    options: Mapping[str, object] | str | None = None
    params: Mapping[str, object] = field(default_factory=dict)
    requires: tuple[str, ...] = ()
    capabilities: frozenset[str] = frozenset()
    expected_failures: Mapping[str, str] = field(default_factory=dict)
    source: str = ""


@dataclass(frozen=True)
class Section:
    """A part of ``config`` that several components of a package share, such as ``rf``.

    Args:
        name: Key under ``config``.
        summary: One line.
        schema: JSON Schema (draft-07) of the object, or ``"package:folder/file.json"``.
        implies: Capabilities that a scenario with this section wants of its link model.
    """

    name: str
    summary: str
    schema: Mapping[str, object] | str
    implies: frozenset[str] = frozenset()


@dataclass(frozen=True)
class RunInfo:
    """What a run is, for plug-ins that accompany runs.

    Args:
        scenario_name: Name given in the scenario.
        seed: The run's seed.
        identities: By kind, the components of the run.
    """

    scenario_name: str
    seed: int
    identities: Mapping[str, "ComponentIdentity"]


class HookSpecs:
    """All hooks. None is called per event; the engine calls the six contracts directly."""

    @hookspec
    def ncsim_components(self) -> Iterable[Component]:  # type: ignore[empty-body]
        """Return the components that this plug-in offers."""

    @hookspec
    def ncsim_sections(self) -> Iterable[Section]:  # type: ignore[empty-body]
        """Return the config sections that this plug-in owns."""

    @hookspec
    def ncsim_run_started(self, run: RunInfo) -> None:
        """Be told that a run is about to start."""

    @hookspec
    def ncsim_run_finished(self, run: RunInfo, status: str, makespan_s: float | None) -> None:
        """Be told how a run ended; ``makespan_s`` is ``None`` unless it completed."""
