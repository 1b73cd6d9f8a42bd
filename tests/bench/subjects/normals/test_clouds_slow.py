"""Point clouds as sets of normals, and Git LFS pointers in place of files."""

import json

from test_clouds import CLOUD


def test_a_cloud_is_a_set_of_normals(run):
    status, out, err = run(
        *("quality", "--encoding", "octahedral", "--normals", str(CLOUD), "--backend", "jax", "--format", "json")
    )
    assert status == 0, err
    (row,) = json.loads(out)
    assert row["normals"] == "points.ply" and row["count"] == 2
