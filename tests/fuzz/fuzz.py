"""Fuzz one target for some minutes: ``python tests/fuzz/fuzz.py scenario_yaml --minutes 30``.

Guided by coverage with atheris (``pip install atheris``); without it, by chance alone. What breaks
is left in ``/tmp/ncsim-fuzz/TARGET/``; inputs that reach new code go to ``corpus/`` in there, which
``--minimise`` thins out into ``tests/fuzz/corpus/TARGET/``. Memory is limited to 1 GB, a single
input to 15 minutes by the clock, for machines are shared.
"""

import argparse
import contextlib
import importlib.util
import os
import random
import re
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

HERE: Final = Path(__file__).parent
WORK: Final = Path("/tmp/ncsim-fuzz")
MEMORY_BYTES: Final = 1 << 30
SECONDS_PER_INPUT: Final = 900
MAX_BYTES: Final = 12_000
ODD_VALUES: Final = (HERE / "odd_values.txt").read_text("utf-8").split()
SEEDS: Final = {
    "scenario_yaml": ("examples/*.yaml", "ncsim-core/tests/scenario/bad/*.yaml"),
    "published": ("examples/published-form/*.yaml",),
    "sweep": ("examples/paper/*.yaml", "examples/random-networks/*.yaml"),
    "workflow": ("examples/workflows/*.json",),
    "trace": ("tests/integration/data/*.jsonl",),
}
"""Files of the repository that a target begins with, besides its own corpus."""
TOKEN: Final = re.compile(rb'"[^"\n]*"|[-+.\w]+')


def main() -> None:
    """Fuzz, or thin out a corpus."""
    options = parser().parse_args()
    corpus = WORK / options.target / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    if options.minimise:
        minimise(options.target, corpus)
        return
    begin_with_seeds(options.target, corpus)
    if importlib.util.find_spec("atheris") is None:
        fuzz_by_chance(options.target, corpus, options.minutes * 60)
    else:
        fuzz_by_coverage(options.target, corpus, int(options.minutes * 60))


def parser() -> argparse.ArgumentParser:
    """Return the reader of the command line."""
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("target")
    reader.add_argument("--minutes", type=float, default=30.0)
    reader.add_argument("--minimise", action="store_true", help="write tests/fuzz/corpus/TARGET")
    return reader


def target_named(name: str) -> Callable[[bytes], None]:
    """Return a target."""
    sys.path.insert(0, str(HERE))
    from targets import TARGETS

    return TARGETS[name]


def begin_with_seeds(name: str, corpus: Path) -> None:
    """Put the checked-in corpus and files of the repository where fuzzing begins."""
    given = [path for pattern in SEEDS.get(name, ()) for path in HERE.parents[1].glob(pattern)]
    for path in [*given, *(HERE / "corpus" / name).glob("*")]:
        (corpus / path.name).write_bytes(path.read_bytes())


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Return the text with lines and tokens moved, dropped, doubled or replaced."""
    for _ in range(chance.choice((1, 1, 2, 4))):
        if chance.random() < 0.5:
            data = _with_odd_token(data, chance)
        else:
            data = _with_lines_moved(data, chance)
    return data


def _with_odd_token(data: bytes, chance: random.Random) -> bytes:
    found = list(TOKEN.finditer(data))
    if not found:
        return data
    spot = chance.choice(found)
    others = [chance.choice(ODD_VALUES).encode(), chance.choice(found)[0]]
    return data[: spot.start()] + chance.choice(others) + data[spot.end() :]


def _with_lines_moved(data: bytes, chance: random.Random) -> bytes:
    lines = data.split(b"\n")
    one, other = (chance.randrange(len(lines)) for _ in range(2))
    action = chance.randrange(4)
    if action == 0:
        del lines[one]
    elif action == 1:
        lines.insert(other, lines[one])
    elif action == 2:
        lines[one], lines[other] = lines[other], lines[one]
    else:
        lines[one] = b" " * chance.choice((0, 2, 4)) + lines[one].strip()
    return b"\n".join(lines)


def fuzz_by_coverage(name: str, corpus: Path, seconds: int) -> None:
    """Let libFuzzer choose what to keep; half of the changes are made by ``mutated``."""
    import atheris

    with atheris.instrument_imports(include=["ncsim_core", "ncsim_viz"]):
        target = target_named(name)

    def mutate(data: bytes, max_size: int, seed: int) -> bytes:
        chance = random.Random(seed)
        if chance.random() < 0.3:
            return atheris.Mutate(data, max_size)
        return mutated(data, chance)[:max_size]

    limits = [
        f"-max_total_time={seconds}",
        f"-timeout={SECONDS_PER_INPUT}",
        f"-max_len={MAX_BYTES}",
    ]
    places = [f"-artifact_prefix={corpus.parent}/", f"-rss_limit_mb={MEMORY_BYTES >> 20}"]
    arguments = [sys.argv[0], *limits, *places, "-print_final_stats=1", str(corpus)]
    atheris.Setup(arguments, target, custom_mutator=mutate)
    atheris.Fuzz()


def fuzz_by_chance(name: str, corpus: Path, seconds: float) -> None:
    """Change files of the corpus at random; keep what breaks."""
    target, chance = target_named(name), random.Random()
    _limit_memory()
    texts = [path.read_bytes() for path in corpus.iterdir()]
    deadline_s, count = time.monotonic() + seconds, 0
    while time.monotonic() < deadline_s:
        data, count = mutated(chance.choice(texts), chance), count + 1
        try:
            target(data)
        except Exception:
            (corpus.parent / f"crash-{count}").write_bytes(data)
            raise
    sys.stdout.write(f"{count} inputs, nothing broke\n")


def _limit_memory() -> None:
    pages = int(Path("/proc/self/statm").read_text("utf-8").split()[0])
    limit = pages * os.sysconf("SC_PAGESIZE") + MEMORY_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


def minimise(name: str, corpus: Path) -> None:
    """Keep the smallest files that together reach every line that the corpus reaches."""
    target = target_named(name)
    left = {path: _lines_reached(target, path.read_bytes()) for path in corpus.iterdir()}
    reached: set[tuple[str, int]] = set()
    kept = HERE / "corpus" / name
    kept.mkdir(parents=True, exist_ok=True)
    for path in sorted(left, key=lambda each: (each.stat().st_size, each.name)):
        if not left[path] <= reached:
            reached |= left[path]
            (kept / path.name).write_bytes(path.read_bytes())
    kept_count = len(list(kept.iterdir()))
    sys.stdout.write(f"{name}: {kept_count} files of {len(left)}, {len(reached)} lines\n")


def _lines_reached(target: Callable[[bytes], None], data: bytes) -> set[tuple[str, int]]:
    lines: set[tuple[str, int]] = set()

    def follow(frame, event, argument):
        if "ncsim_" not in frame.f_code.co_filename:
            return None
        if event == "line":
            lines.add((frame.f_code.co_filename, frame.f_lineno))
        return follow

    sys.settrace(follow)
    try:
        with contextlib.suppress(Exception):
            target(data)
    finally:
        sys.settrace(None)
    return lines


if __name__ == "__main__":
    main()
