import gzip
import json
import os
from contextlib import closing
from http.client import HTTPConnection

import pytest
from ncsim_core.metrics import compute_metrics
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.sweep.running import run_sweep
from ncsim_core.trace.loading import load_run
from ncsim_viz.document import report_html


def test_the_page_learns_its_token_and_mode(client):
    from base64 import b64decode
    from re import search

    _, _, body = client.ask("GET", "/", token=client.server.token)

    found = search(rb'<script type="application/x-ncsim-server">([^<]*)</script>', body)
    about = json.loads(b64decode(found[1]))
    assert about["token"] == client.server.token
    assert (about["api"], about["title"], about["can_run"]) == (1, "served", True)


def test_the_list_has_the_run(client):
    status, document = client.get("/api/entries")

    assert (status, document["title"], document["left_out"]) == (200, "served", 0)
    (entry,) = document["entries"]
    assert (entry["id"], entry["kind"], entry["status"]) == ("small", "run", "completed")
    assert entry["plugins"]["scheduler"] == "manual"


def test_a_trace_is_given_as_it_is(client, run_folder):
    trace = run_folder / "trace.jsonl"
    plain = client.ask("GET", "/api/trace", run="small")[2]
    packed = gzip.compress(trace.read_bytes())
    trace.unlink()
    (run_folder / "trace.jsonl.gz").write_bytes(packed)

    assert plain == gzip.decompress(packed)
    assert client.ask("GET", "/api/trace", run="small")[2] == packed


def test_extras_are_those_of_the_report(client, run_folder, scenario_text):
    status, extras = client.get("/api/extras", run="small", compare="small")

    assert status == 200
    assert extras["metrics"][0] == json.loads(json.dumps(compute_metrics(load_run(run_folder))))
    assert extras["comparison"]["names"] == ["small", "small"]
    assert extras["scenario"] == scenario_text


def test_extras_are_those_of_the_run_as_it_is_now(client, run_folder):
    before = client.get("/api/extras", run="small")[1]
    again = client.get("/api/extras", run="small")[1]
    trace = run_folder / "trace.jsonl"
    trace.write_text("".join(trace.read_text().splitlines(keepends=True)[:-1]))
    after = client.get("/api/extras", run="small")[1]

    assert before == again
    assert before["metrics"][0]["status"] == "completed"
    assert after["metrics"][0]["status"] == "truncated"


def events_of(client, headers, lines=10_000, **query):
    """Return the events of a stream as (id, event, data), the connection dropped after a few."""
    address = "&".join(f"{key}={value}" for key, value in query.items())
    events, fields = [], {}
    with closing(HTTPConnection("127.0.0.1", client.server.port, timeout=30)) as to:
        to.request("GET", f"/api/stream?{address}", headers=client.headers | headers)
        answer = to.getresponse()
        assert answer.getheader("Content-Type") == "text/event-stream"
        for raw in answer:
            name, _, value = raw.decode().rstrip("\n").partition(": ")
            if name:
                fields.setdefault(name, []).append(value)
                continue
            events.append((fields.get("id"), fields.get("event"), fields.get("data", [])))
            fields = {}
            if sum(len(each[2]) for each in events) >= lines:
                break
    return events[1:]  # the first says how long to wait before a new attempt


def test_a_stream_gives_the_records_with_places_and_then_ends(client, run_folder):
    records, end = events_of(client, {}, run="small")
    lines = (run_folder / "trace.jsonl").read_text().splitlines()

    assert records[2] == lines
    assert end[1:] == (["end"], ['{"status": "completed"}'])


@pytest.mark.parametrize("way", ["header", "address"])
def test_a_stream_goes_on_after_a_place(client, run_folder, way):
    with (run_folder / "trace.jsonl").open("r+") as file:
        lines = file.readlines()
        file.seek(0)
        file.truncate()
        file.writelines([lines[0], *lines[1:2] * 20_000, *lines[1:]])
    first = events_of(client, {}, lines=1, run="small")[0]
    headers = {"Last-Event-ID": first[0][0]} if way == "header" else {}
    query = {"from": first[0][0]} if way == "address" else {}
    rest = events_of(client, headers, run="small", lines=10**9, **query)

    got = [*first[2], *(line for each in rest[:-1] for line in each[2])]
    assert got == (run_folder / "trace.jsonl").read_text().splitlines()
    assert len(rest) > 2


