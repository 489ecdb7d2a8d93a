"""Networks and DAGs from the registered generators, made in a process with limits.

A parameter too many zeros long must cost nobody his viewer.
"""

import contextlib
import json
import sys
from collections.abc import Mapping
from typing import Any, Final, cast

from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.model import DEFAULT_SEED, Scenario
from ncsim_core.scenario.yaml_text import dump_yaml
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver

from ncsim_viz.server.child import Limits
from ncsim_viz.server.errors import RequestError, bad
from ncsim_viz.server.processes import LimitedProcess
from ncsim_viz.server.scenarios import Document, fault_row

LIMITS: Final = Limits(wall_s=20.0, memory_MB=2000, output_MB=50)
ENTRY: Final = "ncsim_viz.server.presets:main"
RADIO: Final = {"link_model": "wifi"}
PARTS: Final = ("network", "dags")
MAX_REQUEST_CHARACTERS: Final = 20_000


def preset(request: Mapping[str, Any]) -> Document:
    """Return what two generators make, as ``generated`` does, within limits.

    Raises:
        RequestError: A parameter is wrong, or what it asks for is too large.
    """
    _expect_generators(request)
    text = json.dumps(request)
    if len(text) > MAX_REQUEST_CHARACTERS:
        raise bad("these parameters are too long")
    process = LimitedProcess(LIMITS, ENTRY, text)
    try:
        if process.wait() != 0:
            raise bad("too large for the form; generate it with a sweep file")
        answer = json.loads(process.answer())
    finally:
        process.close()
    if "error" in answer:
        raise bad(answer["error"], answer["more"])
    return cast("Document", answer)


def main() -> None:
    """Print as JSON what the request in the first argument asks for."""
    try:
        answer = generated(json.loads(sys.argv[1]))
    except RequestError as error:
        answer = {"error": str(error), "more": error.more}
    sys.stdout.write(json.dumps(answer))


def generated(request: Mapping[str, Any]) -> Document:
    """Return the network and DAGs that two generators make, as a scenario without config.

    Args:
        request: As ``preset`` lets it pass.

    Raises:
        RequestError: A parameter is unknown, missing or out of range; all faults are listed.
    """
    parts = {name: request[name] for name in PARTS}
    seed = request.get("seed", DEFAULT_SEED)
    try:
        scenario = _made(parts, seed)
    except ScenarioFaults as error:
        faults = [_in_request(fault_row(each)) for each in error.to_json()]
        raise bad("the generators refuse these parameters", {"faults": faults}) from error
    rows = scenario.to_document()["scenario"]
    assert isinstance(rows, dict)
    rows["name"] = " on ".join(str(parts[name]["type"]) for name in ("dags", "network"))
    del rows["config"]
    document = {"scenario": rows}
    return {"yaml": dump_yaml(document), "document": document}


def _made(parts: Mapping[str, Any], seed: int) -> Scenario:
    """Return what generators make; where links lack a bandwidth, for a radio that derives it."""

    def made(base: Mapping[str, Any]) -> Scenario:
        plan = load_sweep({"sweep": {"base": base, "replicate": {"seeds": [seed]}}})
        return Resolver(plan).scenario(next(plan.runs()))

    try:
        return made(parts)
    except ScenarioFaults:
        with contextlib.suppress(ScenarioFaults):
            return made({**parts, "config": RADIO})
        raise


def _in_request(fault: Document) -> Document:
    """Return a fault of the sweep that was made of a request as one of the request."""
    pointer = str(fault["pointer"]).removeprefix("/sweep/base")
    return fault | {"pointer": pointer, "path": str(fault["path"]).removeprefix("sweep.base.")}


def _expect_generators(request: Mapping[str, Any]) -> None:
    is_whole = all(_is_generator(request.get(name)) for name in PARTS)
    if not is_whole or not _is_seed(request.get("seed", DEFAULT_SEED)):
        raise bad('give {"network": {"type": ...}, "dags": {"type": ...}, "seed": 42}')


def _is_generator(part: object) -> bool:
    """Return whether a part names a generator; a file would be read from anywhere."""
    return isinstance(part, dict) and "type" in part and "file" not in part


def _is_seed(seed: object) -> bool:
    return isinstance(seed, int) and not isinstance(seed, bool) and seed >= 0
