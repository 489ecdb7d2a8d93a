"""What must hold for the repository as a whole."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ["ncsim-core", "ncsim-routing", "ncsim-saga", "ncsim-viz", "ncsim-wifi"]
HOSTS = re.compile(
    "|".join(["py" + "pi[.]org", "python" + "hosted", "npm" + "js[.]", "crates" + "[.]io"])
)


def project(package):
    return tomllib.loads((ROOT / package / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def tracked_files():
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip("no git checkout here")
    return [ROOT / name for name in listed.stdout.split("\0") if name]


@pytest.mark.parametrize("package", PACKAGES)
def test_each_package_carries_the_licence(package):
    assert (ROOT / package / "LICENSE").read_text() == (ROOT / "LICENSE").read_text()


def test_versions_agree():
    assert len({project(package)["version"] for package in PACKAGES}) == 1


@pytest.mark.parametrize("package", PACKAGES[1:])
def test_plug_in_packages_pin_the_core_they_were_made_for(package):
    major, minor, _ = project("ncsim-core")["version"].split(".")

    wanted = f"ncsim-core>={major}.{minor},<{major}.{int(minor) + 1}"
    assert wanted in project(package)["dependencies"]


def test_no_file_names_a_package_registry():
    named = [
        path.relative_to(ROOT)
        for path in tracked_files()
        if path.is_file() and HOSTS.search(path.read_text(encoding="utf-8", errors="ignore"))
    ]

    assert named == []


def test_importing_the_package_is_cheap():
    code = "import sys, ncsim_core; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )

    heavy = {"numpy", "networkx", "jsonschema", "yaml", "saga", "typer", "pluggy"}
    assert heavy & set(loaded.stdout.split()) == set()


@pytest.mark.parametrize("package", ["ncsim_core", "ncsim_routing", "ncsim_saga", "ncsim_wifi"])
def test_importing_a_declaration_imports_no_heavy_library(package):
    code = f"import sys, {package}.declaration; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )

    heavy = {"numpy", "networkx", "scipy", "pandas", "saga", "torch", "jsonschema"}
    assert heavy & set(loaded.stdout.split()) == set()


@pytest.mark.parametrize("heading", ["make run", "make test"])
def test_readme_opens_with_the_two_commands(heading):
    opening = (ROOT / "README.md").read_text(encoding="utf-8").split("## ")[0]

    assert f"\n{heading}" in opening
