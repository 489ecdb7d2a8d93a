"""Names lead to components, components are built, and errors say whom to blame."""

import subprocess
import sys

import pytest
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.errors import PluginError, ScenarioError, UnknownComponentError
from ncsim_core.models import ComponentIdentity
from ncsim_core.plugins import KINDS, Component, RunInfo
from ncsim_core.registry import PluginRecord, get_registry, load_registry
from ncsim_core.registry.building import contract_of, factory_fault
from ncsim_core.registry.messages import unknown_name
from ncsim_core.registry.well_known import PROVIDER_BY_NAME
from ncsim_core.testing.builders import line, make_context
from ncsim_core.testing.fixtures import DECLARATION, FakeDist

ONLY_CORE = {"NCSIM_DISABLE_PLUGINS": "*"}

CODE = """
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.errors import ScenarioError

class Mine(RoundRobinScheduler):
    def __init__(self, context, depth=2, label="x", fixed=0):
        super().__init__(context)
        self.depth, self.label, self.fixed = depth, label, fixed

def fails(context):
    raise KeyError("inside")

def exits(context):
    raise SystemExit(4)

def refuses(context):
    raise ScenarioError("not for this network")

def makes_text(context):
    return "no scheduler"

not_callable = 3
"""

OPTIONS = """{
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "depth": {"type": "integer", "default": 2, "description": "Levels."},
        "label": {"type": "string", "default": "x", "description": "Name."},
    },
}"""


def declaring(*components: str) -> str:
    listed = ", ".join(f"Component({each})" for each in components)
    return f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    return [{listed}]\n"


@pytest.fixture
def mine(fake_dist: FakeDist) -> None:
    fake_dist(
        "mine-dist",
        {
            "mine_declaration": declaring(
                f'"scheduler", "mine", "mine_code:Mine", "", {OPTIONS}, params={{"fixed": 7}}',
                *(
                    f'"scheduler", "{name}", "mine_code:{name}", ""'
                    for name in ("fails", "exits", "refuses", "makes_text", "not_callable", "gone")
                ),
                '"scheduler", "nowhere", "no_such_module:x", ""',
                '"routing_model", "wrong_contract", "mine_code:Mine", ""',
            ),
            "mine_code": CODE,
        },
        version="2.5",
    )


def test_core_loads_first_and_the_others_by_distribution(fake_dist):
    fake_dist("a-first", {"a_first": declaring()})

    distributions = [each.distribution for each in load_registry().plugins]

    assert distributions[:2] == ["ncsim-core", "a-first"]
    assert distributions[1:] == sorted(distributions[1:])


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_has_a_contract_and_a_builtin_component(kind):
    assert load_registry(ONLY_CORE).components(kind)
    assert isinstance(contract_of(kind), type)


def test_bare_and_qualified_names_lead_to_the_same_component():
    registry = load_registry(ONLY_CORE)

    assert registry.find("scheduler", "manual") is registry.find("scheduler", "ncsim-core/manual")


def test_bare_name_offered_twice_is_an_error_that_lists_the_qualified_forms(fake_dist):
    for name in ("a-dist", "b-dist"):
        source = declaring('"scheduler", "shared", "m:f", ""')
        fake_dist(name, {f"{name[0]}_declaration": source})
    registry = load_registry()

    with pytest.raises(UnknownComponentError, match="a-dist/shared, b-dist/shared"):
        registry.find("scheduler", "shared")

    assert registry.find("scheduler", "b-dist/shared").distribution == "b-dist"
    assert {"a-dist/shared", "b-dist/shared"} <= set(registry.names("scheduler"))
    assert "shared" not in registry.names("scheduler")


def test_third_party_does_not_displace_a_builtin_of_the_same_name(fake_dist):
    fake_dist("rival", {"rival": declaring('"scheduler", "manual", "m:f", ""')})

    with pytest.raises(UnknownComponentError, match="ncsim-core/manual, rival/manual"):
        load_registry().find("scheduler", "manual")


