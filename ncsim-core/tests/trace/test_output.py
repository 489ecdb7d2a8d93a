"""The folder of a run appears whole, or not at all."""

import contextlib
import errno
import gzip
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.trace.files import appearing, write_atomically
from ncsim_core.trace.output import atomic_output_folder
from ncsim_core.trace.records import TraceError


def fill(path, text="new", *, force=False):
    with atomic_output_folder(path, force=force) as folder:
        (folder / "run.json").write_text(text)


def test_the_folder_appears_when_everything_is_in_it(tmp_path):
    with atomic_output_folder(tmp_path / "deep" / "out") as folder:
        (folder / "run.json").write_text("x")
        assert not (tmp_path / "deep" / "out").exists()

    assert (tmp_path / "deep" / "out" / "run.json").read_text() == "x"
    assert [each.name for each in (tmp_path / "deep").iterdir()] == ["out"]


def test_an_error_leaves_nothing(tmp_path):
    def fail_half_way():
        with atomic_output_folder(tmp_path / "out") as folder:
            (folder / "run.json").write_text("x")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_half_way()

    assert list(tmp_path.iterdir()) == []


def test_an_existing_folder_is_refused_before_anything_runs(tmp_path):
    fill(tmp_path / "out", "old")

    with pytest.raises(ScenarioError, match="exists already; choose another name or give --force"):
        fill(tmp_path / "out")
    assert (tmp_path / "out" / "run.json").read_text() == "old"


def test_force_replaces_an_earlier_run_whole(tmp_path):
    fill(tmp_path / "out", "old")
    (tmp_path / "out" / "metrics.json").write_text("old")

    fill(tmp_path / "out", force=True)

    assert [each.name for each in (tmp_path / "out").iterdir()] == ["run.json"]
    assert [each.name for each in tmp_path.iterdir()] == ["out"]


def test_an_error_under_force_keeps_the_earlier_run(tmp_path):
    fill(tmp_path / "out", "old")

    with pytest.raises(RuntimeError), atomic_output_folder(tmp_path / "out", force=True):
        raise RuntimeError
    assert (tmp_path / "out" / "run.json").read_text() == "old"


def test_force_never_deletes_what_no_run_wrote(tmp_path):
    fill(tmp_path / "out", "old")
    (tmp_path / "out" / "thesis.tex").write_text("precious")

    with pytest.raises(ScenarioError, match=r"holds what no run wrote \(thesis\.tex\)"):
        fill(tmp_path / "out", force=True)
    assert (tmp_path / "out" / "thesis.tex").exists()


def test_force_replaces_no_file_and_no_symbolic_link(tmp_path):
    (tmp_path / "file").write_text("x")
    (tmp_path / "link").symlink_to(tmp_path / "elsewhere")

    for name in ("file", "link"):
        with pytest.raises(ScenarioError, match="is no folder"):
            fill(tmp_path / name, force=True)


def test_a_place_that_cannot_hold_a_folder_is_named(tmp_path):
    (tmp_path / "file").write_text("x")

    with pytest.raises(ScenarioError, match="file/out: cannot be written"):
        fill(tmp_path / "file" / "out")


def test_a_killed_process_leaves_no_final_name(tmp_path):
    script = (
        "import sys, time\n"
        "from pathlib import Path\n"
        "from ncsim_core.trace.output import atomic_output_folder\n"
        "with atomic_output_folder(Path(sys.argv[1])) as folder:\n"
        "    (folder / 'run.json').write_text('half')\n"
        "    print('ready', flush=True)\n"
        "    time.sleep(60)\n"
    )
    command = [sys.executable, "-c", script, str(tmp_path / "out")]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        process.send_signal(signal.SIGKILL)

    assert not (tmp_path / "out").exists()


def test_new_folders_have_the_usual_permissions(tmp_path):
    fill(tmp_path / "out")
    (tmp_path / "usual").mkdir()

    assert (tmp_path / "out").stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.parametrize("content", ["text\n", b"text\n"], ids=repr)
@pytest.mark.parametrize("name", ["a.txt", "a.txt.gz"])
def test_a_file_that_cannot_be_finished_leaves_nothing_behind(content, name, tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "write_bytes", fill_the_disk)

    with pytest.raises(TraceError, match=f"{name}: cannot be written: No space left on device"):
        write_atomically(tmp_path / name, content)

    assert not list(tmp_path.iterdir())


def fill_the_disk(path, data):
    with path.open("wb") as file:
        file.write(data[:2])
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_what_fails_within_the_block_leaves_the_earlier_file(tmp_path):
    (tmp_path / "a.txt").write_text("earlier", encoding="utf-8")

    with contextlib.suppress(ZeroDivisionError), appearing(tmp_path / "a.txt") as place:
        place.write_text("half", encoding="utf-8")
        _ = 1 / 0

    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a.txt", "earlier")]


def test_a_link_is_written_through_and_a_pipe_is_written_to(tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "far.txt")
    os.mkfifo(tmp_path / "pipe")
    reader = subprocess.Popen(["cat", tmp_path / "pipe"], stdout=subprocess.PIPE)

    for name in ("link", "pipe"):
        write_atomically(tmp_path / name, "text\n")

    assert reader.communicate(timeout=60)[0] == b"text\n"
    assert (tmp_path / "far.txt").read_text(encoding="utf-8") == "text\n"
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "pipe").is_fifo()


def test_standard_output_may_be_given_as_a_file():
    write = "from pathlib import Path; from ncsim_core.trace.files import write_atomically as write"
    command = f"{write}; write(Path('/dev/stdout'), 'text')"
    done = subprocess.run([sys.executable, "-c", command], capture_output=True, check=True)

    assert done.stdout == b"text"


def test_compressed_text_does_not_depend_on_the_clock(tmp_path):
    for name in ("a.gz", "b.gz"):
        write_atomically(tmp_path / name, "text\n")

    assert gzip.decompress((tmp_path / "a.gz").read_bytes()) == b"text\n"
    assert (tmp_path / "a.gz").read_bytes() == (tmp_path / "b.gz").read_bytes()


def test_single_files_appear_whole_too(tmp_path):
    write_atomically(tmp_path / "a.txt", "text\n")

    assert (tmp_path / "a.txt").read_bytes() == b"text\n"
    assert [each.name for each in tmp_path.iterdir()] == ["a.txt"]
