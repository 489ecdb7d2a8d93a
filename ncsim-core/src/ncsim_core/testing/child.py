"""Asks a component the same questions in a new process, where the hash seed is another."""

import os
import pickle
import subprocess
import sys
from collections.abc import Mapping, Sequence

from ncsim_core.registry import get_registry
from ncsim_core.testing.questions import Answer, Case
from ncsim_core.testing.subject import Subject

TIMEOUT_s = 120


def answers_in_new_process(subject: Subject, cases: Sequence[Case]) -> list[Answer]:
    """Return the answers of a child process with another ``PYTHONHASHSEED``.

    Raises:
        AssertionError: The child failed.
    """
    who = (subject.component.kind, subject.registered.qualified_name)
    question = pickle.dumps((*who, dict(subject.options), dict(subject.sections), list(cases)))
    done = run_python(["-m", "ncsim_core.testing.child"], question, {"PYTHONHASHSEED": _other()})
    assert done.returncode == 0, f"in a new process: {done.stderr.decode()[-2000:]}"
    answers: list[Answer] = pickle.loads(done.stdout)
    return answers


def run_python(
    arguments: Sequence[str], stdin: bytes, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[bytes]:
    """Return what a child interpreter with our ``sys.path`` did."""
    path = os.pathsep.join(each for each in sys.path if each)
    return subprocess.run(
        [sys.executable, *arguments],
        input=stdin,
        capture_output=True,
        timeout=TIMEOUT_s,
        check=False,
        env={**os.environ, "PYTHONPATH": path, **environment},
    )


def _other() -> str:
    """Return a hash seed that is not ours."""
    return "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"


def _answer() -> None:
    answer_to = os.dup(1)
    os.dup2(2, 1)  # what a component prints is no part of the answer
    kind, name, options, sections, cases = pickle.load(sys.stdin.buffer)
    registry = get_registry()
    subject = Subject(registry, registry.find(kind, name), options, sections)
    answers = [subject.ask(subject.build(case), case) for case in cases]
    with os.fdopen(answer_to, "wb") as file:
        file.write(pickle.dumps(answers))


if __name__ == "__main__":
    _answer()
