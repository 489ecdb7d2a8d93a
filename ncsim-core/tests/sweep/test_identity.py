"""Results of other software are not reused: versions, requirements, edited working copies."""

import json

import pytest
from ncsim_core.registry import get_registry
from ncsim_core.sweep.identity import software
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.testing.fixtures import DECLARATION, fake_dist

__all__ = ["fake_dist"]

PLANNER = (
    DECLARATION
    + """
from ncsim_core.builtin.schedulers import RoundRobinScheduler


@hookimpl
def ncsim_components():
    return [Component("scheduler", "mine", "mine:Mine", "Mine.")]


class Mine(RoundRobinScheduler):
    pass
"""
)


@pytest.fixture(autouse=True)
def nothing_known():
    software.cache_clear()
    yield
    software.cache_clear()


def key():
    software.cache_clear()
    get_registry.cache_clear()
    base = {
        "network": {"type": "line", "nodes": 2, "bandwidth_MBps": 1},
        "dags": {"type": "chain", "tasks": 2},
        "config": {"scheduler": "mine"},
    }
    plan = load_sweep({"sweep": {"base": base}})
    return Resolver(plan).key(next(plan.runs()))


def metadata(folder, text):
    (folder / "mine-1.0.dist-info" / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: mine\n{text}\n"
    )
    software.cache_clear()


def test_another_version_of_a_plugin_gives_other_results(fake_dist):
    folder = fake_dist("mine", {"mine": PLANNER})
    before = key()
    assert key() == before
    metadata(folder, "Version: 1.1")

    assert key() != before


def test_another_version_of_what_a_plugin_needs_does_so_too(fake_dist):
    folder = fake_dist("mine", {"mine": PLANNER})
    before = key()
    metadata(folder, "Version: 1.0\nRequires-Dist: pluggy>=1\nRequires-Dist: typer; extra == 'x'")

    assert "pluggy==" in software("mine", ("mine",))
    assert "typer" not in software("mine", ("mine",))
    assert key() != before


def test_an_edited_working_copy_gives_other_results(fake_dist):
    folder = fake_dist(
        "mine", {"mine/__init__.py": PLANNER, "mine/rules.csv": "a"}, entry_points={"mine": "mine"}
    )
    url = {"url": f"file://{folder}", "dir_info": {"editable": True}}
    (folder / "mine-1.0.dist-info" / "direct_url.json").write_text(json.dumps(url))
    before = key()
    assert key() == before
    (folder / "mine" / "rules.csv").write_text("b")

    assert key() != before


def test_a_package_that_is_not_installed_counts_by_its_name():
    assert software("no-such-package", ("no_such_package",)) == "no-such-package"
