"""From a scenario file to frozen descriptions and the components that will decide.

``load_scenario`` reads, checks and resolves a file; ``assemble`` builds what it names.
"""

from ncsim_core.scenario.assembly import Assembly, assemble
from ncsim_core.scenario.faults import Fault, ScenarioFaults
from ncsim_core.scenario.loader import load_scenario, parse_scenario
from ncsim_core.scenario.model import ComponentSpec, Config, Scenario

__all__ = [
    "Assembly",
    "ComponentSpec",
    "Config",
    "Fault",
    "Scenario",
    "ScenarioFaults",
    "assemble",
    "load_scenario",
    "parse_scenario",
]
