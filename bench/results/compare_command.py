"""What `compare` does."""

from __future__ import annotations

import sys
from pathlib import Path

from .comparison import compared
from ..output.writing import check_writable, write
from .runs import read_run


def compare_command(before: Path, after: Path, format: str, output: Path | None) -> None:
    """Write what changed from one results folder to another; that nothing did is said on standard error."""
    ours, theirs = read_run(before), read_run(after)
    if output:
        check_writable(output)
    rows = compared(ours, theirs)
    if ours.facts.get("machine") != theirs.facts.get("machine"):
        print("normalbench: the machines differ; times are not compared", file=sys.stderr)
    if not rows:
        print(f"normalbench: no change in {len(ours.steps)} steps", file=sys.stderr)
    write(rows, format, output)