@pytest.mark.parametrize(
    ("kind", "name", "message"),
    [
        ("scheduler", "manuel", "did you mean 'manual'"),
        ("scheduler", "heft", "'heft' comes with ncsim-saga: pip install ncsim-saga"),
        ("scheduler", "hefd", "did you mean 'heft'; 'heft' comes with ncsim-saga"),
        ("interference_model", "csma_bianci", "pip install ncsim-wifi"),
        ("routing_model", "widest_path", "pip install ncsim-routing"),
        ("queue_model", "zzz", "unknown queue_model 'zzz'; installed: manual, round_robin"),
    ],
)
def test_unknown_name_says_what_was_meant_and_what_to_install(kind, name, message):
    core_alone = [PluginRecord("ncsim-core", "0.1.0")]

    assert message in unknown_name(kind, name, ["manual", "round_robin"], core_alone)


def test_package_that_is_there_but_did_not_load_is_not_to_be_installed():
    saga = PluginRecord("ncsim-saga", "0.1.0", "1.0", "failed", "ImportError: no saga")

    message = unknown_name("scheduler", "heft", ["manual"], [saga])

    assert "'heft' comes with ncsim-saga, which did not load" in message
    assert "ncsim-saga 0.1.0 (failed: ImportError: no saga)" in message


def test_loaded_package_without_the_name_is_not_recommended():
    saga = PluginRecord("ncsim-saga", "0.1.0", "1.0")

    assert "ncsim-saga" not in unknown_name("scheduler", "heft", ["manual"], [saga])


def test_unknown_kind_lists_the_kinds():
    with pytest.raises(UnknownComponentError, match="the kinds are scheduler, routing_model"):
        load_registry(ONLY_CORE).find("planner", "heft")


@pytest.mark.parametrize(
    ("requirement", "told"),
    [
        ("pluggy>=99", "needs pluggy>=99 (have "),
        ("no-such-package-at-all>=1", "needs no-such-package-at-all>=1 (not installed)"),
    ],
)
def test_unmet_requirement_is_told_with_what_is_there(requirement, told, fake_dist):
    source = declaring(f'"scheduler", "needy", "m:f", "", requires=("{requirement}",)')
    fake_dist("needy-dist", {"needy_declaration": source})
    registry = load_registry()

    with pytest.raises(PluginError) as caught:
        registry.find("scheduler", "needy")

    assert told in str(caught.value)
    assert not registry.lookup("scheduler", "needy").is_available
    assert "needy" in registry.names("scheduler")


def test_requirement_whose_marker_is_false_is_met(fake_dist):
    requirement = "no-such-package; python_version < '3'"
    source = declaring(f'"scheduler", "old", "m:f", "", requires=("{requirement}",)')
    fake_dist("old-dist", {"old_declaration": source})

    assert load_registry().find("scheduler", "old").is_available


def test_component_is_built_with_params_options_and_defaults(mine):
    component, identity = get_registry().build(
        "scheduler", "mine", {"depth": 5}, make_context(line(2))
    )

    assert isinstance(component, RoundRobinScheduler)
    assert (component.depth, component.label, component.fixed) == (5, "x", 7)
    assert identity == ComponentIdentity(
        "scheduler", "mine", "mine-dist", "2.5", "mine_code:Mine", {"depth": 5, "label": "x"}
    )


def test_builder_makes_a_new_object_each_time():
    build, identity = load_registry(ONLY_CORE).builder(
        "queue_model", "fifo", {}, make_context(line(2))
    )

    assert build() is not build()
    assert str(identity) == f"queue_model 'fifo' (ncsim-core {identity.version})"


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("fails", "building it failed: KeyError: 'inside'"),
        ("exits", "building it failed: SystemExit: 4"),
        ("makes_text", "gave str, which is no Scheduler"),
        ("not_callable", "cannot be called"),
        ("gone", "cannot import mine_code:gone"),
        ("nowhere", "cannot import no_such_module:x"),
    ],
)
def test_fault_in_building_names_component_distribution_and_version(name, told, mine):
    with pytest.raises(PluginError) as caught:
        get_registry().build("scheduler", name, {}, make_context(line(2)))

    assert str(caught.value).startswith(f"scheduler '{name}' (mine-dist 2.5): ")
    assert told in str(caught.value)


def test_error_of_ncsim_passes_as_it_is(mine):
    with pytest.raises(ScenarioError, match=r"^not for this network$"):
        get_registry().build("scheduler", "refuses", {}, make_context(line(2)))


