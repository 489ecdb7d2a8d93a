"""A broken plug-in breaks nothing else, and its reason is told."""

import pytest
from ncsim_core.errors import PluginError, UnknownComponentError
from ncsim_core.registry import PluginRecord, Registry, load_registry
from ncsim_core.testing.fixtures import DECLARATION, FakeDist

GOOD = """
@hookimpl
def ncsim_components():
    return [Component("scheduler", "good", "good_code:make", "A scheduler.")]
"""

BROKEN = {
    "import error": ("import no_such_module_at_all", "no_such_module_at_all"),
    "raises at import": ("raise RuntimeError('out of order')", "RuntimeError: out of order"),
    "exits at import": ("import sys; sys.exit(3)", "SystemExit: 3"),
    "syntax error": ("def broken(:", "SyntaxError"),
    "misspelt hook": (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_componets():\n    return []",
        "ncsim_componets",
    ),
    "hook without mark": (f"{DECLARATION}\ndef ncsim_components():\n    return []", "@hookimpl"),
    "hook with unknown argument": (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_run_started(run, clock):\n    pass",
        "clock",
    ),
    "hook raises": (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    1 / 0",
        "ZeroDivision",
    ),
    "no list": (f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    return 3", "gave 3"),
    "no component": (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    return ['heft']",
        "not a Component",
    ),
    "no section": (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_sections():\n    return ['rf']",
        "not a Section",
    ),
}


def closed_schema(properties: dict[str, object]) -> dict[str, object]:
    return {"type": "object", "additionalProperties": False, "properties": properties}


BAD_COMPONENTS = {
    "unknown kind": ('"sheduler", "x", "m:f", ""', "unknown kind"),
    "bad name": ('"scheduler", "My-Model", "m:f", ""', "lower-case"),
    "bad factory": ('"scheduler", "x", "m.f", ""', "package.module:callable"),
    "bad requirement": ('"scheduler", "x", "m:f", "", requires=(">>2",)', "requires"),
    "schema of no object": ('"scheduler", "x", "m:f", "", {"type": "string"}', "object"),
    "open schema": ('"scheduler", "x", "m:f", "", {"type": "object"}', "additionalProperties"),
    "schema file missing": ('"scheduler", "x", "m:f", "", "bad_dist:a.json"', "cannot read"),
    "reference in schema": (
        f'"scheduler", "x", "m:f", "", {closed_schema({"k": {"$ref": "#/x"}})}',
        "'$ref' is outside the portable subset",
    ),
    "unknown type in schema": (
        f'"scheduler", "x", "m:f", "", {closed_schema({"k": {"type": "nuber"}})}',
        "'nuber' does not fit",
    ),
}


def declaring(*components: str) -> str:
    listed = ", ".join(f"Component({each})" for each in components)
    return f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    return [{listed}]\n"


def record_of(registry: Registry, distribution: str) -> PluginRecord:
    return next(each for each in registry.plugins if each.distribution == distribution)


def assert_only_that_one_is_broken(registry: Registry, detail: str, status: str = "failed"):
    record = record_of(registry, "bad-dist")
    assert (record.status, detail in record.detail) == (status, True), record
    assert record_of(registry, "ncsim-core").status == "ok"
    assert record_of(registry, "good-dist").status == "ok"
    assert "good" in registry.names("scheduler")
    assert all(each.distribution != "bad-dist" for each in registry.components("scheduler"))


@pytest.fixture
def good_dist(fake_dist: FakeDist) -> None:
    fake_dist("good-dist", {"good_declaration": DECLARATION + GOOD})


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_declaration_module_breaks_nothing_else(fault, good_dist, fake_dist):
    source, detail = BROKEN[fault]
    fake_dist("bad-dist", {"bad_declaration": source})

    assert_only_that_one_is_broken(load_registry(), detail)


@pytest.mark.parametrize("fault", BAD_COMPONENTS)
def test_malformed_component_breaks_nothing_else(fault, good_dist, fake_dist):
    arguments, detail = BAD_COMPONENTS[fault]
    fake_dist("bad-dist", {"bad_declaration": declaring(arguments)})

    assert_only_that_one_is_broken(load_registry(), detail)


@pytest.mark.parametrize(
    ("api", "detail"),
    [
        ('NCSIM_PLUGIN_API = "2.0"', "offers 1.0"),
        ('NCSIM_PLUGIN_API = "1.99"', "offers 1.0"),
        ("NCSIM_PLUGIN_API = 'one'", 'write it as "1.0"'),
        ("", "sets no NCSIM_PLUGIN_API"),
    ],
)
def test_plugin_for_another_api_is_incompatible(api, detail, good_dist, fake_dist):
    fake_dist("bad-dist", {"bad_declaration": api})

    assert_only_that_one_is_broken(load_registry(), detail, "incompatible")


def test_name_declared_twice_in_one_distribution_is_a_fault(good_dist, fake_dist):
    twice = '"scheduler", "x", "m:f", ""'
    fake_dist("bad-dist", {"bad_declaration": declaring(twice, twice)})

    assert_only_that_one_is_broken(load_registry(), "'x' twice")


def test_second_entry_point_may_not_repeat_a_name(fake_dist):
    source = declaring('"scheduler", "x", "m:f", ""')
    fake_dist("two", {"two_a": source, "two_b": source}, entry_points={"a": "two_a", "b": "two_b"})

    registry = load_registry()

    states = [each.status for each in registry.plugins if each.distribution == "two"]
    assert states == ["ok", "failed"]
    assert registry.find("scheduler", "x").distribution == "two"


def test_missing_declaration_module_is_told(good_dist, fake_dist):
    fake_dist("bad-dist", {}, entry_points={"bad": "no_such_declaration"})

    assert_only_that_one_is_broken(load_registry(), "no_such_declaration")


@pytest.mark.parametrize("name", ["scheduler", "seed", "routing"])
def test_section_may_not_take_a_key_of_ncsim(name, good_dist, fake_dist):
    fake_dist("bad-dist", {"bad_declaration": sections(name)})

    assert_only_that_one_is_broken(load_registry(), "config key of ncsim")


def test_section_of_a_well_known_owner_is_not_taken(good_dist, fake_dist):
    fake_dist("bad-dist", {"bad_declaration": sections("rf")})

    assert_only_that_one_is_broken(load_registry(), "belongs to ncsim-wifi")


def test_section_claimed_twice_stays_with_the_first(fake_dist):
    fake_dist("a-dist", {"a_declaration": sections("sea_state")})
    fake_dist("b-dist", {"b_declaration": sections("sea_state")})

    registry = load_registry()

    owners = [each.distribution for each in registry.sections() if each.section.name == "sea_state"]
    assert owners == ["a-dist"]
    assert record_of(registry, "b-dist").detail == "section 'sea_state' is taken by a-dist"


def sections(name: str) -> str:
    schema = '{"type": "object", "additionalProperties": False}'
    return (
        f"{DECLARATION}\n@hookimpl\ndef ncsim_sections():\n"
        f'    return [Section("{name}", "One line.", {schema})]\n'
    )


def test_strict_mode_raises_and_names_the_plugin(fake_dist):
    fake_dist("bad-dist", {"bad_declaration": "1 / 0"}, version="3.1")

    with pytest.raises(PluginError, match=r"bad-dist 3\.1 is failed: ZeroDivisionError"):
        load_registry({"NCSIM_STRICT_PLUGINS": "1"})


def test_disabled_plugin_is_not_imported(fake_dist):
    fake_dist("Bad_Dist", {"bad_declaration": "1 / 0"})

    registry = load_registry({"NCSIM_DISABLE_PLUGINS": "other, bad-dist"})

    assert record_of(registry, "bad-dist").status == "disabled"


def test_star_disables_all_but_core(good_dist):
    registry = load_registry({"NCSIM_DISABLE_PLUGINS": "*"})

    assert {each.distribution for each in registry.plugins if each.status == "ok"} == {"ncsim-core"}
    assert "round_robin" in registry.names("scheduler")


def test_allow_list_lets_in_its_members_and_core(good_dist, fake_dist):
    fake_dist("other", {"other_declaration": declaring('"scheduler", "x", "m:f", ""')})

    registry = load_registry({"NCSIM_PLUGINS": "good-dist"})

    assert {each.distribution for each in registry.plugins if each.status == "ok"} == {
        "ncsim-core",
        "good-dist",
    }
    assert record_of(registry, "other").detail == "not in NCSIM_PLUGINS"


def test_unknown_name_tells_which_plugins_did_not_load(fake_dist):
    fake_dist("bad-dist", {"bad_declaration": "raise ValueError('worn out')"})

    with pytest.raises(UnknownComponentError) as caught:
        load_registry().find("scheduler", "my_scheduler")

    assert "bad-dist 1.0 (failed: ValueError: worn out)" in str(caught.value)


def test_damaged_metadata_of_a_stranger_does_not_stop_loading(fake_dist):
    folder = fake_dist("bad-dist", {"bad_declaration": "1 / 0"})
    (folder / "bad_dist-1.0.dist-info" / "METADATA").unlink()

    registry = load_registry()

    assert record_of(registry, "ncsim-core").status == "ok"
    assert any(each.status == "failed" for each in registry.plugins)


def test_an_entry_point_to_a_function_says_which_module_to_write(fake_dist: FakeDist):
    fake_dist(
        "bad-dist",
        {"bad_declaration": f"{DECLARATION}{GOOD}"},
        entry_points={"bad": "bad_declaration:ncsim_components"},
    )

    record = next(each for each in load_registry().plugins if each.distribution == "bad-dist")

    assert record.status == "failed"
    assert "which is no module; write 'bad_declaration'" in record.detail
