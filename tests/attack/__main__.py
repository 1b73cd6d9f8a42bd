"""Make the cases of every kind from seeds, try them, and print a table of how they ended.

    python -m tests.attack [--cases N] [--only WORD,...] [--results FILE] [--seed N]

100,000 cases take about twenty minutes on two cores. With --results a stopped attack continues. Exit status: 0 if
every case was measured or refused in one line, 1 if not.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from pathlib import Path

HERE = Path(__file__).parent
for folder in (HERE.parent, HERE.parent / "inputs"):
    sys.path.insert(0, str(folder))

from attack.translations import TRANSLATION, written_here  # noqa: E402 # likewise
from attack.trying import ODD, Chunk, chunks_of, limit_of  # noqa: E402 # the folders above hold it

Results = dict[str, dict[str, int]]


def main() -> int:
    """Run the attack and return the exit status."""
    asked = _asked()
    chunks = [chunk for chunk in chunks_of(asked.cases, asked.seed) if _is_named(chunk, asked.only)]
    if any(chunk.kind == TRANSLATION for chunk in chunks):
        print(*written_here()[1], sep="\n", file=sys.stderr)
    done = _read(asked.results)
    left = [chunk for chunk in chunks if chunk.name not in done]
    for chunk, counts, lines in _each(left):
        done[chunk.name] = dict(counts)
        _keep(asked.results, chunk, counts, lines)
        print(f"{chunk.name}: {dict(counts)}", file=sys.stderr)
        for line in lines:
            print(f"  {line}", file=sys.stderr)
    totals = _totals(chunks, done)
    _print(totals)
    return int(any(counts[ODD] for counts in totals.values()))


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.attack", description=__doc__, add_help=True)
    parser.add_argument("--cases", type=int, default=100_000, help="How many in all, in proportion. Default: 100000.")
    parser.add_argument("--only", default="", help="Kinds whose names hold one of these words.")
    parser.add_argument("--results", type=Path, help="A file of what is done; with it, what was ended goes on.")
    parser.add_argument("--seed", type=int, default=0, help="The first seed of every kind.")
    return parser.parse_args()


def _is_named(chunk: Chunk, only: str) -> bool:
    return not only or any(word.strip() in chunk.kind for word in only.split(","))


def _each(chunks: list[Chunk]) -> Iterator[tuple[Chunk, Counter[str], list[str]]]:
    """Yield each chunk with its counts; two chunks run at once, in separate processes. A chunk whose process dies is
    tried in halves, down to single cases."""
    with ThreadPoolExecutor(2) as pool:
        left = {pool.submit(_alone, chunk): chunk for chunk in chunks}
        while left:
            for future in wait(left, return_when=FIRST_COMPLETED).done:
                chunk, answer = left.pop(future), future.result()
                if answer:
                    yield chunk, *answer
                elif chunk.count == 1:
                    yield chunk, Counter({ODD: 1}), ["the process died, or did not end"]
                else:
                    left |= {pool.submit(_alone, half): half for half in chunk.halves()}


def _alone(chunk: Chunk) -> tuple[Counter[str], list[str]] | None:
    """Return how the cases of a chunk ended; None if their process crashed or did not end."""
    command = [sys.executable, str(HERE / "trying.py"), chunk.kind, str(chunk.first), str(chunk.count)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=limit_of(chunk))
        counts, lines = json.loads(done.stdout)
    except (subprocess.TimeoutExpired, ValueError):
        return None
    return Counter(counts), lines


def _read(path: Path | None) -> Results:
    if not path or not path.exists():
        return {}
    lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {line["chunk"]: line["counts"] for line in lines}


def _keep(path: Path | None, chunk: Chunk, counts: Counter[str], said: list[str]) -> None:
    if path:
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"chunk": chunk.name, "counts": dict(counts), "said": said}) + "\n")


def _totals(chunks: list[Chunk], done: Results) -> dict[str, Counter[str]]:
    totals: dict[str, Counter[str]] = {}
    for chunk in chunks:
        totals.setdefault(chunk.kind, Counter()).update(done.get(chunk.name, {}))
    return totals


def _print(totals: dict[str, Counter[str]]) -> None:
    width = max(map(len, totals), default=4)
    print(f"{'kind':{width}}  {'cases':>7} {'refused':>8} {'measured':>9} {'else':>5}")
    for name, counts in [*totals.items(), ("all", sum(totals.values(), Counter()))]:
        shown = (sum(counts.values()), counts["refused"], counts["measured"], counts[ODD])
        print(f"{name:{width}}  {shown[0]:7d} {shown[1]:8d} {shown[2]:9d} {shown[3]:5d}")


if __name__ == "__main__":
    sys.exit(main())
