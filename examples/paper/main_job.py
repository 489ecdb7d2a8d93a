"""The main job: one grid scenario in Solo and in Full, then the paper's 108-run study.

Run it with ``make run``. It needs no argument and leaves no file.
"""

import sys
import time
from itertools import product
from pathlib import Path
from statistics import fmean, median

from ncsim_core import simulate
from ncsim_core.cli.main import exit_code_of
from ncsim_core.cli.progress import ProgressLine
from ncsim_core.cli.run import run
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.metrics.statistics import is_rank_inversion, regret, winner_set
from ncsim_core.scenario.making import make_scenario

SCENARIO = Path(__file__).parents[1] / "grid_4x4.yaml"
GRIDS = (2, 3, 4)
TASKS = (5, 10, 20)
ROUTINGS = ("widest_path", "minimum_hop")
SCHEDULERS = ("heft", "cpop", "round_robin")
MODES = {"solo": "none", "full": "csma_bianchi"}
NICKNAMES = {"heft": "H", "cpop": "C", "round_robin": "R"}
RUNS = len(GRIDS) * len(TASKS) * len(ROUTINGS) * len(SCHEDULERS) * len(MODES)

Triple = tuple[int, int, str]
Makespans = dict[str, dict[str, float | None]]


def say(text: str = "") -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")


def example() -> int:
    """Run the example scenario as ``ncsim run`` does, Solo then Full; return the exit code."""
    for mode, interference in MODES.items():
        say(f"$ ncsim run examples/{SCENARIO.name} --interference {interference}     # {mode}")
        code = exit_code_of(lambda name=interference: run(str(SCENARIO), interference=name))
        if code:
            return code
        say()
    return 0


def study() -> dict[Triple, Makespans]:
    """Run the factorial: by (grid, tasks, routing), the makespan of each mode and scheduler."""
    line = ProgressLine()
    began_s = time.monotonic()
    makespans: dict[Triple, Makespans] = {}
    triples = product(GRIDS, TASKS, ROUTINGS)
    for number, (grid, tasks, routing) in enumerate(triples):
        done = number * len(SCHEDULERS) * len(MODES)
        line.show(f"study: {done} of {RUNS} runs, {time.monotonic() - began_s:.1f} s")
        makespans[grid, tasks, routing] = {
            mode: {
                scheduler: makespan_s(grid, tasks, routing, scheduler, interference)
                for scheduler in SCHEDULERS
            }
            for mode, interference in MODES.items()
        }
    line.clear()
    return makespans


def makespan_s(
    grid: int, tasks: int, routing: str, scheduler: str, interference: str
) -> float | None:
    """Return the makespan of one run of the study."""
    config = {
        "scheduler": scheduler,
        "routing": routing,
        "link_model": "wifi",
        "interference": interference,
    }
    scenario = make_scenario("study", paper_grid(grid), [paper_dag(tasks)], config)
    return simulate(scenario).makespan_s


def report(makespans: dict[Triple, Makespans]) -> None:
    """Print a row per triple and the summary."""
    say(f"Makespans in seconds of {RUNS} runs; H is heft, C cpop, R round_robin")
    say("                             ---------- Solo ----------  ---------- Full ----------")
    say("grid tasks routing           H        C        R    wins  H        C        R    wins  "
        "inversion  regret")  # fmt: skip
    regrets = []
    inversions = 0
    for (grid, tasks, routing), by_mode in makespans.items():
        solo_s, full_s = by_mode["solo"], by_mode["full"]
        loss = regret(solo_s, full_s)
        inverted = is_rank_inversion(solo_s, full_s)
        inversions += bool(inverted)
        regrets.append(loss if loss is not None else float("nan"))
        say(
            f"{grid}x{grid} {tasks:5d} {routing:12s} {mode_columns(solo_s)}  {mode_columns(full_s)}"
            f"   {'yes' if inverted else 'no ':9s} {regrets[-1]:6.1%}"
        )
    say()
    say(
        f"Rank inversions: {inversions} of {len(makespans)}. Regret: mean {fmean(regrets):.1%}, "
        f"median {median(regrets):.1%}, maximum {max(regrets):.1%}."
    )


def mode_columns(makespans_s: dict[str, float | None]) -> str:
    """Return the three makespans of a mode and who wins."""
    numbers = " ".join(
        f"{'-' if value is None else format(value, '.2f'):>8s}" for value in makespans_s.values()
    )
    winners = "/".join(NICKNAMES[name] for name in winner_set(makespans_s))
    return f"{numbers}  {winners:5s}"


def main() -> None:
    """Run the example, then the study."""
    code = example()
    if code:
        sys.exit(code)
    report(study())


if __name__ == "__main__":
    main()
