"""Scenario files of the published ncsim, put into today's form with a note for each change.

They are recognised by a missing ``scenario:`` root or by a config key of their own. Unknown keys
stay faults.

================================  =============================================================
published                         today
================================  =============================================================
``interference: raw_phy``         ``link_model`` wifi (``rate: raw_phy``), ``interference: none``
``interference: solo_80211``      ``link_model`` wifi (``rate: solo``), ``interference: none``
``interference: full_wireless``   ``link_model`` wifi (``rate: solo``), csma_bianchi
``scheduler_options: {...}``      ``scheduler: {type: ..., options: {...}}``
``hidden_terminal_model: x``      option ``hidden_model: x`` of csma_bianchi
``interference_radius: r``        option ``radius: r`` of proximity
no ``interference``               proximity with radius 15 m, the published default
numbers as ids                    text
no ``position``                   (0, 0), if the interference model needs positions
================================  =============================================================
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ncsim_core.registry import Registry
from ncsim_core.scenario.explain import CONFIG
from ncsim_core.scenario.faults import Data, Path, Problem, original_path
from ncsim_core.scenario.resolution import component_name, default_name

PUBLISHED_RADIUS_m = 15.0
"""Default ``interference_radius`` of the published ncsim."""

MODES: Mapping[str, tuple[str, str]] = {
    "raw_phy": ("raw_phy", "none"),
    "solo_80211": ("solo", "none"),
    "full_wireless": ("solo", "csma_bianchi"),
}
"""Published mode -> rate of link model wifi, interference model."""

PUBLISHED_KEYS = ("scheduler_options", "hidden_terminal_model", "interference_radius")

_WIFI, _BIANCHI, _PROXIMITY = "wifi", "csma_bianchi", "proximity"
_NEED_POSITIONS = frozenset({_PROXIMITY, _BIANCHI, "csma_clique", *MODES})
_ROOT_KEYS = frozenset({"network", "dags"})
_ID_KEYS = ("id", "from", "to", "pinned_to")


@dataclass(frozen=True)
class Translation:
    """A document in today's form.

    Args:
        document: The document; parts that needed no change are shared with the original.
        notes: What was changed, for the user.
        moved: By path in ``document``, the path in the original that it was taken from.
        problems: What could not be translated.
    """

    document: Data
    notes: tuple[str, ...] = ()
    moved: Mapping[Path, Path] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()


def translated(document: Data, registry: Registry) -> Translation:
    """Return a file's document in today's form; one that is in today's form is left as it is."""
    work = _Work(document, registry)
    if work.is_published():
        work.write_ids_as_text()
        work.write_default_interference()
        work.write_positions()
    else:
        work.note_default_interference()
    return work.done()


def translated_config(earlier: Translation, document: Data, registry: Registry) -> Translation:
    """Return ``earlier`` with overrides applied, as ``document``, in today's form too."""
    return _Work(document, registry, earlier).done()


