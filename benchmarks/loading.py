"""How long it takes to load and check 10,000 tasks on a 20x20 grid, from YAML and from JSON.

    python benchmarks/loading.py [yaml|json|hash]

CPU seconds, medians of 5, in a process that has loaded a scenario before. ``hash``: of the
loaded scenario, as every trace has it.
"""

import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from ncsim_core.scenario.loader import load_scenario
from ncsim_core.scenario.model import Scenario
from timing import cpu_median_s
from workloads import layered_scenario

SIZE, TASKS = 20, 10_000


def main() -> None:
    """Measure what is asked for, or all."""
    scenario = layered_scenario(SIZE, TASKS)
    with tempfile.TemporaryDirectory() as folder:
        yaml, plain = Path(folder) / "large.yaml", Path(folder) / "large.json"
        yaml.write_text(scenario.to_yaml(), encoding="utf-8")
        plain.write_text(json.dumps(scenario.to_document()), encoding="utf-8")
        works: dict[str, Callable[[], object]] = {
            "yaml": lambda: load_scenario(yaml),
            "json": lambda: load_scenario(plain),
            "hash": lambda: _hash(scenario),
        }
        for name in sys.argv[1:] or works:
            print(f"{name} {cpu_median_s(works[name]):.4f} s", flush=True)


def _hash(scenario: Scenario) -> str:
    scenario.__dict__.pop("sha256", None)  # kept after the first time
    return scenario.sha256


if __name__ == "__main__":
    main()
