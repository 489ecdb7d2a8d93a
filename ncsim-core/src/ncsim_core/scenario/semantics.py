"""What no schema can say: unique ids, ends that exist, DAGs without cycles, models that are fed.

All checks work on plain rows and pass over what the schema has already refused, so that one
mistake is reported once, and all mistakes at once.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any, TypeAlias

from ncsim_core.plugins import KINDS
from ncsim_core.registry import Registry
from ncsim_core.scenario.faults import Data, Path, Problem, path_text, shown
from ncsim_core.scenario.model import Config
from ncsim_core.scenario.resolution import NEEDS_RADIO, RADIO
from ncsim_core.scenario.wording import Hints, cycle_text
from ncsim_core.workflow import find_cycle

Row: TypeAlias = Mapping[str, Any]


def network_problems(scenario: Row) -> Iterator[Problem]:
    """Yield repeated ids of nodes and links, and links that lead nowhere."""
    nodes = list(rows(scenario, ("scenario", "network", "nodes")))
    links = list(rows(scenario, ("scenario", "network", "links")))
    yield from _repeated(nodes, "node")
    yield from _repeated(links, "link")
    node_ids = _Known("node", nodes)
    for path, link in links:
        for end in ("from", "to"):
            yield from node_ids.dangling((*path, end), link.get(end))
        if isinstance(link.get("to"), str) and link["to"] == link.get("from"):
            yield Problem((*path, "to"), "a link must not lead from a node to itself", link["to"])


def dag_problems(scenario: Row) -> Iterator[Problem]:
    """Yield repeated ids, edges that lead nowhere or stand twice, cycles, and wrong pins."""
    nodes = _Known("node", rows(scenario, ("scenario", "network", "nodes")))
    dags = list(rows(scenario, ("scenario", "dags")))
    yield from _repeated(dags, "DAG")
    for path, dag in dags:
        tasks = list(rows(dag, (*path, "tasks"), start=len(path)))
        edges = list(rows(dag, (*path, "edges"), start=len(path)))
        yield from _repeated(tasks, "task")
        yield from _wrong_pins(tasks, nodes)
        yield from _edge_problems(tasks, edges)


def config_problems(scenario: Row, config: Config, registry: Registry) -> Iterator[Problem]:
    """Yield what the chosen components miss in the rest of the scenario."""
    yield from _link_model_problems(scenario, config, registry)
    yield from _position_problems(scenario, config, registry)
    dags = list(rows(scenario, ("scenario", "dags")))
    if config.components["scheduler"].name == "manual":
        yield from _unpinned(dags)
    is_given = isinstance(scenario["scenario"].get("dags"), list)
    if is_given and config.components["dag_source"].name == "single" and len(dags) != 1:
        path = ("scenario", "config", KINDS["dag_source"].config_key)
        message = f"dag_source single needs exactly one DAG, the scenario has {len(dags)}"
        yield Problem(path, message, suggestion="multi")


def rows(data: Data, path: Path, start: int = 0) -> Iterator[tuple[Path, Row]]:
    """Yield the mappings in the list at ``path``, each with its path.

    Args:
        data: What lies ``start`` steps down ``path``.
        path: From the root to the list.
        start: Steps of ``path`` that ``data`` is already behind.
    """
    for step in path[start:]:
        data = data.get(step) if isinstance(data, dict) else None
    for index, row in enumerate(data if isinstance(data, list) else ()):
        if isinstance(row, dict):
            yield (*path, index), row


class _Known:
    """Ids in file order; a number counts as its text, for it has a fault of its own."""

    def __init__(self, noun: str, listed: Iterable[tuple[Path, Row]]) -> None:
        self.noun = noun
        self.ids = {str(row["id"]): None for _, row in listed if "id" in row}
        self.hints = Hints(self.ids)

    def dangling(self, path: Path, name: object) -> Iterator[Problem]:
        """Yield that ``name`` is none of the ids."""
        if isinstance(name, str) and name and name not in self.ids:
            hint = self.hints.hint(name)
            yield Problem(path, f"no {self.noun} {name!r}", shown(name), hint)


def _repeated(listed: list[tuple[Path, Row]], noun: str) -> Iterator[Problem]:
    first: dict[str, Path] = {}
    for path, row in listed:
        name = row.get("id")
        if not isinstance(name, str):
            continue
        if name in first:
            message = f"{noun} {name!r} is given twice, first as {path_text(first[name])}"
            yield Problem((*path, "id"), message, name)
        first.setdefault(name, path)


def _wrong_pins(tasks: list[tuple[Path, Row]], nodes: _Known) -> Iterator[Problem]:
    if nodes.ids:  # without any node, there is a greater fault elsewhere
        for path, task in tasks:
            yield from nodes.dangling((*path, "pinned_to"), task.get("pinned_to"))


def _edge_problems(
    tasks: list[tuple[Path, Row]], edges: list[tuple[Path, Row]]
) -> Iterator[Problem]:
    task_ids = _Known("task", tasks)
    first: dict[tuple[str, str], Path] = {}
    for path, edge in edges:
        source, target = edge.get("from"), edge.get("to")
        yield from task_ids.dangling((*path, "from"), source)
        yield from task_ids.dangling((*path, "to"), target)
        if not (isinstance(source, str) and isinstance(target, str)):
            continue
        if (source, target) in first:
            earlier = path_text(first[source, target])
            message = f"edge {source!r} -> {target!r} is given twice, first as {earlier}"
            yield Problem(path, message)
        first.setdefault((source, target), path)
    yield from _cycle(first)


def _cycle(edges: Mapping[tuple[str, str], Path]) -> Iterator[Problem]:
    """Yield one cycle, if there is any, at the edge that closes it."""
    tasks = find_cycle((task for ends in edges for task in ends), edges.keys())
    if tasks:
        path = max(edges[pair] for pair in pairwise(tasks))
        yield Problem(path, f"the edges form a cycle: {cycle_text(tasks)}")


def _unpinned(dags: list[tuple[Path, Row]]) -> Iterator[Problem]:
    for path, dag in dags:
        for task_path, task in rows(dag, (*path, "tasks"), start=len(path)):
            if "pinned_to" not in task:
                message = "scheduler manual needs pinned_to on every task"
                yield Problem(task_path, message, shown(task.get("id")))


def _link_model_problems(scenario: Row, config: Config, registry: Registry) -> Iterator[Problem]:
    name = config.components["link_model"].name
    is_radio = RADIO in registry.find("link_model", name).component.capabilities
    for path, link in rows(scenario, ("scenario", "network", "links")):
        if "bandwidth" in link:
            continue
        if name == "static":
            message = (
                "link model static needs a bandwidth, MB/s; give one, or choose a link_model that "
                f"derives it from positions{_radio_models(registry)}"
            )
            yield Problem(path, message)
        elif is_radio and link.get("medium") == "wired":
            yield Problem(path, "a wired link needs a bandwidth, MB/s", shown(link.get("id")))


def _position_problems(scenario: Row, config: Config, registry: Registry) -> Iterator[Problem]:
    """Yield nodes without the position that a wireless link of theirs needs."""
    radio, rival = (config.components[kind].name for kind in ("link_model", "interference_model"))
    is_radio = RADIO in registry.find("link_model", radio).component.capabilities
    is_heard = NEEDS_RADIO in registry.find("interference_model", rival).component.capabilities
    needs: dict[str, str] = {}
    for _, link in rows(scenario, ("scenario", "network", "links")):
        ends, name = [str(link.get(end)) for end in ("to", "from")], link.get("id")
        if link.get("medium") == "wired":
            continue
        if is_radio and "bandwidth" not in link:
            remedy = "give that link a bandwidth, MB/s" + ", and medium: wired" * is_heard
            need = f"link model {radio} derives the rate of link {name!r} from it; or {remedy}"
            needs |= dict.fromkeys(ends, need)
        elif is_heard:
            need = f"interference {rival} derives from it what link {name!r} hears; or mark that "
            needs |= dict.fromkeys(ends, need + "link medium: wired")
    for path, node in rows(scenario, ("scenario", "network", "nodes")):
        name = str(node.get("id"))
        if "position" not in node and name in needs:
            yield Problem(path, f"node {name!r} needs a position: {needs[name]}")


def _radio_models(registry: Registry) -> str:
    models = registry.components("link_model")
    names = [each.component.name for each in models if RADIO in each.component.capabilities]
    return f" ({', '.join(names)})" if names else ""
