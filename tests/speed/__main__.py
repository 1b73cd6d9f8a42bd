"""A command that measures the program itself and prints the rows of one run as JSON.

    python -m tests.speed commands [--only NAMES]
    python -m tests.speed throughput [--encoding NAMES] [--counts COUNTS]
    python -m tests.speed growth [--over KINDS] [--sizes SIZES]
    python -m tests.speed simulate [--record TABLES] [--file FILE]

`commands` measures the wall and processor seconds of commands, as a user types them. `throughput` measures rows of
the quality table, in turn with a C program, NumPy and reading the input. `growth` times one kind of work at several
sizes. `simulate` computes how long a run takes on many workers, from recorded times of steps. Names, counts and sizes
are comma-separated.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

from normalbench.bench.ground.choose import choose
from normalbench.bench.ground.options.counts import checked_numbers
from normalbench.bench.ground.options.words import names
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.names import codecs_named

from . import commands, growth, simulate, throughput
from .timing import Row

# What a machine holds in memory at once.
MOST = 2**28
RECORD = Path(__file__).with_name("record.json")


def _commands(asked: argparse.Namespace) -> list[Row]:
    return commands.rows(tuple(choose("command", names(asked.only), {name: name for name in commands.COMMANDS})))


def _throughput(asked: argparse.Namespace) -> list[Row]:
    encodings = [codec.encoding for codec in codecs_named(names(asked.encoding), (throughput.STORAGE,), ("nearest",))]
    counts = checked_numbers("--counts", names(asked.counts), int, throughput.WHOLE, MOST)
    return throughput.rows(encodings, counts)


def _growth(asked: argparse.Namespace) -> list[Row]:
    kinds = choose("kind", names(asked.over), {name: name for name in growth.KINDS})
    if asked.sizes and len(kinds) > 1:
        raise UsageError(f"--sizes {asked.sizes}: sizes are of one kind; name it, such as --over {kinds[0]}")
    return [row for kind in kinds for row in growth.rows(kind, _sizes(kind, asked.sizes))]


def _sizes(kind: str, asked: str) -> tuple[int, ...]:
    known = growth.KINDS[kind]
    return checked_numbers("--sizes", names(asked), int, known.least, known.most) if asked else known.usual


def _simulate(asked: argparse.Namespace) -> list[Row]:
    if asked.record:
        simulate.record(asked.record.split(","), asked.file)
    return simulate.table(json.loads(asked.file.read_text(encoding="utf-8")))


def _asked(words: list[str] | None) -> argparse.Namespace:
    formatter = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m tests.speed", description=__doc__, formatter_class=formatter)
    programs = parser.add_subparsers(required=True)

    def program(name: str, rows: Callable[[argparse.Namespace], list[Row]]) -> argparse.ArgumentParser:
        subparser = programs.add_parser(name)
        subparser.set_defaults(rows=rows)
        return subparser

    sub = program("commands", _commands)
    sub.add_argument("--only", default="all", help=f"{', '.join(commands.COMMANDS)}, or all, which takes 20 minutes.")
    sub = program("throughput", _throughput)
    sub.add_argument("--encoding", default="spheremap,octahedral,spherical,xyz,per_pixel_view")
    sub.add_argument("--counts", default="2^22", help="Normals, such as 2^18,2^20; rounded down to whole blocks.")
    sub = program("growth", _growth)
    sub.add_argument("--over", default="all", help=f"{', '.join(growth.KINDS)}, or all.")
    sub.add_argument("--sizes", default="", help="Of one kind. Default: three, each about ten times the one before.")
    sub = program("simulate", _simulate)
    sub.add_argument("--record", default="", help="Measure the steps of these tables, and what sending costs, first.")
    sub.add_argument("--file", type=Path, default=RECORD, help="The record of step times.")
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> None:
    """Print the rows of a program. Raises SystemExit with one line for invalid requests."""
    asked = _asked(words)
    try:
        print(json.dumps(asked.rows(asked), indent=1))
    except UsageError as error:
        raise SystemExit(f"tests.speed: {error}") from error


if __name__ == "__main__":
    main()
