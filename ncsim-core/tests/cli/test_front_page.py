"""The page that is printed without the parser says what the parser would say."""

import pytest
from ncsim_core import __version__
from ncsim_core.cli.front_page import VERBS, WIDTH, front_page, plugin_verbs
from ncsim_core.cli.main import main
from ncsim_core.cli.verbs import app
from typer.testing import CliRunner


def code_of(*args):
    with pytest.raises(SystemExit) as stop:
        main(list(args))
    return stop.value.code


def test_the_front_page_is_the_one_that_the_parser_prints():
    printed = CliRunner().invoke(app, ["--help"], prog_name="ncsim", terminal_width=WIDTH)

    assert printed.stdout.rstrip("\n") == front_page()


def test_no_line_of_the_front_page_is_wider_than_a_terminal():
    assert max(map(len, front_page().splitlines())) <= 80


def test_help_and_version_go_to_stdout_and_end_well(capsys):
    assert code_of("--help") == 0
    assert capsys.readouterr().out.startswith("Usage: ncsim")
    assert code_of("--version") == 0
    assert capsys.readouterr().out == f"ncsim-core {__version__}\n"


def test_without_a_verb_the_front_page_goes_to_stderr_as_an_error(capsys):
    assert code_of() == 1
    assert capsys.readouterr().err.startswith("Usage: ncsim")


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_of_the_table_is_there_and_explains_itself(name):
    explained = CliRunner().invoke(app, [name, "--help"], prog_name="ncsim")

    assert explained.exit_code == 0
    assert explained.stdout.startswith(f"Usage: ncsim {name} ")


def test_an_interrupted_verb_says_that_nothing_was_written(monkeypatch, capsys):
    def interrupted(*_args, **_more):
        raise KeyboardInterrupt

    monkeypatch.setattr("ncsim_core.scenario.loader.load_scenario", interrupted)

    assert code_of("new", "x.yaml", "--link", "y.yaml", "--range", "3") == 130
    assert capsys.readouterr().err == "interrupted; nothing was written\n"


def test_a_misspelt_verb_gets_a_suggestion(capsys):
    assert code_of("valdate") == 1
    assert "Did you mean 'validate'" in capsys.readouterr().err


def test_a_verb_of_a_package_that_is_not_installed_names_the_package(monkeypatch, capsys):
    monkeypatch.setattr("ncsim_core.cli.front_page.entry_points", lambda **_: [])

    assert code_of("view", "out/") == 1
    assert "ncsim view comes with ncsim-viz: pip install ncsim-viz" in capsys.readouterr().err


def test_a_package_cannot_take_a_verb_of_ncsims_own(monkeypatch):
    class Intruder:
        name = "run"

    monkeypatch.setattr("ncsim_core.cli.front_page.entry_points", lambda **_: [Intruder()])

    assert plugin_verbs() == {}
