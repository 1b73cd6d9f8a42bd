"""Put each fault of fault_list.py into a tree, run the tests that should notice it, and count the results.

    python tests/faults.py [--tree DIR] [--blind] [--tier TIER] [--only NAME,...] [--results FILE] [--skip] [--check]

This is not part of the tests: a run takes half an hour, and changes files of the tree meanwhile. Each file is
restored however the run ends, except after `kill -9`; then `git diff` shows the fault. With --results a stopped run
continues. At the end the tests that noticed a fault are run without it: a test that fails then has noticed nothing.
Exit status: 0 if every fault was noticed, 1 if not, 2 if the text of a fault does not occur exactly once in the tree.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from fault_list import FAULTS, Fault
from fault_list_blind import FAULTS_B
from tiers import TIERS, files_of, is_in

ROOMS = ("encodings", "gbuffer", "bench", "reports")
# No selection of tests takes so long: what does hangs, and is noticed by that.
LIMIT_S = 900
# Exit statuses of pytest: all is well, and no test was chosen; and those that are about how it was called.
PASSED, NOTHING_CHOSEN, MISUSED = 0, 5, (3, 4)
FAILED = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


class Place(NamedTuple):
    """The place of a fault: its file, and the text of the file with the fault."""

    path: Path
    faulty: str


@dataclass(frozen=True)
class Tree:
    """A checkout, and the Python that its package is installed for."""

    root: Path
    python: Path
    tier: str = TIERS[-1]

    def product(self) -> dict[Path, str]:
        """Return the text of every file of the product."""
        files = (path for room in ROOMS for path in (self.root / room).rglob("*.*"))
        return {path: path.read_text(encoding="utf-8") for path in files if "__pycache__" not in path.parts}

    def tests(self, names: str) -> list[str]:
        """Return the paths of test files by their names, or all tests for an empty text; skip missing files."""
        if not names:
            return ["tests"]
        files = (path for name in names.split() for path in files_of(self.root / "tests", Path(name).stem))
        return [str(path.relative_to(self.root)) for path in files if is_in(path, self.tier)]


@dataclass(frozen=True)
class Result:
    """The result of a fault: `by` is the first test that failed or other evidence; empty if nothing noticed it."""

    fault: str
    room: str
    kind: str
    by: str
    seconds: float
    new: str


def place_of(fault: Fault, product: Mapping[Path, str]) -> Place | str:
    """Return the place of a fault, or a message if its text does not occur exactly once."""
    counts = []
    for old, new in ((fault.old, fault.new), *fault.also):
        paths = [path for path, text in product.items() if old in text]
        counts.append(sum(product[path].count(old) for path in paths))
        if counts[-1] == 1:
            return Place(paths[0], product[paths[0]].replace(old, new))
    return f"{fault.name}: its text is there {' and '.join(map(str, counts))} times, not once"


@contextmanager
def injected(place: Place) -> Iterator[None]:
    """Put a fault into its file; then restore the file and its modification time, on which byte code depends."""
    before, times = place.path.read_bytes(), place.path.stat()
    try:
        place.path.write_bytes(place.faulty.encode())
        yield
    finally:
        place.path.write_bytes(before)
        os.utime(place.path, ns=(times.st_atime_ns, times.st_mtime_ns))


@contextmanager
def environment() -> Iterator[dict[str, str]]:
    """Yield the environment of the tests, with a temporary cache folder, so that no effect of a fault persists."""
    home = Path("~/.cache").expanduser()
    # What these keep is known by its content, and takes long to make again.
    shared = {"MESA_SHADER_CACHE_DIR": str(home), "MPLCONFIGDIR": str(home / "matplotlib")}
    shared["JAX_COMPILATION_CACHE_DIR"] = str(home / "normalbench-tests" / "jax")
    with tempfile.TemporaryDirectory(prefix="faults-", ignore_cleanup_errors=True) as cache:
        yield shared | os.environ | {"XDG_CACHE_HOME": cache, "PYTHONDONTWRITEBYTECODE": "1"}


def ran(tree: Tree, arguments: Sequence[str], limit: float | None) -> tuple[int, str] | None:
    """Return the status and output of pytest; None if it took longer than the limit."""
    command = [str(tree.python), "-m", "pytest", "-q", "--tier", tree.tier, "--tb=no", "-rfE", *arguments]
    with environment() as given:
        process = subprocess.Popen(
            command,
            cwd=tree.root,
            env=given,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            output, _ = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            return None
        finally:
            _end(process)
    return process.returncode, output


def _end(process: subprocess.Popen[str]) -> None:
    """Kill a process that this script started, if it is still running, with all its child processes."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def noticed_by(tree: Tree, names: str, chosen: str) -> str:
    """Return the first failure of the chosen tests; an empty text if all pass."""
    files = tree.tests(names)
    if not files:
        return ""
    done = ran(tree, ["-x", *(["-k", chosen] if chosen else []), *files], LIMIT_S)
    if done is None:
        return f"the limit of {LIMIT_S} s"
    status, output = done
    if status in MISUSED:
        raise RuntimeError(output)
    if status in (PASSED, NOTHING_CHOSEN):
        return ""
    match = FAILED.search(output)
    return match[1] if match else f"status {status}"


