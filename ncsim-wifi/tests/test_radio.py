from ncsim_core.plugins import Section
from ncsim_wifi.declaration import ncsim_components, ncsim_sections
from ncsim_wifi.radio import Radio
from ncsim_wifi.tables import table_names


def rf_section() -> Section:
    (section,) = ncsim_sections()
    return section


def test_every_key_of_rf_is_a_parameter_with_the_same_default():
    properties = rf_section().schema["properties"]

    assert {name: each["default"] for name, each in properties.items()} == vars(Radio())


def test_every_key_of_rf_says_its_unit_or_that_it_has_none():
    for name, each in rf_section().schema["properties"].items():
        told = each["description"]
        is_number = each["type"] in ("number", "integer")
        assert not is_number or any(u in told for u in ("dB", "GHz", "MHz", "no unit")), name


def test_the_standards_to_choose_from_are_the_tables_that_are_there():
    assert rf_section().schema["properties"]["wifi_standard"]["enum"] == table_names()


def test_missing_keys_take_defaults_and_unknown_ones_are_not_ours_to_judge():
    assert Radio.from_section({"tx_power_dBm": 10.0, "other": 1}) == Radio(tx_power_dBm=10.0)


def test_only_shadowing_makes_results_depend_on_the_seed():
    assert Radio().draws_from(7) is None
    assert Radio(shadow_fading_sigma=1.0).draws_from(7) == 7


def test_names_are_those_of_the_paper_and_the_published_tool():
    names = {(each.kind, each.name) for each in ncsim_components()}

    assert ("link_model", "wifi") in names
    assert {
        ("interference_model", n) for n in ("csma_bianchi", "proximity", "csma_clique")
    } <= names
    assert {("scheduler", "conflict_aware_heft"), ("scheduler", "uniform_discount_heft")} <= names
