"""The same sweep on a real Dask cluster with worker processes of its own."""

import os
import subprocess
import sys

import pytest

pytest.importorskip("distributed", reason="needs distributed: pip install 'ncsim-core[dask]'")

SWEEP = """
sweep:
  base:
    network: {type: line, nodes: 3, bandwidth_MBps: 1}
    dags: {type: layered_random, layers: 3, width: 3}
    config: {scheduler: round_robin, routing: direct}
  vary:
    network.latency_s: [0, 0.5]
  replicate: {seeds: 20}
"""
SCRIPT = """
import sys
from distributed import LocalCluster
from ncsim_core.sweep.running import run_sweep

if __name__ == "__main__":
    plan, study = sys.argv[1:]
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        address = cluster.scheduler_address
        with run_sweep(plan, study, executor="dask", address=address) as remote:
            there = remote.table()
    with run_sweep(plan, executor="serial") as local:
        here = local.table()
    wall = here.columns.index("wall_s")
    drop = lambda t: [row[:wall] + row[wall + 1:] for row in t.rows]
    assert drop(there) == drop(here)
    statuses = {each["status"] for each in there.to_dicts()}
    print(len(there.rows), statuses)
"""


@pytest.mark.slow
def test_a_local_cluster_gives_what_this_process_gives(tmp_path):
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    (tmp_path / "script.py").write_text(SCRIPT)
    command = [sys.executable, "script.py", "sweep.yaml", "study"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=180,
        env=os.environ,
    )

    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("40 {'")
