"""The quality table as people read it."""

from normalbench.bench.measures.metrics.code_limits import code_limit
from normalbench.bench.tables.quality.order import in_order, with_limits
from normalbench.bench.tables.quality.table import TABLE

SMALL = ("--count", "20000", "--backend", "jax")


def lines(out: str) -> list[list[str]]:
    return [line.strip("| ").split() for line in out.splitlines()]


def test_the_limit_row_says_what_its_bits_could_do(run):
    status, out, _ = run(
        "quality", "--encoding", "octahedral,xy", "--normals", "hemisphere", *SMALL, "--format", "markdown"
    )
    (row,) = [cells for cells in lines(out) if cells[:1] == ["limit"]]
    least = code_limit(2**16, 2 * 3.141592653589793)
    assert status == 0 and "bits 16" in out and "domain hemisphere" in out
    assert f"{least.rms_deg:#.4g}" in row and f"{least.max_deg:#.4g}" in row and "16.00" in row


def test_on_normals_that_are_not_uniform_the_limit_is_named_for_what_it_is(run):
    """Codes that favour what is seen may beat it; effective bits are not theirs either."""
    status, out, _ = run("quality", "--encoding", "octahedral", "--normals", "axes", *SMALL, "--format", "markdown")
    assert status == 0 and "| limit if uniform |" in out
    status, out, _ = run("quality", "--encoding", "octahedral", "--normals", "axes", *SMALL, "--format", "csv")
    assert status == 0 and "limit if" not in out, "programs get what was measured"


def test_a_row_that_was_lost_has_a_place_and_no_limit():
    """What ends a worker leaves a row with its key and a reason, and no bits."""
    names = {"storage": "rg8", "rounding": "nearest", "normals": "sphere"}
    lost = TABLE.empty() | names | {"encoding": "mine", "skipped": "4 workers were lost while they measured it"}
    whole = TABLE.empty() | names | {"encoding": "octahedral", "bits": 16, "angle_rms_deg": 0.37, "domain": "sphere"}
    assert in_order([whole, lost]) == [lost, whole]
    assert [row["encoding"] for row in with_limits(in_order([whole, lost]))] == ["mine", "octahedral", "limit"]
