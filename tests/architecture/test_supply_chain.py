"""What the code may reach for: no pickles of others, no network, safe YAML, SQL with parameters."""

import ast
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = sorted(path for path in ROOT.glob("ncsim-*/src/**/*.py"))
NETWORK = {"socket", "ssl", "http", "urllib", "requests", "ftplib", "smtplib", "asyncio", "httpx"}
PICKLES = {"pickle", "marshal", "shelve", "dill"}
OWN_CHILD = {  # what a process asks its own child, and gets back from it
    "ncsim_core/testing/child.py",
    "ncsim_core/testing/suites/base.py",
}


def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def name_of(path):
    return path.relative_to(path.parents[[p.name for p in path.parents].index("src")]).as_posix()


def imports_of(path):
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            yield from (each.name.partition(".")[0] for each in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").partition(".")[0]


def test_only_the_viewer_server_imports_anything_of_the_network():
    users = {name_of(path) for path in SOURCES if NETWORK & set(imports_of(path))}

    assert all(name.startswith("ncsim_viz/server/") for name in users), users


def test_pickles_are_read_only_from_our_own_child_processes():
    users = {name_of(path) for path in SOURCES if PICKLES & set(imports_of(path))}

    assert users <= OWN_CHILD


def calls_in(path):
    return [node for node in ast.walk(tree_of(path)) if isinstance(node, ast.Call)]


def called(call):
    function = call.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def test_nothing_is_evaluated_and_no_shell_is_used():
    for path in SOURCES:
        for call in calls_in(path):
            if isinstance(call.func, ast.Name):
                assert call.func.id not in {"eval", "exec", "__import__"}, name_of(path)
            assert called(call) not in {"system", "popen"}, name_of(path)
            assert not any(each.arg == "shell" for each in call.keywords), name_of(path)


def test_yaml_is_read_by_the_safe_loaders_only():
    for path in SOURCES:
        text = path.read_text(encoding="utf-8")
        if "yaml" in set(imports_of(path)):
            for unsafe in (
                "yaml.load(",
                "yaml.unsafe",
                "FullLoader",
                "UnsafeLoader",
                "yaml.Loader",
            ):
                assert unsafe not in text, (name_of(path), unsafe)


def is_fixed(node, local):
    """Return whether a text is made of constants of the module, and of question marks."""
    if isinstance(node, ast.Constant):
        return True
    if isinstance(node, ast.Name):
        return node.id.isupper() or (node.id in local and is_fixed(local[node.id], local))
    if isinstance(node, ast.JoinedStr):
        parts = [each.value for each in node.values if isinstance(each, ast.FormattedValue)]
        return all(is_fixed(each, local) for each in parts)
    if isinstance(node, ast.Call) and called(node) == "join":
        return all(map(is_of_constants, node.args))
    return isinstance(node, ast.BinOp) and is_fixed(node.left, local)


def is_of_constants(node):
    """Return whether question marks are joined, or the names of our own columns."""
    names = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
    return "'?'" in ast.unparse(node) or names <= {"ResultRow", "name"}


def test_sql_is_fixed_text_and_values_are_parameters():
    checked = 0
    for path in SOURCES:
        if "sqlite3" not in set(imports_of(path)):
            continue
        for function in ast.walk(tree_of(path)):
            if not isinstance(function, ast.FunctionDef):
                continue
            local = {
                target.id: node.value
                for node in ast.walk(function)
                if isinstance(node, ast.Assign)
                for target in node.targets
                if isinstance(target, ast.Name)
            }
            for call in (node for node in ast.walk(function) if isinstance(node, ast.Call)):
                if called(call).startswith("execute"):
                    checked += 1
                    assert is_fixed(call.args[0], local), ast.unparse(call)

    assert checked > 5


WITHOUT_SOCKETS = """
import socket, sys
def refuse(*_, **__):
    raise AssertionError("a socket was opened")
socket.socket.__init__ = refuse
socket.create_connection = socket.getaddrinfo = refuse
from ncsim_core.cli.main import main
main(sys.argv[1:])
"""
SWEEP = """
sweep:
  base:
    network: {type: line, nodes: 2}
    dags: {type: chain, tasks: 2}
    config: {scheduler: heft, interference: csma_bianchi, routing: minimum_hop}
  replicate: {seeds: 2}
"""


VERBS = (  # each takes what those before it left
    "run {root}/examples/two_hop.yaml -o {here}/out",
    "sweep {here}/sweep.yaml -o {here}/study --executor serial",
    "report {here}/study",
    "explain {here}/out",
    "view {here}/out --output {here}/page.html",
    "doctor",
)


def test_verbs_open_no_socket(tmp_path):
    (tmp_path / "sweep.yaml").write_text(SWEEP, encoding="utf-8")
    for verb in VERBS:
        words = verb.format(root=ROOT, here=tmp_path).split()
        done = subprocess.run(
            [sys.executable, "-c", WITHOUT_SOCKETS, *words],
            capture_output=True,
            text=True,
            check=False,
        )

        assert done.returncode == 0, (verb, done.stderr)
