"""Measured time as a cost: arithmetic on simulated clocks, and rows for a device and for JAX."""

import json

import pytest

from normalbench.bench.ground.machine.devices import require_device


@pytest.mark.usefixtures("gl")
def test_a_software_rasteriser_draws_one_tile(run):
    status, out, _ = run(
        "cost", "--time", "--encoding", "xy", "--storage", "rgba8", "--repeats", "2", "--format", "json"
    )
    assert status == 0
    for row in json.loads(out):
        assert row["size"] == ("64x64" if require_device().is_software else "1024x1024")


@pytest.mark.usefixtures("gl")
def test_every_operation_and_packing_has_a_row_with_its_conditions(run):
    words = ["--encoding", "spheremap,per_pixel_view", "--storage", "rgba8,12:12", "--size", "64x64", "--repeats", "3"]
    status, out, err = run("cost", "--time", *words, "--format", "json")
    rows = json.loads(out)
    assert (status, err) == (0, "") and {row["measure"] for row in rows} == {"time"} and len(rows) == 4 + 6
    by_key = {(row["encoding"] or row["storage"], row["operation"]): row for row in rows}
    for row in rows:
        assert row["device"] and row["driver"] and row["clock"] and row["turns"] >= 16 and row["size"] == "64x64"
        assert row["software"] is (row["clock"] != "GL timer query") and row["spread"] >= 0
    view, spheremap, packed = (
        by_key[key]["ns_per_megapixel"]
        for key in (("per_pixel_view", "encode"), ("spheremap", "encode"), ("rgb8_12_12 12:12", "pack"))
    )
    assert view > spheremap > 0 and packed > 0, "a frame by pixel costs more than spheremap"
