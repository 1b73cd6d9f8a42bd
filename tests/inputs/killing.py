"""Writers of files, each killed before each of its changes in turn.

    python tests/inputs/killing.py WRITER FOLDER

Prints how often the writer was killed. Raises AssertionError if a file is neither the old version nor the new, or if
the writer does not end with the files of an undisturbed writer. A process without threads forks for each kill, so
that slow imports happen only once.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
from collections.abc import Callable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
# No thread of OpenBLAS, nor of the allocator that pandas brings with it.
os.environ |= {"OPENBLAS_NUM_THREADS": "1", "JE_ARROW_MALLOC_CONF": "background_thread:false"}
import both_ways
import devices
import matplotlib

from normalbench.bench.door.code_rows import save
from normalbench.bench.ground.output import cache
from normalbench.bench.keep import row_files
from normalbench.bench.keep.runs import opened, read_run
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.isa import null_device
from normalbench.bench.show.import_command import import_command
from normalbench.bench.show.report import write_report
from normalbench.bench.show.site_command import site_command
from normalbench.bench.tables.table import Step
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

CHANGES = {"os.rename", "os.remove", "os.mkdir", "os.rmdir"}
WRITES = os.O_WRONLY | os.O_RDWR
FACTS = {"request": {"tables": ["depth"]}, "sources": "abc", "machine": {}, "command": ["run"], "finished": False}
ROWS = [Step({"number": number}, None, "") for number in range(4)]


def keep_rows(folder: Path, count: int = len(ROWS)) -> None:
    """Keep the missing rows as `run` does, and then the mark that the run is finished."""
    rows = both_ways.rows_of_tables()["depth"]
    with opened(folder / "run", FACTS) as run:
        for step, row in zip(ROWS[:count], rows, strict=False):
            if run.find("depth", step) is None:
                run.keep("depth", step, [row])
        if count == len(ROWS):
            run.finish()


def rows_are_whole(folder: Path, before: Mapping[str, bytes], after: Mapping[str, bytes]) -> None:
    """Check that rows are in order and that no earlier row is lost."""
    now = (folder / "run/rows.jsonl").read_bytes()
    lines = len(read_run(folder / "run").steps)
    assert before["run/rows.jsonl"].count(b"\n") <= lines
    assert after["run/rows.jsonl"].splitlines()[:lines] == now.splitlines()[:lines]


def a_run(folder: Path) -> None:
    """Write a finished run and the file of a device."""
    keep_rows(folder)
    devices.write(folder / "device.json")


def import_a_device(folder: Path) -> None:
    import_command([folder / "device.json"], folder / "run")


def import_is_whole(folder: Path, before: Mapping[str, bytes], after: Mapping[str, bytes]) -> None:
    """Check that the run has all of the device's rows or none."""
    assert (folder / "run/rows.jsonl").read_bytes() in (before["run/rows.jsonl"], after["run/rows.jsonl"])
    done = read_run(folder / "run")
    assert done.finished and not done.damage


def report(folder: Path) -> None:
    # Else each drawing has names and a time of its own.
    matplotlib.rcParams["svg.hashsalt"] = os.environ["SOURCE_DATE_EPOCH"] = "0"
    write_report(folder / "run", read_run(folder / "run"), folder / "page.html")


def site(folder: Path) -> None:
    site_command([folder / "devices"], folder / "site")


def another_site(folder: Path) -> None:
    """Write the site of a device, and the files of this device and another."""
    devices.write(folder / "devices/a.json")
    site(folder)
    devices.write(folder / "devices/a.json", made="2026-11-24T15:00:00Z", truncated=("RG8",))
    devices.write(folder / "devices/b.json", renderer=devices.MALI)


def code(folder: Path) -> None:
    save(code_of(Codec(ENCODINGS["best_fit"], STORAGES["rgba8"]), "glsl", ""), [], folder)


def table(folder: Path) -> None:
    for ending in ("csv", "json"):
        row_files.write(
            [{"number": number, "half": number / 2} for number in range(1000)], ending, folder / f"rows.{ending}"
        )


def value(folder: Path) -> None:
    os.environ["XDG_CACHE_HOME"] = str(folder)
    cache.write(cache.key_of("a value"), {"number": 1})


def library(folder: Path) -> None:
    os.environ["XDG_CACHE_HOME"] = str(folder)
    null_device.library()


Check = Callable[[Path, Mapping[str, bytes], Mapping[str, bytes]], None]


