"""What `check` does."""

from __future__ import annotations

from pathlib import Path

from ..output.errors import tell
from ..output.progress import progress
from ..output.writing import check_writable, without, write
from .gates import checked, read_gates


def check_command(gates: Path, run: Path | None, format: str, output: Path | None) -> int:
    """Measure what the gates ask for, or take it from a run, and write what holds. Exit status: 1 if a gate fails."""
    found = read_gates(gates)
    if output:
        check_writable(output)
    with progress(len(found)) as tick:
        rows = list(checked(found, run, tick))
    for reason in dict.fromkeys(row["skipped"] for row in rows if row["skipped"]):
        tell(f"rows without figures: {reason}")
    if format == "table":
        hidden = ("skipped",) if any(row["worst_normal"] for row in rows) else ("skipped", "worst_normal")
        rows = without(rows, hidden)
    write(rows, format, output, ("table",))
    failed = sum(row["holds"] == "FAIL" for row in rows)
    if failed:
        tell(f"{failed} of {len(rows)} limits do not hold")
    return int(failed > 0)