@pytest.mark.parametrize("place", ["x", "1", "-5-00", "1-zz"])
def test_a_place_that_is_none_is_refused(client, place):
    status, answer = client.get("/api/stream", run="small", **{"from": place})

    assert (status, answer.keys()) == (400, {"error"})


def test_a_live_run_cannot_be_summed_up_yet(client, run_folder):
    live = run_folder.parent / f".new.partial-{os.getpid()}-0123abcd"
    run_folder.rename(live)

    status, answer = client.get("/api/extras", run="new")

    assert status == 409
    assert "still running" in answer["error"]


STUDY = {
    "sweep": {
        "name": "trial",
        "base": {
            "network": {"type": "line", "nodes": 3, "bandwidth_MBps": 2},
            "dags": {"type": "fork_join", "width": 2},
            "config": {"link_model": "static"},
        },
        "vary": {"scheduler": ["round_robin"], "network.nodes": [2, 3], "dags.width": [1, 2]},
        "replicate": {"seeds": 2},
    }
}


def test_a_study_has_its_tables_and_scenarios(client, run_folder):
    folder = run_folder.parent / "studies" / "trial"
    with run_sweep(STUDY, folder) as results:
        made = list(results)

    entry = next(each for each in client.get("/api/entries")[1]["entries"] if "planned" in each)
    assert (entry["id"], entry["kind"], entry["status"]) == ("studies/trial", "study", "completed")
    assert (entry["planned"], entry["ended"]) == (len(made), len(made))
    status, study = client.get("/api/study", study="studies/trial", where="width=2")
    assert status == 200
    assert len(study["runs"]["rows"]) == len(made) / 2
    status, answer = client.get("/api/study/scenario", study="studies/trial", run=5)
    row = client.get("/api/study", study="studies/trial")[1]["runs"]
    values = dict(zip(row["columns"], row["rows"][5], strict=True))
    scenario = parse_scenario(answer["yaml"])
    assert len(scenario.network.nodes) == values["network.nodes"]
    assert client.get("/api/study/scenario", study="studies/trial", run=500)[0] == 404
    assert client.get("/api/study/scenario", study="studies/trial", run="x")[0] == 400
    assert client.get("/api/study", study="small")[0] == 404
    assert "application/x-ncsim-extras" in report_html(folder)


def test_the_schema_and_catalogue_have_what_is_installed(client):
    _, schema = client.get("/api/schema")
    _, catalogue = client.get("/api/catalogue")

    config = schema["properties"]["scenario"]["properties"]["config"]["properties"]
    assert [each["config_key"] for each in catalogue["kinds"]] == [
        key for key in config if key in {each["config_key"] for each in catalogue["kinds"]}
    ]
    names = [each["name"] for each in catalogue["kinds"][0]["components"]]
    assert "manual" in names
    assert {"grid", "line"} <= {each["type"] for each in catalogue["generators"]["networks"]}
    assert parse_scenario(catalogue["starter"]).name == "first"


def test_a_right_scenario_is_told_with_all_defaults(client, scenario_text):
    status, answer = client.post("/api/validate", {"yaml": scenario_text})

    assert (status, answer["valid"], answer["faults"]) == (200, True, [])
    assert answer["resolved"]["scenario"]["config"]["seed"] == 42
    assert "seed" not in answer["document"]["scenario"]["config"]
    assert answer["summary"] == {"nodes": 2, "links": 1, "dags": 1, "tasks": 2}


def test_all_faults_are_told_with_place_and_pointer(client, scenario_text):
    wrong = scenario_text.replace("to: b, ", "to: c, ").replace("manual", "manuel")

    _, answer = client.post("/api/validate", {"yaml": wrong})

    assert not answer["valid"]
    by_pointer = {each["pointer"]: each for each in answer["faults"]}
    assert by_pointer.keys() == {"/scenario/network/links/0/to", "/scenario/config/scheduler"}
    fault = by_pointer["/scenario/config/scheduler"]
    assert fault["line"] == 11
    assert "did you mean 'manual'" in fault["message"]
    assert wrong.splitlines()[fault["line"] - 1][fault["column"] - 1 :].startswith("manuel")
    assert answer["document"]["scenario"]["network"]["links"][0]["to"] == "c"


