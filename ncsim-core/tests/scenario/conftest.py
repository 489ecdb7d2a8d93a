"""Registries of the scenario tests: core alone, and core with a pretended radio package."""

import pytest
from ncsim_core.registry import Registry, load_registry
from ncsim_core.testing.fixtures import FakeDist, fake_dist

__all__ = ["fake_dist"]

ANTENNA = """
from ncsim_core.plugins import Component, Section, hookimpl

NCSIM_PLUGIN_API = "1.0"

GAIN = {"type": "number", "minimum": -10, "maximum": 10, "default": 2, "description": "dB"}
NOISE = {"type": "number", "maximum": 0, "default": -95.0, "description": "dBm"}


def schema(**properties):
    return {"type": "object", "additionalProperties": False, "properties": properties}


@hookimpl
def ncsim_components():
    return [
        Component(
            "link_model",
            "antenna",
            "antenna_models:Antenna",
            "Twice the gain.",
            options=schema(gain_dB=GAIN),
            capabilities=frozenset({"radio"}),
        ),
        Component(
            "interference_model",
            "static_noise",
            "antenna_models:StaticNoise",
            "Needs a radio.",
            capabilities=frozenset({"needs_radio"}),
        ),
        Component(
            "link_model", "broken_rates", "antenna_models:BrokenRates", "Gives what it is told.",
            options=schema(rates={"type": "array", "description": "MB/s", "default": []}),
        ),
    ]


@hookimpl
def ncsim_sections():
    return [Section("air", "The air.", schema(noise_dBm=NOISE), frozenset({"radio"}))]
"""

ANTENNA_MODELS = """
from ncsim_core.builtin.interference_models import NoInterference
from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.network import LinkRates


class Antenna(LinkModel):
    def __init__(self, context, gain_dB):
        self.gain_dB = gain_dB

    def rate_links(self, network):
        count = len(network.links)
        return LinkRates.of([2.0 * self.gain_dB] * count, [0.5] * count)


class BrokenRates(LinkModel):
    def __init__(self, context, rates):
        self.rates = tuple(rates)

    def rate_links(self, network):
        return LinkRates(self.rates, (0.0,) * len(network.links))


class StaticNoise(NoInterference):
    pass
"""


@pytest.fixture(scope="session")
def core() -> Registry:
    """Return a registry of ncsim-core alone."""
    return load_registry({"NCSIM_PLUGINS": "ncsim-core"})


@pytest.fixture
def with_antenna(fake_dist: FakeDist) -> Registry:
    """Return a registry of ncsim-core and a pretended package with a radio link model."""
    fake_dist("antenna", {"antenna_plugin": ANTENNA, "antenna_models": ANTENNA_MODELS})
    return load_registry({"NCSIM_PLUGINS": "antenna"})