def tried(tree: Tree, fault: Fault, place: Place) -> Result:
    """Return the result of a fault with its own tests, or with the wider tests if its own tests notice nothing."""
    start = time.monotonic()
    with injected(place):
        by = noticed_by(tree, fault.tests, fault.chosen)
        if not by and fault.wider:
            by = noticed_by(tree, f"{fault.tests} {fault.wider}", "")
    return Result(fault.name, fault.room, fault.kind, by, round(time.monotonic() - start, 1), fault.new)


def failing_without(tree: Tree, results: Sequence[Result]) -> set[str]:
    """Return the tests that noticed a fault but also fail without a fault."""
    tests = list(dict.fromkeys(result.by for result in results if "::" in result.by))
    done = ran(tree, tests, None) if tests else None
    return set(FAILED.findall(done[1])) if done else set()


def read_results(path: Path | None) -> dict[str, Result]:
    """Return the results of an earlier run, by fault."""
    if not path or not path.exists():
        return {}
    lines: list[dict[str, Any]] = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {line["fault"]: Result(**line) for line in lines}


def results_of(tree: Tree, placed: Sequence[tuple[Fault, Place]], path: Path | None) -> Iterator[Result]:
    """Yield the result of each fault: from the file if it has one, otherwise from a new trial."""
    kept = read_results(path)
    for fault, place in placed:
        if fault.name in kept and kept[fault.name].new == fault.new:
            yield kept[fault.name]
            continue
        result = tried(tree, fault, place)
        if path:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(asdict(result)) + "\n")
        yield result


def line_of(result: Result) -> str:
    """Return a result as a line of the table."""
    by = result.by or "NOTHING of this tier"
    return f"{result.fault:<32} {result.room:<10} {result.kind:<24} {result.seconds:>6.1f} s  {by}"


def chosen_faults(faults: Sequence[Fault], only: str) -> list[Fault]:
    """Return the faults of a list that were requested. Raises SystemExit for an unknown name."""
    names = [name for name in only.split(",") if name]
    unknown = set(names) - {fault.name for fault in faults}
    if unknown:
        raise SystemExit(
            f"no fault {', '.join(sorted(unknown))}; the names stand in {Path(__file__).parent}/fault_list*.py"
        )
    return [fault for fault in faults if not names or fault.name in names]


def arguments() -> argparse.Namespace:
    """Return the command-line arguments."""
    here = Path(__file__).parents[1]
    parser = argparse.ArgumentParser(
        description="Put faults into files of a checkout, one after the other, and count those that its tests notice. "
        "All of them take half an hour."
    )
    parser.add_argument("--tree", type=Path, default=here, help="The checkout. Default: this one.")
    parser.add_argument("--python", type=Path, help="Its Python. Default: the one of its .venv.")
    parser.add_argument("--blind", action="store_true", help="Those of fault_list_blind.py, with all tests.")
    parser.add_argument("--tier", choices=TIERS, default=TIERS[-1], help="The last tier of tests that are run.")
    parser.add_argument("--only", default="", help="Names of faults, comma-separated.")
    parser.add_argument("--results", type=Path, help="JSON lines to go on from, and to write.")
    parser.add_argument("--skip", action="store_true", help="Leave out what has no place: another version may lack it.")
    parser.add_argument("--check", action="store_true", help="See that every fault has its one place, and end.")
    return parser.parse_args()


def _terminated(number: int, _: object) -> NoReturn:
    raise SystemExit(128 + number)


def main() -> int:
    """Check that every fault can be placed, then try each fault. Return the exit status."""
    asked = arguments()
    root = asked.tree.resolve()
    tree = Tree(root, asked.python or root / ".venv" / "bin" / "python", asked.tier)
    product = tree.product()
    faults = [
        (fault, place_of(fault, product)) for fault in chosen_faults(FAULTS_B if asked.blind else FAULTS, asked.only)
    ]
    misplaced = [place for _, place in faults if isinstance(place, str)]
    print("\n".join([*misplaced, f"{len(faults) - len(misplaced)} of {len(faults)} faults have their place."]))
    if misplaced:
        print("Is a fault of an earlier run in the tree? `git diff` shows it.")
    if asked.check or (misplaced and not asked.skip):
        return 2 if misplaced else 0
    # A terminated run puts the file back as an interrupted one does.
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _terminated)
    results = []
    placed = [(fault, place) for fault, place in faults if isinstance(place, Place)]
    for result in results_of(tree, placed, asked.results):
        results.append(result)
        print(line_of(result), flush=True)
    return counted(results, failing_without(tree, results))


def counted(results: Sequence[Result], failing: set[str]) -> int:
    """Print the summary and return the exit status."""
    for test in sorted(failing):
        print(f"fails without a fault: {test}")
    noticed = [result for result in results if result.by and result.by not in failing]
    for room in ROOMS:
        of_room = [result for result in results if result.room == room]
        print(f"{room}: {sum(result in noticed for result in of_room)} of {len(of_room)}")
    print(f"{len(noticed)} noticed of {len(results)}")
    return int(len(noticed) < len(results))


if __name__ == "__main__":
    sys.exit(main())
