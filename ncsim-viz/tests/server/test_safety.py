import json
import socket
import time
from contextlib import closing

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ncsim_viz.server import handler, serving
from ncsim_viz.server.errors import RequestError
from ncsim_viz.server.guards import is_local_host, page_policy, path_below
from ncsim_viz.server.serving import TOO_MANY

READS = ["/", "/api/entries", "/api/trace?run=small", "/api/stream?run=small", "/api/jobs"]
HOSTILE = "</script><img src=x onerror=alert(1)>"


def connect(server):
    return closing(socket.create_connection(("127.0.0.1", server.port), timeout=20))


def answer_to(server, request):
    """Return all that the server says to raw bytes."""
    with connect(server) as to:
        to.sendall(request)
        return b"".join(iter(lambda: to.recv(65536), b""))


def test_the_server_listens_on_this_machine_only(server):
    assert server.socket.getsockname()[0] == "127.0.0.1"


@pytest.mark.parametrize("path", READS)
@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", ""])
def test_a_foreign_host_is_refused(client, path, host):
    status, _, _ = client.ask("GET", path, headers={**client.headers, "Host": host})

    assert status == 403


def test_a_path_that_a_link_leads_out_is_no_path(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    (root / "out").symlink_to(tmp_path)
    (root / "in").symlink_to(root)

    assert path_below(root, "in/new") == root / "in" / "new"
    for identity in ("out", "out/new"):
        with pytest.raises(RequestError):
            path_below(root, identity)


def test_a_tunnel_may_end_at_another_port():
    assert is_local_host("localhost:9000")
    assert is_local_host("[::1]:80")
    assert not is_local_host("localhost:evil")


@pytest.mark.parametrize("path", READS)
@pytest.mark.parametrize("token", ["", "x", "é"])
def test_nothing_is_answered_without_the_token(client, path, token):
    status, _, body = client.ask("GET", path, headers={"X-Ncsim-Token": token.encode()})

    assert status == 403
    assert client.server.token.encode() not in body


@pytest.mark.parametrize("path", ["/api/jobs", "/api/jobs/cancel", "/api/validate", "/api/yaml"])
def test_a_token_in_the_address_starts_nothing(client, path):
    headers = {"Content-Type": "application/json"}
    status, _, _ = client.ask("POST", f"{path}?token={client.server.token}", "{}", headers=headers)

    assert status == 403


def test_a_form_of_another_site_starts_nothing(client):
    form = {**client.headers, "Content-Type": "application/x-www-form-urlencoded"}

    assert client.ask("POST", "/api/jobs", "yaml=x", headers=form)[0] == 400


def test_two_servers_have_two_tokens(server, tmp_path):
    with serving.ViewerServer(tmp_path) as other:
        assert server.token != other.token
        assert len(server.token) >= 32


@pytest.mark.parametrize("path", [*READS[:3], "/api/nothing"])
def test_no_other_site_may_read_or_frame_an_answer(client, path):
    headers = {**client.headers, "Origin": "http://evil.example"}
    _, answered, _ = client.ask("GET", path, headers=headers)

    assert not [name for name in answered if name.lower().startswith("access-control")]
    assert answered["Cross-Origin-Resource-Policy"] == "same-origin"
    assert answered["X-Frame-Options"] == "DENY"
    assert answered["X-Content-Type-Options"] == "nosniff"
    assert "frame-ancestors 'none'" in answered["Content-Security-Policy"]


def test_the_page_may_run_its_own_script_only(client):
    _, headers, body = client.ask("GET", "/", token=client.server.token)

    policy = headers["Content-Security-Policy"]
    assert policy == page_policy(body.decode())
    assert "script-src 'sha256-" in policy
    assert "default-src 'none'" in policy
    assert "unsafe-eval" not in policy
    assert policy.count("unsafe-inline") == 1  # style


@pytest.mark.parametrize(
    "run",
    ["../secret", "%2e%2e/secret", "..%2fsecret", "/etc", "small/../../secret", "out", "\0", ""],
)
def test_no_path_leads_out(client, run_folder, run):
    secret = run_folder.parent.parent / "secret"
    secret.mkdir()
    (secret / "trace.jsonl").write_text("secret")
    (run_folder.parent / "out").symlink_to(secret)

    for path in ("/api/trace", "/api/stream", "/api/extras"):
        status, _, body = client.ask("GET", path, run=run)
        assert status == 404
        assert json.loads(body).keys() == {"error"}
    assert client.ask("GET", f"/api/trace?run={run}".replace("\0", "%00"))[0] == 404


@pytest.mark.parametrize("path", ["/../etc/passwd", "//etc/passwd", "/api/../trace", "/%2e%2e/x"])
def test_only_the_page_and_the_requests_have_addresses(client, path):
    assert client.ask("GET", path)[0] == 404


def test_hostile_names_are_harmless_in_the_served_page_and_in_answers(client, run_folder):
    hostile = run_folder.parent / HOSTILE.replace("/", "")
    run_folder.rename(hostile)
    trace = hostile / "trace.jsonl"
    trace.write_text(trace.read_text().replace('"a"', json.dumps(HOSTILE)))

    _, headers, body = client.ask("GET", "/api/entries")
    assert headers["Content-Type"] == "application/json"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert json.loads(body)["entries"][0]["id"] == hostile.name
    assert b"<img" not in client.ask("GET", "/", token=client.server.token)[2]
    status, _, trace_back = client.ask("GET", "/api/trace", run=hostile.name)
    assert (status, trace_back) == (200, trace.read_bytes())


def test_a_folder_with_a_hostile_name_is_harmless_in_the_page(tmp_path):
    folder = tmp_path / "<img src=x onerror=alert(1)>"
    folder.mkdir()
    with serving.ViewerServer(folder) as viewer:
        assert "<img src=x" not in viewer.page()


def test_requests_are_bounded(client, monkeypatch):
    monkeypatch.setattr(handler, "MAX_BODY_BYTES", 100)

    status, answer = client.post("/api/validate", {"yaml": "x" * 200})

    assert status == 413
    assert "100 bytes" in answer["error"]


@pytest.mark.parametrize(
    ("lines", "status"),
    [
        (["Content-Type: application/json"], b"411"),
        (["Content-Type: application/json", "Content-Length: -1"], b"411"),
        (["Content-Type: application/json", "Content-Length: 1e3"], b"411"),
        (["Content-Type: application/json", "Transfer-Encoding: chunked"], b"411"),
        (["Content-Length: 2"], b"400"),
        (["Content-Type: application/json", "Content-Length: 2"], b"400"),
    ],
)
def test_malformed_requests_are_refused_and_the_connection_ends(server, lines, status, monkeypatch):
    monkeypatch.setattr(handler.Handler, "timeout", 0.3)
    head = ["POST /api/validate HTTP/1.1", "Host: localhost", f"X-Ncsim-Token: {server.token}"]
    request = "\r\n".join([*head, *lines, "", "[["]).encode()

    answer = answer_to(server, request + b"GET / HTTP/1.1\r\n\r\n")

    is_read = "Content-Length: 2" in lines and len(lines) == 2
    assert answer.split()[1] == status
    assert answer.count(b"HTTP/1.1 ") == 1 + is_read  # else the rest may be part of the body


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    start=st.sampled_from([b"", b"GET ", b"POST /api/jobs HTTP/1.1\r\nHost: "]), rest=st.binary()
)
def test_no_bytes_take_the_server_down(client, start, rest):
    with connect(client.server) as to:
        to.sendall(start + rest)
        to.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: to.recv(65536), b""))

    assert b" 200 " not in answer.partition(b"\r\n")[0]
    assert client.get("/api/jobs")[0] == 200


