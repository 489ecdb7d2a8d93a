"""Options of ``csma_spatial``: each leaves out the effect that it names."""

import inspect

import pytest
from ncsim_core.testing.builders import make_context, parallel_links
from ncsim_wifi.interference_models.csma_spatial import csma_spatial
from ncsim_wifi.spatial.settings import Terms

OPTIONS = [
    name
    for name, given in inspect.signature(csma_spatial).parameters.items()
    if name in Terms.__dataclass_fields__
]


@pytest.mark.parametrize("option", OPTIONS)
def test_an_option_leaves_out_what_it_names_and_nothing_else(option):
    context = make_context(parallel_links(2, 80.0))

    terms = csma_spatial(context, **{option: False})._plant.settings.terms

    assert terms == Terms(**{option: False})


def test_every_physical_effect_has_an_option():
    assert set(OPTIONS) == {name for name, on in vars(Terms()).items() if on}
