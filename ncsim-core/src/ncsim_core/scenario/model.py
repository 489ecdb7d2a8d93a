"""A resolved scenario: what exists, what is asked, who decides. All of it is frozen."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from ncsim_core.network import Link, Network, Node
from ncsim_core.plugins import KINDS
from ncsim_core.scenario.yaml_text import dump_yaml
from ncsim_core.units import s_from_us
from ncsim_core.workflow import DAG, Injection

DEFAULT_SEED = 42


@dataclass(frozen=True)
class ComponentSpec:
    """Which component answers for a kind, and with which options.

    Args:
        name: Bare name such as ``heft``, or ``distribution/name``.
        options: Every option with its value, defaults written out.
    """

    name: str
    options: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class Config:
    """The ``config`` part of a scenario with every default decided.

    Args:
        seed: Seed of all random draws of a run, 0 or more.
        components: By kind (a key of ``plugins.KINDS``), the component that answers for it.
        sections: By name, the config sections in use, defaults filled in.
    """

    seed: int
    components: Mapping[str, ComponentSpec]
    sections: Mapping[str, Mapping[str, object]] = field(default_factory=dict)


@dataclass(frozen=True)
class Scenario:
    """A checked scenario; its network has no link rates yet.

    Args:
        name: What people call it.
        description: Free text, may be empty.
        network: Nodes and links as written.
        injections: The DAGs and their times, in file order.
        config: Seed, components and sections.
        notes: What was translated on the way in, for the user to know; no part of equality.
    """

    name: str
    description: str
    network: Network
    injections: tuple[Injection, ...]
    config: Config
    notes: tuple[str, ...] = field(default=(), compare=False)

    def to_document(self) -> dict[str, object]:
        """Return the scenario as a file would state it, with every default written out.

        ``parse_scenario`` turns the answer back into an equal scenario.
        """
        head = {"name": self.name}
        if self.description:
            head["description"] = self.description
        return {
            "scenario": {
                **head,
                "network": {
                    "nodes": [node_row(node) for node in self.network.nodes],
                    "links": [link_row(link) for link in self.network.links],
                },
                "dags": [dag_row(injection) for injection in self.injections],
                "config": _config_rows(self.config),
            }
        }

    def to_yaml(self) -> str:
        """Return ``to_document`` as YAML text."""
        return dump_yaml(self.to_document())

    @cached_property
    def sha256(self) -> str:
        """Return the SHA-256, in hexadecimal, of the resolved document as canonical JSON."""
        text = json.dumps(
            self.to_document(), sort_keys=True, separators=(",", ":"), allow_nan=False
        )
        return hashlib.sha256(text.encode()).hexdigest()


def node_row(node: Node) -> dict[str, object]:
    """Return a node as a file states it."""
    row: dict[str, object] = {"id": node.id, "compute_capacity": node.compute_capacity}
    if node.position is not None:
        row["position"] = {"x": node.position.x_m, "y": node.position.y_m}
    return row


def link_row(link: Link) -> dict[str, object]:
    """Return a link as a file states it."""
    row: dict[str, object] = {"id": link.id, "from": link.source, "to": link.target}
    if link.bandwidth_MBps is not None:
        row["bandwidth"] = link.bandwidth_MBps
    return {**row, "latency": link.latency_s, "medium": link.medium}


def dag_row(injection: Injection) -> dict[str, object]:
    """Return a DAG and its time as a file states them."""
    dag = injection.dag
    return {
        "id": dag.id,
        "inject_at": s_from_us(injection.at_us),
        "tasks": _task_rows(dag),
        "edges": [
            {"from": each.source, "to": each.target, "data_size": each.data_size_MB}
            for each in dag.dependencies
        ],
    }


def _task_rows(dag: DAG) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for task in dag.tasks:
        row: dict[str, object] = {"id": task.id, "compute_cost": task.compute_cost}
        if task.pinned_to is not None:
            row["pinned_to"] = task.pinned_to
        rows.append(row)
    return rows


def _config_rows(config: Config) -> dict[str, object]:
    rows: dict[str, object] = {"seed": config.seed}
    for kind, spec in config.components.items():
        row: dict[str, object] = {"type": spec.name}
        if spec.options:
            row["options"] = dict(spec.options)
        rows[KINDS[kind].config_key] = row
    return {**rows, **{name: dict(section) for name, section in config.sections.items()}}
