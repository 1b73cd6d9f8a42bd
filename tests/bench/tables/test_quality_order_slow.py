"""The order and the limit rows of the printed quality table."""

import csv
import io

from test_quality_order import SMALL


def test_rows_are_grouped_by_bits_the_best_first_and_the_limit_last(run):
    """The order of the arguments does not matter; two normal sets make two groups of each size."""
    words = [
        "--encoding",
        "xy,spherical,octahedral,xyz",
        "--storage",
        "rgba8,rgb10a2",
        "--normals",
        "sphere,hemisphere",
    ]
    status, out, _ = run("quality", *words, *SMALL, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    keys = [(row["normals"] == "hemisphere", int(row["bits"]), -float(row["effective_bits"])) for row in rows]
    assert status == 0 and len(rows) == 16 and keys == sorted(keys)
    status, out, _ = run("quality", *words, *SMALL, "--format", "markdown")
    table = [cells.split("|") for cells in out.splitlines() if cells.startswith("| ")][1:]
    names, bits = [cells[1].strip() for cells in table], [int(cells[4]) for cells in table]
    ends = [i for i, name in enumerate(names) if name == "limit"]
    assert [bits[i] for i in ends] == [16, 20, 24, 30] * 2 and ends[-1] == len(names) - 1
    assert all(bits[i + 1] != bits[i] for i in ends[:-1])