def test_unknown_option_is_the_users_error_with_a_suggestion(mine):
    with pytest.raises(ScenarioError, match=r"unknown option 'dpeth'; did you mean 'depth'\?"):
        get_registry().build("scheduler", "mine", {"dpeth": 1}, make_context(line(2)))


def test_missing_required_option_is_the_users_error(fake_dist):
    schema = (
        '{"type": "object", "additionalProperties": False, "required": ["k"], '
        '"properties": {"k": {"type": "integer"}}}'
    )
    source = declaring(f'"scheduler", "strict", "ncsim_core.errors:NcsimError", "", {schema}')
    fake_dist("strict-dist", {"strict_declaration": source})

    with pytest.raises(ScenarioError, match="option 'k' is missing"):
        get_registry().build("scheduler", "strict", {}, make_context(line(2)))


def test_factory_of_another_contract_is_found_without_building(mine):
    registered = get_registry().find("routing_model", "wrong_contract")

    assert "Mine is no RoutingModel" in (factory_fault(registered) or "")


def test_options_schema_is_read_from_a_file_of_the_package(fake_dist):
    schema = """{"type": "object", "additionalProperties": false,
                 "properties": {"k": {"type": "object", "properties": {"a": {"default": 1}}}}}"""
    fake_dist(
        "file-dist",
        {
            "file_plugin/declaration.py": declaring(
                '"scheduler", "filed", "m:f", "", "file_plugin:schemas/options.json"'
            ),
            "file_plugin/__init__.py": "",
            "file_plugin/schemas/options.json": schema,
        },
    )
    registry = load_registry()
    registered = registry.find("scheduler", "filed")

    assert registry.options_schema(registered)["additionalProperties"] is False
    assert registry.resolve_options(registered, {"k": {"b": 2}}) == {"k": {"a": 1, "b": 2}}


def test_component_without_options_has_the_schema_of_an_empty_object():
    registry = load_registry(ONLY_CORE)

    schema = registry.options_schema(registry.find("scheduler", "manual"))

    assert (schema["properties"], schema["additionalProperties"]) == ({}, False)


def test_run_hooks_are_called_in_load_order_with_what_they_ask_for(fake_dist):
    source = """
        seen = []
        @hookimpl
        def ncsim_run_started(run):
            seen.append(run.scenario_name)
        @hookimpl
        def ncsim_run_finished(status):
            seen.append(status)
    """
    fake_dist("listener", {"listener": DECLARATION + source.replace("\n        ", "\n")})
    registry = load_registry()
    run = RunInfo("demo", 42, {})

    registry.announce_start(run)
    registry.announce_finish(run, "completed", 1.5)

    assert sys.modules["listener"].seen == ["demo", "completed"]


def test_failing_run_hook_names_its_plugin(fake_dist):
    source = "@hookimpl\ndef ncsim_run_started(run):\n    1 / 0\n"
    fake_dist("listener", {"listener": DECLARATION + source})

    with pytest.raises(PluginError, match=r"plug-in listener: ncsim_run_started\(\) raised Zero"):
        load_registry().announce_start(RunInfo("demo", 42, {}))


def test_registry_is_kept_per_process():
    assert get_registry() is get_registry()


def test_component_declaration_is_frozen():
    with pytest.raises(AttributeError):
        Component("scheduler", "x", "m:f", "").name = "y"  # type: ignore[misc]


def test_loading_imports_none_of_the_big_libraries():
    code = (
        "import sys; from ncsim_core.registry import get_registry; get_registry();"
        "print({'numpy', 'networkx', 'jsonschema', 'saga', 'hypothesis'} & set(sys.modules))"
    )

    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert done.stdout.strip() == "set()"


FIRST_PARTY = {"NCSIM_PLUGINS": "ncsim-wifi,ncsim-saga,ncsim-routing"}


def test_table_of_well_known_names_is_what_the_installed_packages_bring():
    registry = load_registry(FIRST_PARTY)
    packages = {each.distribution for each in registry.plugins if each.status == "ok"}
    brought = {
        (each.component.kind, each.component.name): each.distribution
        for kind in KINDS
        for each in registry.components(kind)
        if each.distribution != "ncsim-core"
    }
    brought |= {("section", each.section.name): each.distribution for each in registry.sections()}

    table = {
        (kind, name): package
        for kind, names in PROVIDER_BY_NAME.items()
        for name, package in names.items()
        if package in packages
    }

    assert table == brought