def files_are_whole(folder: Path, before: Mapping[str, bytes], after: Mapping[str, bytes]) -> None:
    """Check that each file is the old version or the new version."""
    for name, content in files(folder).items():
        assert content in (before.get(name), after.get(name)), name


# By name a writer, what is there before, and the check of what it leaves where it is killed. Where nothing is said of
# what is there, each file that it will write is empty.
WRITERS: dict[str, tuple[Callable[[Path], None], Callable[[Path], None] | None, Check]] = {
    "rows": (keep_rows, lambda folder: keep_rows(folder, 2), rows_are_whole),
    "import": (import_a_device, a_run, import_is_whole),
    "page and charts": (report, keep_rows, files_are_whole),
    "site": (site, another_site, files_are_whole),
    "code": (code, None, files_are_whole),
    "table": (table, None, files_are_whole),
    "cache": (value, None, files_are_whole),
    "library": (library, None, files_are_whole),
}


def files(folder: Path) -> dict[str, bytes]:
    """Return the files that readers see, without the folder's path in them; files being written are left out."""
    paths = {str(path.relative_to(folder)): path for path in folder.rglob("*") if path.is_file()}
    here = str(folder).encode()
    return {name: path.read_bytes().replace(here, b"") for name, path in paths.items() if not is_partial(name)}


def is_partial(name: str) -> bool:
    return ".partial" in name or any(part.startswith("tmp") for part in Path(name).parts)


def die(written: str | int) -> None:
    """Kill this process as if a file, given by name or descriptor, were partly written."""
    if isinstance(written, int):
        os.truncate(written, os.fstat(written).st_size - 3)
    elif Path(written).is_file():
        os.truncate(written, Path(written).stat().st_size // 2)
    os.kill(os.getpid(), signal.SIGKILL)


def end_before(number: int, folder: Path) -> None:
    """End this process before one of its changes below a folder."""
    left = [number]

    def count(written: str | int) -> None:
        left[0] -= 1
        if not left[0]:
            die(written)

    def hook(event: str, arguments: tuple) -> None:
        writes = event == "open" and isinstance(arguments[2], int) and arguments[2] & WRITES
        if left[0] > 0 and (event in CHANGES or writes) and str(arguments[0]).startswith(str(folder)):
            count(str(arguments[0]) if event == "os.rename" else "")

    fsync = os.fsync

    def synced(descriptor: int) -> None:
        if left[0] > 0:
            count(descriptor)
        fsync(descriptor)

    sys.addaudithook(hook)
    os.fsync = synced


def is_killed(write: Callable[[Path], None], folder: Path, number: int = 0) -> bool:
    """Run a writer in its own process, killed before change `number` if it exists; return whether it was killed."""
    process = os.fork()
    if not process:
        if number:
            end_before(number, folder)
        with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
            write(folder)
        os._exit(0)
    status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    assert status in (0, -signal.SIGKILL), status
    return status != 0


def fresh(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def import_what_it_takes(write: Callable[[Path], None], prepare: Callable[[Path], None] | None, folder: Path) -> None:
    """Run a writer once in this process, because its imports and first reads take most of its time and every fork
    would repeat them. Raises AssertionError if a thread results, which no fork would have."""
    fresh(folder)
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
        if prepare:
            prepare(folder)
        write(folder)
    threads = [path.read_text().strip() for path in Path("/proc/self").glob("task/*/comm")]
    assert len(threads) <= 1, f"threads that no fork would have: {threads}"


def main(name: str, folder: Path) -> None:
    write, prepare, check = WRITERS[name]
    # A site computes by JAX, whose threads no fork would have: each one starts it anew.
    if name != "site":
        import_what_it_takes(write, prepare, folder / "first")
    undisturbed, killed = folder / "undisturbed", folder / "killed"
    fresh(undisturbed)
    if prepare:
        prepare(undisturbed)
    assert not is_killed(write, undisturbed)
    after, number = files(undisturbed), 0
    while True:
        fresh(killed)
        if prepare:
            prepare(killed)
        else:
            for path in after:
                (killed / path).parent.mkdir(parents=True, exist_ok=True)
                (killed / path).touch()
        before, number = files(killed), number + 1
        if not is_killed(write, killed, number):
            break
        check(killed, before, after)
        assert not is_killed(write, killed) and files(killed) == after, f"change {number}"
        assert name in ("cache", "library") or not [*killed.rglob("*.partial")], f"change {number}: something is left"
    print(json.dumps(number - 1))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]).resolve())
