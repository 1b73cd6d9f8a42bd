"""The `check` command."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...ground.output.errors import UsageError, tell, tell_together
from ...ground.output.progress import progress
from ...ground.output.writing import check_writable, without
from ...keep.row_files import check_rows, write
from .changed import gates_that_read
from .gates import BASELINE, COLUMNS, WRITER, Baselines, Gate, checked, read_gates


def check_command(
    gates: Path, files: Sequence[Path], run: Path | None, writes: bool, format: str, output: Path | None
) -> int:
    """Measure the gates' rows, or take them from a run, and write the results.

    Args:
        files: check only the gates that read one of these files; empty for all gates.
        writes: whether rows are written into the gates' baselines instead of being compared with them.

    Returns:
        the exit status: 1 if a gate fails.
    """
    chosen_gates, baselines = read_gates(gates), Baselines(writes)
    if files and not (chosen_gates := gates_that_read(files, chosen_gates, gates)):
        tell(f"no gate in {gates} uses {', '.join(map(str, files))}")
        return 0
    if writes:
        _check_baselines(gates, chosen_gates, run)
    check_rows(output, COLUMNS)
    with progress(len(chosen_gates)) as tick:
        rows = list(checked(chosen_gates, run, tick, baselines))
    for path in baselines.write():
        tell(f"written: {path}")
    for reason in dict.fromkeys(row["skipped"] for row in rows if row["skipped"]):
        tell(f"rows without figures: {reason}")
    for row in rows:
        if row["changed"]:
            tell_together(row["row"], row["changed"].splitlines())
    for limit in dict.fromkeys(row["limit"] for row in rows if row["lacks"]):
        lost = [row["lacks"] for row in rows if row["lacks"] and row["limit"] == limit]
        more = f" and {len(lost) - 1} more" if len(lost) > 1 else ""
        tell(f"{limit.removeprefix('as in ')} has no row {lost[0]}{more}; run {WRITER} to add the missing rows")
    if format == "table":
        empty = [name for name in ("worst_normal", "column", "figure") if all(row[name] is None for row in rows)]
        rows = without(rows, ("skipped", "changed", "lacks", *empty))
    write(rows, format, output, ("table",))
    failed = sum(row["holds"] == "FAIL" for row in rows)
    if failed:
        tell(f"{failed} of {len(rows)} thresholds failed")
    return int(failed > 0)


def _check_baselines(path: Path, gates: Sequence[Gate], run: Path | None) -> None:
    """Raise UsageError if figures come from a run, no gate names a baseline, or a baseline cannot be written."""
    if run:
        raise UsageError("--write-baseline cannot be used with --run")
    named = dict.fromkeys(gate.baseline for gate in gates if gate.baseline)
    if not named:
        raise UsageError(f'{path}: no gate names a baseline; add {BASELINE} = "costs.json" to one')
    for baseline in named:
        check_writable(baseline, makes_folder=True)
