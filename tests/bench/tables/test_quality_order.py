"""The order and the limit rows of the printed quality table."""

from normalbench.bench.measures.metrics.code_limits import code_limit
from normalbench.bench.tables.quality.order import in_order, with_limits
from normalbench.bench.tables.quality.table import TABLE

SMALL = ("--count", "20000", "--backend", "jax")


def lines(out: str) -> list[list[str]]:
    return [line.strip("| ").split() for line in out.splitlines()]


def test_the_limit_row_gives_the_bound_for_its_bits(run):
    status, out, _ = run(
        "quality", "--encoding", "octahedral,xy", "--normals", "hemisphere", *SMALL, "--format", "markdown"
    )
    (row,) = [cells for cells in lines(out) if cells[:1] == ["limit"]]
    least = code_limit(2**16, 2 * 3.141592653589793)
    assert status == 0 and "bits 16" in out and "domain hemisphere" in out
    assert f"{least.rms_deg:#.4g}" in row and f"{least.max_deg:#.4g}" in row and "16.00" in row


def test_the_limit_row_is_renamed_for_normals_that_are_not_uniform(run):
    """Encodings that favour visible normals may beat the limit, and effective bits do not apply to them."""
    status, out, _ = run("quality", "--encoding", "octahedral", "--normals", "axes", *SMALL, "--format", "markdown")
    assert status == 0 and "| limit if uniform |" in out
    status, out, _ = run("quality", "--encoding", "octahedral", "--normals", "axes", *SMALL, "--format", "csv")
    assert status == 0 and "limit if" not in out, "programs get what was measured"


def test_a_lost_row_keeps_its_place_and_has_no_limit():
    """A step that ends its workers leaves a row with its key and a reason, but no bits."""
    names = {"storage": "rg8", "rounding": "nearest", "normals": "sphere"}
    lost = TABLE.empty() | names | {"encoding": "mine", "skipped": "4 workers were lost while measuring this row"}
    whole = TABLE.empty() | names | {"encoding": "octahedral", "bits": 16, "angle_rms_deg": 0.37, "domain": "sphere"}
    assert in_order([whole, lost]) == [lost, whole]
    assert [row["encoding"] for row in with_limits(in_order([whole, lost]))] == ["mine", "octahedral", "limit"]
