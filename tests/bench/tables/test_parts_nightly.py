"""Large sets that are measured in parts: the row is the same to the last digit as for the whole set, and no
part is measured twice."""

import json

from normalbench.bench.subjects.normals.normal_sets import CHUNK


def test_workers_share_a_row(run):
    """Slightly more than 2^30 normals make two parts; two processes give the same rows as one process."""
    arguments = ["quality", "--encoding", "xyz", "--storage", "rgba8", "--count", str(2**30 + 5 * CHUNK)]
    arguments += ["--normals", "sphere", "--backend", "jax", "--format", "json"]
    status, shared, _ = run(*arguments, "--on", "local:2")
    assert status == 0
    status, alone, _ = run(*arguments)
    assert status == 0 and json.loads(shared) == json.loads(alone)
