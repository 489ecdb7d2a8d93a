"""What the package offers, and that looking at it stays cheap."""

import subprocess
import sys
from importlib import import_module

from ncsim_core.context import BuildContext
from ncsim_core.contracts.routing_model import RoutingModel
from ncsim_core.network import LinkRates, Network, Node
from ncsim_routing.declaration import ncsim_components


def test_every_factory_builds_a_routing_model():
    context = BuildContext(Network((Node("a", 1.0),), (), LinkRates((), ())))
    for component in ncsim_components():
        module, _, name = component.factory.partition(":")

        assert isinstance(getattr(import_module(module), name)(context), RoutingModel)


def test_the_declaration_imports_no_model():
    code = (
        "import sys, ncsim_routing.declaration as d; list(d.ncsim_components());"
        "print([m for m in sys.modules if m.startswith('ncsim_routing.') or m == 'numpy'])"
    )
    answer = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )

    assert answer.stdout.strip() == "['ncsim_routing.declaration']"