@pytest.mark.parametrize("text", ["", "[1, 2]", "a: [", "\t", "a: &x [*x]", "5", "\0"])
def test_what_is_no_mapping_has_faults_and_no_document(client, text):
    _, answer = client.post("/api/validate", {"yaml": text})

    assert not answer["valid"]
    assert answer["faults"]
    assert answer["document"] is None or text.startswith("a")


def test_numbers_that_json_has_not_are_faults_and_stay_visible(client, scenario_text):
    _, answer = client.post(
        "/api/validate", {"yaml": scenario_text.replace("bandwidth: 2", "bandwidth: .inf")}
    )

    assert [each["pointer"] for each in answer["faults"]] == ["/scenario/network/links/0/bandwidth"]
    assert answer["document"]["scenario"]["network"]["links"][0]["bandwidth"] == ".inf"


def test_yaml_and_data_are_two_forms_of_one_scenario(client, scenario_text):
    document = client.post("/api/validate", {"yaml": scenario_text})[1]["document"]
    text = client.post("/api/yaml", {"document": document})[1]["yaml"]

    assert client.post("/api/validate", {"yaml": text})[1]["document"] == document
    assert parse_scenario(text) == parse_scenario(scenario_text)


def test_presets_are_made_by_the_generators(client):
    request = {
        "network": {"type": "line", "nodes": 3, "bandwidth_MBps": 2},
        "dags": {"type": "chain", "tasks": 4},
    }

    status, answer = client.post("/api/preset", request)

    assert status == 200
    scenario = parse_scenario(answer["yaml"])
    assert (len(scenario.network.nodes), len(scenario.injections[0].dag.tasks)) == (3, 4)
    assert client.post("/api/yaml", {"document": answer["document"]})[1]["yaml"] == answer["yaml"]


def test_a_preset_may_leave_bandwidths_to_a_radio(client):
    request = {
        "network": {"type": "grid", "rows": 2, "columns": 2},
        "dags": {"type": "paper", "tasks": 5},
    }

    status, answer = client.post("/api/preset", request)

    assert status == 200
    assert "bandwidth" not in answer["document"]["scenario"]["network"]["links"][0]


def test_a_preset_says_what_is_wrong_with_it(client):
    request = {"network": {"type": "line", "nodes": 0}, "dags": {"type": "chain"}}

    status, answer = client.post("/api/preset", request)

    assert status == 400
    assert {each["pointer"] for each in answer["faults"]} == {"/network/nodes", "/dags"}


@pytest.mark.parametrize(
    "part",
    [{"type": "line", "nodes": 2, "file": "/etc/passwd"}, {"file": "/etc/passwd"}, "x", None],
)
def test_a_preset_reads_no_file(client, part):
    status, answer = client.post("/api/preset", {"network": part, "dags": {"type": "chain"}})

    assert status == 400
    assert "root:" not in json.dumps(answer)


@pytest.mark.parametrize("path", ["/api/validate", "/api/jobs", "/api/yaml", "/api/jobs/cancel"])
def test_requests_of_the_wrong_shape_are_refused(client, path):
    for body in ({}, {"yaml": 5}, {"document": []}, {"job": 7}):
        assert client.post(path, body)[0] == 400


def test_a_folder_that_cannot_be_written_is_only_shown(serve, monkeypatch):
    monkeypatch.setattr("ncsim_viz.server.serving.os.access", lambda *_: False)
    with serve() as client:
        assert client.get("/api/entries")[0] == 200
        for status, answer in (client.get("/api/jobs"), client.post("/api/jobs", {"yaml": "x"})):
            assert status == 409
            assert "cannot be written" in answer["error"]


def test_a_parameter_may_be_given_once_only(client):
    assert client.ask("GET", "/api/trace?run=small&run=other")[0] == 400
    assert client.ask("GET", "/api/trace")[0] == 400
