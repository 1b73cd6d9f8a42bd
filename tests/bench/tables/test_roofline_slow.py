"""Bytes against instructions: the model by hand, the reads at which an encoding becomes faster, and GPU rates."""

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_roofline import ONE, frame

from normalbench.bench.tables.roofline.measure import Work, from_reads


@given(st.lists(st.integers(0, 200), min_size=4, max_size=4), st.integers(1, 8), st.integers(1, 8))
def test_no_two_codes_are_each_faster_than_the_other(counts, one_bytes, other_bytes):
    """An encoding that is worse in everything is never faster."""
    a, b = Work(one_bytes, *counts[:2]), Work(other_bytes, *counts[2:])
    answers = {from_reads(a, b, ONE, frame(1)), from_reads(b, a, ONE, frame(1))}
    assert answers not in ({"always"}, {"equal", "always"})
    worse = Work(a.bytes + 1, a.encode + 1, a.decode + 1)
    assert from_reads(worse, a, ONE, frame(1)) == "never"


@pytest.mark.usefixtures("radv")
@pytest.mark.parametrize(
    "words, expected",
    [
        ([], {("octahedral", "rgb10a2"): 4, ("xyz", "rgb10a2"): 4, ("octahedral", "rgb8_12_12"): 4}),
        (["--shared"], {("octahedral", "rgb10a2"): 2.5, ("xyz", "rgb10a2"): 3.75, ("octahedral", "rgb8_12_12"): 3}),
    ],
)
def test_a_whole_texel_counts_as_traffic_unless_other_data_uses_the_rest(run, words, expected):
    chosen = ["--encoding", "octahedral,xyz", "--storage", "rgb10a2,rgb8_12_12", "--gpu", "rx6800xt", "--size", "64x64"]
    status, out, _ = run("roofline", *chosen, "--reads", "1", "--format", "json", *words)
    rows = json.loads(out)
    sizes = {(row["encoding"], row["storage"]): row["bytes_per_pixel"] for row in rows}
    assert status == 0 and sizes == expected and {row["shared"] for row in rows} == {bool(words)}
    # One byte is written and one read of each of 64 x 64 pixels.
    assert all(row["megabytes"] == pytest.approx(2 * 64**2 * row["bytes_per_pixel"] / 1e6) for row in rows)
    assert (" is faster than " in run("roofline", *chosen, *words)[1]) == bool(words)


@pytest.mark.usefixtures("radv")
def test_rows_have_the_counts_of_the_cost_table_and_the_output_has_the_answer(run, tmp_path):
    words = [
        "--encoding",
        "octahedral,xyz",
        "--storage",
        "rg8,rgba16f",
        "--gpu",
        "rx6800xt",
        "--size",
        "1920x1080,3840x2160",
    ]
    status, out, _ = run("roofline", *words, "--reads", "1", "--format", "json", "--plot", str(tmp_path / "a.png"))
    rows = {(row["encoding"], row["storage"], row["size"]): row for row in json.loads(out)}
    assert status == 0 and (tmp_path / "a.png").stat().st_size > 10_000
    costs = json.loads(
        run(
            "cost",
            "--isa",
            "--family",
            "navi21",
            "--stage",
            "fragment",
            "--encoding",
            "octahedral",
            "--storage",
            "rg8",
            "--format",
            "json",
        )[1]
    )
    by_operation = {row["operation"]: row["issue_slots"] for row in costs}
    small = rows["octahedral", "rg8", "3840x2160"]
    assert small["encode"] == by_operation["encode"] + by_operation["pack"]
    assert small["decode"] == by_operation["decode"] + by_operation["unpack"]
    assert (small["bytes_per_pixel"], small["in_cache"], rows["octahedral", "rgba16f", "3840x2160"]["in_cache"]) == (
        2,
        True,
        False,
    )
    assert rows["xyz", "rgba16f", "1920x1080"]["alu_us"] == 0
    # 4608 lanes of 2.25 GHz against 1664 GB/s of the cache and 512 of memory.
    ridges = [row["ridge"] for row in (small, rows["octahedral", "rgba16f", "3840x2160"])]
    assert ridges == pytest.approx([6.2308, 20.25], abs=1e-4)
    _, shown, _ = run("roofline", *words)
    assert "a byte from memory takes as long as 20.2 instructions, a byte from the cache takes as long as 6.23" in shown
    assert "rx6800xt: octahedral rg8 is faster than xyz rgba16f: always" in shown


@pytest.mark.usefixtures("radv")
def test_the_answer_is_above_the_first_table(run):
    out = run("roofline", "--encoding", "xyz,octahedral", "--storage", "rgba8", "--gpu", "rx480", "--reads", "1")[1]
    assert re.match(r"rx480: (octahedral and xyz|xyz and octahedral) in rgba8 are equally fast in every case\.\n", out)
