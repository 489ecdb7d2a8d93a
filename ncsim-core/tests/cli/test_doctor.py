"""``ncsim doctor``: what it finds, and what it says when something is wrong."""

import json

import pytest
from ncsim_core.cli import diagnosis
from ncsim_core.cli.main import main


def doctor(capsys, *options):
    with pytest.raises(SystemExit) as end:
        main(["doctor", *options])
    return end.value.code, capsys.readouterr().out


def findings(capsys):
    code, text = doctor(capsys, "--json")
    document = json.loads(text)
    assert document["ok"] == (code == 0)
    return code, {each["what"]: each for each in document["findings"]}


def test_a_sound_installation_gives_code_0_and_runs_appendix_b(capsys):
    code, text = doctor(capsys)

    assert code == 0
    assert "5 s, with 4 and 5 MB served, as printed" in text
    assert "two runs give the same bytes" in text
    assert "0 trouble" in text


def test_versions_of_packages_and_plugins_are_told(capsys):
    _, found = findings(capsys)

    assert {"python", "ncsim-core", "numpy", "pluggy", "plug-in ncsim-core"} <= found.keys()
    assert all(each["state"] != "trouble" for each in found.values())


def test_a_plugin_that_is_written_for_another_release_is_trouble(capsys, monkeypatch):
    needs = {"ncsim-core": ["ncsim-core>=5,<6", "ncsim-viz>=1; extra == 'x'"]}
    monkeypatch.setattr(diagnosis, "requires", lambda name: needs.get(name, []))

    code, found = findings(capsys)

    assert code == 1
    assert "needs ncsim-core<6,>=5 (have " in found["plug-in ncsim-core"]["text"]


def test_what_several_packages_need_is_told_once_and_must_suit_them_all(capsys, monkeypatch):
    needs = {"ncsim-core": ["numpy>=1"], "ncsim-wifi": ["numpy<1"]}
    monkeypatch.setattr(diagnosis, "requires", lambda name: needs.get(name, []))

    code, text = doctor(capsys)

    assert code == 1
    assert text.count("numpy ") == 1


@pytest.mark.parametrize(
    ("need", "says"),
    [("numpy>=99", "does not fit: numpy>=99"), ("no-such-thing", "not installed; needed")],
)
def test_a_package_that_is_missing_or_too_old_is_trouble(capsys, monkeypatch, need, says):
    monkeypatch.setattr(diagnosis, "requires", lambda _: [need])

    code, found = findings(capsys)

    assert code == 1
    assert says in found[need.partition(">")[0]]["text"]


def test_an_optional_package_that_is_missing_is_not_told(capsys, monkeypatch):
    monkeypatch.setattr(diagnosis, "requires", lambda _: ["no-such-thing; extra == 'dask'"])

    code, found = findings(capsys)

    assert code == 0
    assert "no-such-thing" not in found


def test_a_self_test_that_fails_is_trouble_and_says_why(capsys, monkeypatch):
    def wrong():
        raise ValueError("gives 4000000 us")

    monkeypatch.setitem(diagnosis.SELF_TESTS, "self-test: Appendix B", wrong)

    code, found = findings(capsys)

    assert code == 1
    assert found["self-test: Appendix B"]["text"] == "ValueError: gives 4000000 us"


def test_a_verb_that_cannot_be_imported_is_trouble(capsys, monkeypatch):
    class Broken:
        def load(self):
            raise ImportError("no module named matter")

    monkeypatch.setattr(diagnosis, "plugin_verbs", lambda: {"broken": Broken()})

    code, found = findings(capsys)

    assert code == 1
    assert found["verb broken"]["text"] == "ImportError: no module named matter"


def test_settings_in_the_environment_are_told(capsys, monkeypatch):
    monkeypatch.setenv("NCSIM_SPECIAL", "on")

    assert "environment: NCSIM_SPECIAL=on" in doctor(capsys)[1]
