"""Which SAGA schedulers ncsim offers, by their published names.

Importing this module imports nothing of SAGA.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, TypeAlias


@dataclass(frozen=True)
class CatalogueEntry:
    """One scheduler of SAGA, described.

    Args:
        name: Published name, as in scenarios.
        saga_class: Class in ``saga.schedulers``.
        summary: One line.
        options: JSON Schema of each option; defaults are SAGA's own.
        walks_strings: It walks sets of plain strings, whose order ncsim cannot set from outside,
            so it runs in a child process with ``PYTHONHASHSEED=0`` (SPEC 22).
        keeps_state: Its solver answers otherwise after it has answered something else, so each
            plan gets a child process of its own.
        draws: It draws from the global ``random`` generator (SPEC 22).
        requires: Requirement beyond the distribution's own.
        capabilities: What it claims beyond its contract.
        source: Where the algorithm is published.
        expected_failures: Conformance checks that it is known to fail, name to reason.
    """

    name: str
    saga_class: str
    summary: str
    options: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    walks_strings: bool = False
    keeps_state: bool = False
    draws: bool = False
    requires: tuple[str, ...] = ()
    capabilities: frozenset[str] = frozenset()
    source: str = ""
    expected_failures: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_planned_in_child(self) -> bool:
        """Return whether plans are made in another process."""
        return self.walks_strings or self.keeps_state

    @property
    def factory(self) -> str:
        """Return what builds it: an own function where there are options."""
        if self.options:
            return f"ncsim_saga.schedulers.with_options:{self.name}"
        return "ncsim_saga.schedulers.saga_scheduler:SagaScheduler"


_OptionSchemas: TypeAlias = Mapping[str, Mapping[str, object]]

_OPTIONS_OF_NATIVE: _OptionSchemas = {
    "engine": {
        "description": "Who plans: ncsim's own planner (native), SAGA's (saga), or ncsim's choice "
        "(auto, at present native). Placements are the same.",
        "type": "string",
        "enum": ["auto", "native", "saga"],
        "default": "auto",
    }
}
_OPTIONS_OF_FCP: _OptionSchemas = {
    "priority_queue_size": {
        "description": "Ready tasks kept sorted by priority, a count; null: one per node.",
        "type": ["integer", "null"],
        "minimum": 1,
        "default": None,
    }
}
_OPTIONS_OF_GDL: _OptionSchemas = {
    "dynamic_level": {
        "description": "Dynamic level DL1 (1) or DL2 (2) of the publication.",
        "type": "integer",
        "enum": [1, 2],
        "default": 2,
    }
}
_OPTIONS_OF_SMT: _OptionSchemas = {
    "epsilon": {
        "description": "Makespan within which the search stops, in seconds.",
        "type": "number",
        "exclusiveMinimum": 0,
        "default": 1e-3,
    },
    "solver_name": {
        "description": "Solver as named by pySMT; null: the first one installed.",
        "type": ["string", "null"],
        "default": None,
    },
}
_OPTIONS_OF_WBA: _OptionSchemas = {
    "alpha": {
        "description": "Share of the range of makespan increases to draw from: 0 only the "
        "least, 1 all.",
        "type": "number",
        "minimum": 0,
        "maximum": 1,
        "default": 0.5,
    }
}

SCHEDULERS: Final[Mapping[str, CatalogueEntry]] = {
    entry.name: entry
    for entry in (
        CatalogueEntry(
            "bil",
            "BILScheduler",
            "Best imaginary level.",
            walks_strings=True,
            source="https://doi.org/10.1007/BFb0024750",
        ),
        CatalogueEntry(
            "brute_force",
            "BruteForceScheduler",
            "Tries every placement in every order; for a handful of tasks only.",
            capabilities=frozenset({"max_tasks=3"}),
        ),
        CatalogueEntry(
            "cpop",
            "CpopScheduler",
            "Critical path on one processor.",
            _OPTIONS_OF_NATIVE,
            capabilities=frozenset({"scale_invariant"}),
            source="https://doi.org/10.1109/71.993206",
        ),
        CatalogueEntry("dps", "DPSScheduler", "Dynamic priority scheduling."),
        CatalogueEntry("duplex", "DuplexScheduler", "The better of min-min and max-min."),
        CatalogueEntry("etf", "ETFScheduler", "Earliest task first.", walks_strings=True),
        CatalogueEntry(
            "fastest_node", "FastestNodeScheduler", "Everything on the fastest node, in turn."
        ),
        CatalogueEntry(
            "fcp",
            "FCPScheduler",
            "Fast critical path.",
            _OPTIONS_OF_FCP,
            source="https://doi.org/10.1145/305138.305162",
        ),
        CatalogueEntry(
            "flb",
            "FLBScheduler",
            "Fast load balancing.",
            source="https://doi.org/10.1109/ICPP.1999.797442",
        ),
        CatalogueEntry(
            "gdl",
            "GDLScheduler",
            "Generalised dynamic level.",
            _OPTIONS_OF_GDL,
            source="https://doi.org/10.1109/71.207593",
        ),
        CatalogueEntry(
            "hbmct",
            "HbmctScheduler",
            "Hybrid minimum completion time; refuses DAGs of which it would lose tasks.",
        ),
        CatalogueEntry(
            "heft",
            "HeftScheduler",
            "Heterogeneous earliest finish time.",
            _OPTIONS_OF_NATIVE,
            capabilities=frozenset({"scale_invariant"}),
            source="https://doi.org/10.1109/71.993206",
        ),
        CatalogueEntry("maxmin", "MaxMinScheduler", "Largest least completion time first."),
        CatalogueEntry(
            "mct",
            "MCTScheduler",
            "Minimum completion time, tasks in topological order.",
            source="https://doi.org/10.1006/jpdc.2000.1714",
        ),
        CatalogueEntry("met", "METScheduler", "Minimum execution time, whatever the load."),
        CatalogueEntry("minmin", "MinMinScheduler", "Smallest least completion time first."),
        CatalogueEntry(
            "msbc",
            "MsbcScheduler",
            "Multiple strict bound constraints.",
            walks_strings=True,
            source="https://doi.org/10.1109/PACRIM.2005.1517309",
        ),
        CatalogueEntry("mst", "MSTScheduler", "Minimum start time."),
        CatalogueEntry(
            "olb",
            "OLBScheduler",
            "Next idle node, whatever the task.",
            source="https://doi.org/10.1006/jpdc.2000.1714",
        ),
        CatalogueEntry(
            "smt",
            "SMTScheduler",
            "Makespan within epsilon of the least, by a solver; for a handful of tasks only.",
            _OPTIONS_OF_SMT,
            keeps_state=True,
            capabilities=frozenset({"max_tasks=2"}),
            expected_failures={
                "extremes_are_planned": "SAGA's SMT finds no schedule if a DAG needs no time"
            },
        ),
        CatalogueEntry(
            "sufferage",
            "SufferageScheduler",
            "The task that would suffer most goes first.",
            source="https://doi.org/10.1007/978-3-540-69277-5_7",
        ),
        CatalogueEntry(
            "wba",
            "WBAScheduler",
            "Workflow-based allocation: draws among placements that cost little.",
            _OPTIONS_OF_WBA,
            draws=True,
            source="https://doi.org/10.1109/CCGRID.2005.1558639",
        ),
        CatalogueEntry(
            "peft",
            "PEFTScheduler",
            "Predict earliest finish time.",
            requires=("anrg-saga>=2.1",),
            source="https://doi.org/10.1109/TPDS.2013.57",
        ),
    )
}