def test_clients_that_say_nothing_half_or_rubbish_hold_nobody_up(client, monkeypatch):
    monkeypatch.setattr(handler.Handler, "timeout", 0.3)
    with connect(client.server), connect(client.server) as half, connect(client.server) as rubbish:
        half.sendall(b"POST /api/validate HTTP/1.1\r\nHost: localh")
        rubbish.sendall(b"\x16\x03\x01" + b"\xff" * 500)

        assert client.get("/api/entries")[0] == 200
        half.settimeout(10)
        assert half.recv(1000) == b""  # its time is over


def test_a_body_that_never_comes_is_not_waited_for(server, monkeypatch):
    monkeypatch.setattr(handler.Handler, "timeout", 0.3)
    head = (
        f"POST /api/validate HTTP/1.1\r\nHost: localhost\r\nX-Ncsim-Token: {server.token}\r\n"
        "Content-Type: application/json\r\nContent-Length: 1000\r\n\r\nhalf"
    )

    assert answer_to(server, head.encode()) == b""


def test_a_client_that_does_not_read_holds_nobody_up(client, run_folder, monkeypatch):
    monkeypatch.setattr(handler.Handler, "timeout", 0.3)
    with (run_folder / "trace.jsonl").open("ab") as file:
        file.write(b" " * 20_000_000 + b"\n")
    with connect(client.server) as lazy:
        address = f"/api/trace?run=small&token={client.server.token}"
        lazy.sendall(f"GET {address} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())

        assert client.get("/api/entries")[0] == 200


def test_too_many_connections_are_turned_away_and_places_are_given_back(client, monkeypatch):
    monkeypatch.setattr(handler.Handler, "timeout", 20)
    waiting = [connect(client.server) for _ in range(serving.MAX_CONNECTIONS)]
    while client.server._free._value > 0:  # until all of them are accepted
        time.sleep(0.01)
    try:
        with connect(client.server) as one_more:
            assert one_more.recv(1000) == TOO_MANY
    finally:
        for each in waiting:
            each.__exit__(None, None, None)
    while client.server._free._value < serving.MAX_CONNECTIONS:
        time.sleep(0.01)
    assert client.get("/api/entries")[0] == 200


def test_an_error_inside_is_an_answer_and_not_the_end(client, monkeypatch):
    monkeypatch.setitem(
        handler.routes.GET, "/api/catalogue", lambda *_: (_ for _ in ()).throw(ValueError("oh"))
    )

    status, answer = client.get("/api/catalogue")

    assert (status, answer) == (500, {"error": "internal error: ValueError: oh"})
    assert client.get("/api/entries")[0] == 200
