"""What people install: wheels alone, in a clean environment, with and without a third party."""

import json
import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PACKAGES = ["ncsim-core", "ncsim-routing", "ncsim-saga", "ncsim-viz", "ncsim-wifi"]
THIRD_PARTY = ROOT / "examples" / "third-party"
UV = Path(sys.executable).with_name("uv")


def run(*command, **options):
    done = subprocess.run(
        [str(each) for each in command], capture_output=True, text=True, check=False, **options
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def builder(tmp_path_factory):
    """Return an installer that knows the wheels of this checkout."""
    if not UV.exists():
        pytest.skip("uv is not installed beside this Python")
    dist = tmp_path_factory.mktemp("dist")
    for package in PACKAGES:
        run(UV, "build", "--quiet", "--out-dir", dist, ROOT / package)
    run(UV, "build", "--quiet", "--wheel", "--out-dir", dist, THIRD_PARTY)
    return dist


@pytest.fixture(scope="module")
def clean(builder, tmp_path_factory):
    """Return the Python of a clean environment with core, wifi and routing from wheels."""
    place = tmp_path_factory.mktemp("clean")
    venv.create(place, with_pip=False)
    python = place / "bin" / "python"
    install(python, builder, "ncsim-core", "ncsim-wifi", "ncsim-routing")
    return python


def install(python, dist, *names):
    constraints = ROOT / "constraints.txt"
    wheels = [next(dist.glob(f"{name.replace('-', '_')}-*.whl")) for name in names]
    run(UV, "pip", "install", "--quiet", "--python", python, "-c", constraints, *wheels)


def ncsim(python, *arguments):
    clean_environment = {
        key: value for key, value in os.environ.items() if not key.startswith(("NCSIM", "PYTHON"))
    }
    return subprocess.run(
        [str(python.with_name("ncsim")), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        cwd="/",
        env=clean_environment,
    )


@pytest.mark.parametrize("package", PACKAGES)
def test_wheels_hold_their_data_and_no_tests(builder, package):
    names = zipfile.ZipFile(next(builder.glob(f"{package.replace('-', '_')}-*.whl"))).namelist()
    module = package.replace("-", "_")
    sources = {
        str(path.relative_to(ROOT / package / "src"))
        for path in (ROOT / package / "src").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }

    assert sources <= set(names)
    assert not any("tests/" in name or name.startswith("test_") for name in names)
    assert f"{module}/py.typed" in names
    assert any(name.endswith("licenses/LICENSE") for name in names)


@pytest.mark.parametrize("package", PACKAGES)
def test_source_distributions_are_built_too(builder, package):
    assert list(builder.glob(f"{package.replace('-', '_')}-*.tar.gz"))


def test_core_and_wifi_run_a_full_scenario_without_saga(clean):
    done = ncsim(clean, "run", ROOT / "examples" / "grid_4x4.yaml", "--scheduler", "round_robin")
    found = subprocess.run([str(clean), "-c", "import saga"], capture_output=True, check=False)

    assert done.returncode == 0, done.stderr
    assert "makespan   522.68" in done.stdout
    assert found.returncode != 0


def test_the_viewer_needs_core_only_and_neither_node_nor_matplotlib(clean, builder, tmp_path):
    install(clean, builder, "ncsim-viz")
    out, report = tmp_path / "out", tmp_path / "report.html"
    steps = [
        ncsim(clean, "run", ROOT / "examples" / "two_hop.yaml", "-o", out),
        ncsim(clean, "view", out, "-o", report),
        ncsim(clean, "view", out, "--terminal"),
    ]
    plotted = ncsim(clean, "plot", out, "--kind", "gantt", "-o", tmp_path / "gantt.svg")

    assert [step.returncode for step in steps] == [0, 0, 0], [step.stderr for step in steps]
    assert "<script" in report.read_text(encoding="utf-8")
    assert plotted.returncode == 1
    assert "figures need matplotlib: pip install" in plotted.stderr


def test_a_scheduler_that_is_not_installed_is_named_with_the_package_to_install(clean):
    done = ncsim(clean, "run", ROOT / "examples" / "grid_4x4.yaml")

    assert done.returncode == 1
    assert "pip install ncsim-saga" in done.stderr


def test_a_third_party_comes_and_goes(clean, builder):
    wheel = next(
        path
        for path in builder.glob("*.whl")
        if not any(path.name.startswith(name.replace("-", "_") + "-") for name in PACKAGES)
    )
    distribution = wheel.name.split("-")[0].replace("_", "-")
    run(UV, "pip", "install", "--quiet", "--python", clean, wheel)
    listed = ncsim(clean, "plugins", "list", "--json").stdout
    name = scheduler_of(listed, distribution)
    used = ncsim(clean, "run", ROOT / "examples" / "grid_4x4.yaml", "--scheduler", name)
    run(UV, "pip", "uninstall", "--quiet", "--python", clean, distribution)
    gone = ncsim(clean, "run", ROOT / "examples" / "grid_4x4.yaml", "--scheduler", name)

    assert used.returncode == 0, used.stderr
    assert gone.returncode == 1
    assert f"unknown scheduler '{name}'" in gone.stderr


def scheduler_of(listing, distribution):
    plugins = json.loads(listing)["plugins"]
    entry = next(each for each in plugins if each["distribution"] == distribution)
    return next(each["name"] for each in entry["components"] if each["kind"] == "scheduler")
