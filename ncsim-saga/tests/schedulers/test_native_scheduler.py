"""HEFT and CPOP as components: engines, pins left to others, nothing imported."""

import subprocess
import sys

import pytest
from ncsim_core.network import NodeId
from ncsim_core.testing.builders import diamond, line, make_context, make_snapshot
from ncsim_core.workflow import DAG
from ncsim_saga.schedulers import with_options

IMPORTED_BY_A_PLAN = """
import sys
from ncsim_core.testing.builders import diamond, line, make_context, make_snapshot
from ncsim_saga.schedulers import with_options
scheduler = with_options.{name}(make_context(line(3)))
scheduler.schedule(diamond(), make_snapshot(line(3)))
print([name for name in ("saga", "networkx", "pandas", "pysmt") if name in sys.modules])
"""


@pytest.mark.parametrize("name", ["heft", "cpop"])
class TestBoth:
    def test_planning_imports_no_saga(self, name):
        done = subprocess.run(
            [sys.executable, "-c", IMPORTED_BY_A_PLAN.format(name=name)],
            capture_output=True,
            text=True,
            check=True,
        )

        assert done.stdout.strip() == "[]"

    @pytest.mark.parametrize("engine", ["auto", "native", "saga"])
    def test_every_engine_plans_every_task_on_the_files_nodes(self, name, engine):
        network = line(3)
        scheduler = getattr(with_options, name)(make_context(network), engine=engine)

        nodes = scheduler.schedule(diamond(), make_snapshot(network)).nodes
        assert list(nodes) == [task.id for task in diamond().tasks]
        assert set(nodes.values()) <= {NodeId("n0"), NodeId("n1"), NodeId("n2")}

    @pytest.mark.parametrize("engine", ["native", "saga"])
    def test_a_dag_without_tasks_has_an_empty_plan(self, name, engine):
        scheduler = getattr(with_options, name)(make_context(line(2)), engine=engine)

        assert scheduler.schedule(DAG("none", (), ()), make_snapshot(line(2))).nodes == {}
