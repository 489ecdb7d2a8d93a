import http.client
import json
import threading
from contextlib import closing, contextmanager
from urllib.parse import urlencode

import pytest
from ncsim_core.api import prepare
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.trace.writer import TraceWriter
from ncsim_viz.server.child import Limits
from ncsim_viz.server.serving import ViewerServer


class Client:
    """Asks a server as the page does."""

    def __init__(self, server):
        self.server = server
        self.headers = {"X-Ncsim-Token": server.token}

    def ask(self, method, path, body=None, headers=None, **query):
        """Return status, headers and body of an answer."""
        with closing(http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=30)) as to:
            address = f"{path}?{urlencode(query)}" if query else path
            to.request(method, address, body, self.headers if headers is None else headers)
            answer = to.getresponse()
            return answer.status, answer.headers, answer.read()

    def get(self, path, **query):
        """Return status and document of an answer."""
        status, _, body = self.ask("GET", path, **query)
        return status, json.loads(body)

    def post(self, path, document):
        """Return status and document of an answer."""
        headers = self.headers | {"Content-Type": "application/json"}
        status, _, body = self.ask("POST", path, json.dumps(document), headers)
        return status, json.loads(body)


@pytest.fixture
def run_folder(tmp_path, scenario_text):
    """Return a served folder with one run in it."""
    folder = tmp_path / "served" / "small"
    folder.mkdir(parents=True)
    (folder / "scenario.yaml").write_text(scenario_text)
    scenario = load_scenario(folder / "scenario.yaml")
    prepare(scenario, observers=[TraceWriter(folder / "trace.jsonl")]).run()
    return folder


@pytest.fixture
def serve(run_folder):
    """Return a context manager that serves the folder and yields a client."""

    @contextmanager
    def serving():
        with ViewerServer(run_folder.parent, limits=Limits(60.0, 4000, 100)) as viewer:
            options = {"poll_interval": 0.02}
            thread = threading.Thread(target=viewer.serve_forever, kwargs=options)
            thread.start()
            try:
                yield Client(viewer)
            finally:
                viewer.shutdown()
                thread.join()

    return serving


@pytest.fixture
def client(serve):
    with serve() as one:
        yield one


@pytest.fixture
def server(client):
    return client.server