class _Work:
    """A translation on its way; only rows that are changed are copied."""

    def __init__(
        self, document: Data, registry: Registry, earlier: Translation | None = None
    ) -> None:
        self._registry = registry
        self._notes = list(earlier.notes) if earlier else []
        self._moved = dict(earlier.moved) if earlier else {}
        self._problems = list(earlier.problems) if earlier else []
        self._document = self._with_root(document)
        scenario = self._document.get("scenario") if isinstance(self._document, dict) else None
        self._scenario: dict[str, Any] = dict(scenario) if isinstance(scenario, dict) else {}
        config = self._scenario.get("config")
        self._config: dict[str, Any] = dict(config) if isinstance(config, dict) else {}
        self._is_readable = isinstance(scenario, dict) and isinstance(config, dict | None)

    def is_published(self) -> bool:
        has_own_keys = any(key in self._config for key in PUBLISHED_KEYS)
        return self._is_readable and bool(
            self._notes or has_own_keys or self._config.get("interference") in list(MODES)
        )

    def done(self) -> Translation:
        if self._is_readable:
            self._translate_config()
            scenario = dict(self._scenario)
            if self._config or "config" in scenario:
                scenario["config"] = self._config
            self._document = {**self._document, "scenario": scenario}
        return Translation(self._document, tuple(self._notes), self._moved, tuple(self._problems))

    def _with_root(self, document: Data) -> Data:
        if not isinstance(document, dict) or "scenario" in document:
            return document
        if not _ROOT_KEYS & document.keys():
            return document
        self._notes.append("there is no 'scenario:' root; the whole file is read as the scenario")
        self._moved[("scenario",)] = ()
        return {"scenario": document}

    def write_ids_as_text(self) -> None:
        """Put numbers that serve as ids into text, as the published loader did."""
        changed: list[str] = []
        network = self._scenario.get("network")
        if isinstance(network, dict):
            self._scenario["network"] = {
                key: _rows_with_text_ids(rows, changed) if key in ("nodes", "links") else rows
                for key, rows in network.items()
            }
        dags = _rows_with_text_ids(self._scenario.get("dags"), changed)
        if isinstance(dags, list):
            self._scenario["dags"] = [_dag_with_text_ids(dag, changed) for dag in dags]
        if changed:
            listed = ", ".join(dict.fromkeys(changed))
            self._notes.append(f"numbers as ids are read as text: {listed}")

    def write_default_interference(self) -> None:
        """Choose what the published ncsim chose when the file names no interference model."""
        if "interference" in self._config:
            return
        radius = self._config.get("interference_radius", PUBLISHED_RADIUS_m)
        if _PROXIMITY in self._registry.spellings("interference_model"):
            self._config["interference"] = {"type": _PROXIMITY, "options": {"radius": radius}}
            note = f"taken as proximity with radius {radius} m, the published default"
        else:
            self._config["interference"] = "none"
            note = (
                f"the published default, proximity with radius {radius} m, is not installed; "
                "taken as none"
            )
        self._notes.append(f"config.interference is not given: {note}")
        self._config.pop("interference_radius", None)

    def note_default_interference(self) -> None:
        """Say what the published ncsim chose, of a file that may have been written for it.

        Nothing tells such a file from one in today's form: a root, nodes with positions, links
        with bandwidths, and neither an interference nor a link model.
        """
        network = self._scenario.get("network")
        if not self._is_readable or not isinstance(network, dict):
            return
        nodes, links = network.get("nodes"), network.get("links")
        is_silent = not {"interference", "link_model", "rf"} & self._config.keys()
        if is_silent and _all_have(nodes, "position") and _all_have(links, "bandwidth"):
            self._notes.append(
                "config.interference is not given: taken as none; the published ncsim took "
                f"proximity with radius {PUBLISHED_RADIUS_m} m"
            )

    def write_positions(self) -> None:
        """Put nodes without position at (0, 0) where the interference model needs positions."""
        network = self._scenario.get("network")
        nodes = network.get("nodes") if isinstance(network, dict) else None
        name = component_name(self._config.get("interference"))
        if not isinstance(network, dict) or not isinstance(nodes, list):
            return
        bare = [node for node in nodes if isinstance(node, dict) and "position" not in node]
        if not bare or name not in _NEED_POSITIONS:
            return
        placed = [
            {**node, "position": {"x": 0.0, "y": 0.0}} if node in bare else node for node in nodes
        ]
        self._scenario["network"] = {**network, "nodes": placed}
        listed = ", ".join(str(node.get("id")) for node in bare)
        self._notes.append(f"nodes without position are put at (0, 0): {listed}")

    def _translate_config(self) -> None:
        self._translate_mode()
        self._translate_scheduler_options()
        self._translate_option("hidden_terminal_model", _BIANCHI, "hidden_model")
        self._translate_option("interference_radius", _PROXIMITY, "radius")

    def _translate_mode(self) -> None:
        mode = self._config.get("interference")
        if not isinstance(mode, str) or mode not in MODES:
            return
        rate, interference = MODES[mode]
        old = self._config.get("link_model")
        if component_name(old) not in (None, _WIFI):
            message = f"{mode} is link model {_WIFI} with rate {rate}; leave link_model out"
            self._problems.append(Problem((*CONFIG, "interference"), message, mode))
            return
        options = old.get("options", {}) if isinstance(old, dict) else {}
        self._config["link_model"] = {"type": _WIFI, "options": {**options, "rate": rate}}
        self._config["interference"] = interference
        if old is None:
            self._move(("link_model",), ("interference",))
        self._notes.append(
            f"config.interference: {mode} is read as link_model {_WIFI} (rate: {rate}) "
            f"with interference {interference}"
        )

    def _translate_scheduler_options(self) -> None:
        flat = self._config.get("scheduler_options")
        if not isinstance(flat, dict):
            return  # a fault of its own: an unknown key, or options that are no mapping
        del self._config["scheduler_options"]
        row = self._config.get("scheduler")
        name = component_name(row) or default_name("scheduler", {}, 1, self._registry)
        inner = row.get("options", {}) if isinstance(row, dict) else {}
        self._config["scheduler"] = {"type": name, "options": {**flat, **inner}}
        for key in flat.keys() - inner.keys():
            self._move(("scheduler", "options", key), ("scheduler_options", key))
        self._notes.append(f"config.scheduler_options is read as the options of scheduler {name}")

    def _translate_option(self, key: str, owner: str, option: str) -> None:
        """Move a key of the config into the options of the interference model it is for."""
        if key not in self._config:
            return
        value = self._config.pop(key)
        row = self._config.get("interference")
        name = component_name(row)
        if name != owner:
            self._notes.append(f"config.{key} has no effect with interference {name}; left out")
            return
        inner = row.get("options", {}) if isinstance(row, dict) else {}
        self._config["interference"] = {"type": owner, "options": {option: value, **inner}}
        self._move(("interference", "options", option), (key,))
        self._notes.append(f"config.{key} is read as option {option} of interference {owner}")

    def _move(self, new: Path, old: Path) -> None:
        """Note that ``new`` in the config was taken from ``old`` in the config."""
        self._moved[(*CONFIG, *new)] = original_path((*CONFIG, *old), self._moved)


def _all_have(rows: Data, key: str) -> bool:
    return isinstance(rows, list) and all(isinstance(row, dict) and key in row for row in rows)


def _dag_with_text_ids(dag: Data, changed: list[str]) -> Data:
    if not isinstance(dag, dict):
        return dag
    return {
        key: _rows_with_text_ids(rows, changed) if key in ("tasks", "edges") else rows
        for key, rows in dag.items()
    }


def _rows_with_text_ids(rows: Data, changed: list[str]) -> Data:
    if not isinstance(rows, list):
        return rows
    return [_row_with_text_ids(row, changed) for row in rows]


def _row_with_text_ids(row: Data, changed: list[str]) -> Data:
    if not isinstance(row, dict):
        return row
    numbers = {key: str(row[key]) for key in _ID_KEYS if type(row.get(key)) in (int, float)}
    changed += numbers.values()
    return {**row, **numbers} if numbers else row
