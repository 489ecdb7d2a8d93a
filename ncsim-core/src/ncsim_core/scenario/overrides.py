"""Values under ``config`` replaced from outside: the command line, a sweep, Python."""

from collections.abc import Mapping
from typing import Any

from ncsim_core.errors import PluginError
from ncsim_core.plugins import KINDS
from ncsim_core.registry import Registry
from ncsim_core.scenario.explain import CONFIG, KIND_BY_CONFIG_KEY
from ncsim_core.scenario.faults import Data, Path
from ncsim_core.scenario.resolution import Undecided, component_name, default_name, wants_radio

_LINK_MODEL = KINDS["link_model"].config_key
_INTERFERENCE = KINDS["interference_model"].config_key


def override_path(dotted: str) -> Path:
    """Return where a dotted override such as ``rf.tx_power_dBm`` points in a document."""
    return (*CONFIG, *dotted.split("."))


def with_overrides(document: Data, overrides: Mapping[str, object], registry: Registry) -> Data:
    """Return a copy of ``document`` with values under ``config`` replaced.

    ``scheduler`` replaces name and options alike, ``scheduler.options.x`` one option. A document
    that is no scenario at all comes back as it is; its faults are found later.
    """
    scenario = document.get("scenario") if isinstance(document, dict) else None
    if not overrides or not isinstance(scenario, dict):
        return document
    config = scenario.get("config")
    if not isinstance(config, dict | None):
        return document
    dags = scenario.get("dags")
    dag_count = len(dags) if isinstance(dags, list) else 0
    rows = _with_link_model_kept(dict(config or {}), overrides, registry)
    for dotted in sorted(overrides, key=lambda each: each.count(".")):
        rows = _with_value(rows, dotted, overrides[dotted], dag_count, registry)
    return {**document, "scenario": {**scenario, "config": rows}}


def _with_link_model_kept(
    rows: dict[str, Any], overrides: Mapping[str, object], registry: Registry
) -> dict[str, Any]:
    """Write the scenario's radio link model out before its interference model goes.

    The rates of the links are thus the same with and without interference: what
    ``interference=none`` makes of Full is Solo.
    """
    if _INTERFERENCE not in overrides or _LINK_MODEL in rows or _LINK_MODEL in overrides:
        return rows
    name = component_name(rows.get(_INTERFERENCE))
    known = registry.spellings("interference_model")
    if (name is None or name in known) and wants_radio(rows, registry):
        link_model = _default_or_none("link_model", rows, 1, registry)
        return {**rows, _LINK_MODEL: link_model} if link_model else rows
    return rows


def _default_or_none(
    kind: str, rows: Mapping[str, Any], dag_count: int, registry: Registry
) -> str | None:
    """Return the default component, or ``None`` where a fault is about to say why there is none."""
    try:
        return default_name(kind, rows, dag_count, registry)
    except (PluginError, Undecided):
        return None


def _with_value(
    rows: dict[str, Any], dotted: str, value: object, dag_count: int, registry: Registry
) -> dict[str, Any]:
    key, *inner = dotted.split(".")
    if not inner:
        return {**rows, key: value}
    row = rows.get(key)
    kind = KIND_BY_CONFIG_KEY.get(key)
    if kind is not None and not isinstance(row, dict):
        name = component_name(row) or _default_or_none(kind, rows, dag_count, registry)
        row = {"type": name} if name else {}
    return {**rows, key: _nested(row, inner, value)}


def _nested(row: object, steps: list[str], value: object) -> dict[str, Any]:
    old = row if isinstance(row, dict) else {}
    if len(steps) == 1:
        return {**old, steps[0]: value}
    return {**old, steps[0]: _nested(old.get(steps[0]), steps[1:], value)}
