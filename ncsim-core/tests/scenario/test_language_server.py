"""An editor with yaml-language-server shows the loader's faults and completes names and options.

Needs the server: ``npm install yaml-language-server`` anywhere, and its program on ``PATH`` or in
the environment variable ``YAML_LANGUAGE_SERVER``. Without it, a plain validator must agree.
"""

import json
import os
import shutil
import subprocess
from pathlib import Path

import jsonschema
import pytest
from ncsim_core.registry import load_registry
from ncsim_core.scenario import ScenarioFaults, parse_scenario
from ncsim_core.scenario.explain import schema_problems
from ncsim_core.scenario.schema import compose_schema
from ncsim_core.scenario.yaml_reader import read_yaml

SCHEMA = Path(__file__).parents[3] / "schemas" / "scenario.schema.json"
SERVER = os.environ.get("YAML_LANGUAGE_SERVER") or shutil.which("yaml-language-server")

SETTINGS = {
    "validate": True,
    "completion": True,
    "schemas": {SCHEMA.as_uri(): ["*.yaml"]},
    "schemaStore": {"enable": False},
}

FAULTY = """\
scenario:
  name: eight faults
  netwrok: {}
  network:
    nodes:
      - {id: n0, compute_capacity: -1}
      - {id: 7, compute_capacity: 1}
  dags:
    - id: d
      tasks: [{id: T0, compute_cost: 1, pin: n0}]
  config:
    routing: widest
    link_model: {type: wifi, options: {rate: fast, rats: 1}}
    rf: {tx_power_dBm: hot}
"""
GOOD = """\
scenario:
  network:
    nodes:
      - {id: n0, compute_capacity: 1}
  dags:
    - id: d
      tasks: [{id: T0, compute_cost: 1}]
  config:
"""


class Editor:
    """The client side of the language server protocol, as much as is needed here."""

    def __init__(self) -> None:
        self._server = subprocess.Popen(
            [SERVER, "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self._opened = 0
        pulls_settings = {"workspace": {"configuration": True}}
        self._request("initialize", processId=None, rootUri=None, capabilities=pulls_settings)
        self._send(method="initialized", params={})
        self._send(method="workspace/didChangeConfiguration", params={"settings": {}})

    def close(self) -> None:
        self._server.kill()
        self._server.communicate()

    def faults(self, text: str) -> list[tuple[int, int]]:
        """Return line and column, from 1, of all faults that the server shows."""
        uri = self._open(text)
        while True:
            message = self._receive()
            params = message.get("params", {})
            if message.get("method", "").endswith("publishDiagnostics") and params["uri"] == uri:
                starts = [each["range"]["start"] for each in params["diagnostics"]]
                return sorted((each["line"] + 1, each["character"] + 1) for each in starts)

    def completions(self, text: str) -> set[str]:
        """Return what the server offers at the end of the text."""
        uri = self._open(text)
        lines = text.split("\n")
        at = {"line": len(lines) - 1, "character": len(lines[-1])}
        answer = self._request("textDocument/completion", textDocument={"uri": uri}, position=at)
        return {each["label"] for each in answer["items"]}

    def _open(self, text: str) -> str:
        self._opened += 1
        uri = f"file:///nowhere/{self._opened}.yaml"
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": text}
        self._send(method="textDocument/didOpen", params={"textDocument": document})
        return uri

    def _request(self, method: str, **params: object):
        number = f"{method}-{self._opened}"
        self._send(id=number, method=method, params=params)
        while True:
            message = self._receive()
            if message.get("id") == number:
                return message["result"]

    def _send(self, **message: object) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._server.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        self._server.stdin.flush()

    def _receive(self):
        length = 0
        while header := self._server.stdout.readline().strip():
            name, _, value = header.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        message = json.loads(self._server.stdout.read(length))
        if "id" in message and "method" in message:
            items = message["params"].get("items", ())
            answers = [SETTINGS if each.get("section") == "yaml" else None for each in items]
            self._send(id=message["id"], result=answers)
        return message


@pytest.fixture(scope="module")
def editor():
    if SERVER is None:
        pytest.skip("yaml-language-server is not installed; see the module's docstring")
    editor = Editor()
    yield editor
    editor.close()


@pytest.fixture(scope="module")
def first_party():
    return load_registry({"NCSIM_PLUGINS": "ncsim-wifi,ncsim-saga,ncsim-routing,ncsim-viz"})


def loader_faults(registry) -> list[tuple[int, int]]:
    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(FAULTY, registry=registry)
    return [(fault.line, fault.column) for fault in caught.value.faults]


def test_an_editor_shows_the_faults_of_the_loader_at_the_same_places(editor, first_party):
    assert editor.faults(FAULTY) == loader_faults(first_party)


def test_a_plain_validator_finds_fault_with_the_same_values(first_party):
    """The loader explains what any draft-07 validator finds, no more and no less."""
    document = read_yaml(FAULTY).document
    errors = jsonschema.Draft7Validator(compose_schema(first_party)).iter_errors(document)

    found = {tuple(error.absolute_path) for error in errors}

    explained = [each.path for each in schema_problems(document, first_party)]
    assert len(explained) == len(loader_faults(first_party)) == 8
    assert all(any(path[: len(each)] == each for each in found) for path in explained)
    assert all(any(path[: len(each)] == each for path in explained) for each in found)


def test_an_editor_completes_component_names(editor):
    offered = editor.completions(f"{GOOD}    routing: ")

    assert {"direct", "widest_path", "minimum_hop", "shortest_path"} <= offered


def test_an_editor_completes_option_keys_of_the_chosen_component(editor):
    text = f"{GOOD}    interference:\n      type: csma_bianchi\n      options:\n        "

    assert {"hidden_model"} <= editor.completions(text)


def test_an_editor_completes_the_keys_of_sections(editor):
    assert {"tx_power_dBm", "rts_cts"} <= editor.completions(f"{GOOD}    rf:\n      ")
