"""A set that takes hours is measured in parts: the row is that of the set at once, to the last digit, and a part is
never measured twice."""

import json

from normalbench.bench.subjects.normals.normal_sets import CHUNK


def test_workers_share_a_row(run):
    """2^30 normals and some are two parts: two processes give the rows of one."""
    arguments = ["quality", "--encoding", "xyz", "--storage", "rgba8", "--count", str(2**30 + 5 * CHUNK)]
    arguments += ["--normals", "sphere", "--backend", "jax", "--format", "json"]
    status, shared, _ = run(*arguments, "--on", "local:2")
    assert status == 0
    status, alone, _ = run(*arguments)
    assert status == 0 and json.loads(shared) == json.loads(alone)
