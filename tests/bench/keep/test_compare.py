"""`normalbench compare`: no differences for the same work, exact figures, and time changes only beyond noise."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from normalbench.bench.ground.machine.settings import settings
from normalbench.bench.keep import compare_command
from normalbench.bench.keep.change_lines import in_short, sentences, total, what_matters
from normalbench.bench.keep.comparison import compared, mann_whitney, measured_otherwise
from normalbench.bench.keep.runs import Done
from normalbench.bench.keep.schema import SCHEMA

MACHINE = {"machine": {"GL": "one"}}


def run_of(*rows: dict, facts=MACHINE) -> Done:
    return Done(facts, [{"table": "sweep", "key": {"pipeline": row["pipeline"]}, "rows": [row]} for row in rows])


def timed(name: str, times) -> dict:
    return {"pipeline": name, "ms_frame": float(np.median(times)), "ms_frame_each": " ".join(map(str, times))}


def test_figures_are_compared_exactly_and_nan_equals_nan():
    same = {"pipeline": "a", "triangles": 1 / 3, "triangles_lights": float("nan"), "clock": "wall", "ms_frame": 1.0}
    assert compared(run_of(same), run_of(same | {"ms_frame": 9.0, "clock": "query"})) == []
    (change,) = compared(run_of(same), run_of(same | {"triangles": np.nextafter(1 / 3, 1)}))
    assert (change["table"], change["row"], change["column"]) == ("sweep", "a", "triangles")
    assert change["verdict"] == "worse"


def test_rows_measured_under_different_conditions_are_reported():
    """Figures with another rounding or another number of normals are not compared without a message."""
    row = {"encoding": "xyz", "storage": "rg8", "count": 2**20, "rounded_by": "device", "psnr_db": 50.0}
    others = [row | {"count": 2**26, "rounded_by": "shader"}, row | {"storage": "rg16", "count": 2**26}]
    runs = [
        Done(MACHINE, [{"table": "quality", "key": {}, "rows": [step_row]} for step_row in rows])
        for rows in ([row, row | {"storage": "rg16"}], others)
    ]
    assert measured_otherwise(*runs) == [
        "count was 1048576 and is now 67108864 in 2 rows",
        "rounded_by was device and is now shader in 1 row",
    ]
    assert measured_otherwise(runs[0], runs[0]) == []


def test_rows_of_a_table_that_no_longer_exists_are_not_compared():
    """One run or both runs have the table; a sentence names the table."""
    run, other = (Done(MACHINE, [{"table": "growth", "key": {}, "rows": [{"seconds": time}]}]) for time in (1.0, 2.0))
    assert compared(run, other) == compared(run, run_of()) == [] and not run.tables
    assert run.left_out == "Rows of growth are left out, because this version has no such table"
    assert run_of({"pipeline": "a"}).left_out == ""


def test_rows_missing_from_one_run_are_reported():
    a, b = {"pipeline": "a", "triangles": 1}, {"pipeline": "b", "triangles": 1}
    (change,) = compared(run_of(a, b), run_of(b))
    assert (change["row"], change["before"], change["after"], change["change"]) == ("a", True, False, "only before")
    assert change["verdict"] == "gone" and compared(run_of(b), run_of(a, b))[0]["verdict"] == ""


def test_rows_without_a_rounding_column_count_as_rounded_to_nearest():
    """The column was added later: a row without it matches `nearest`, but not `truncate`."""
    old, nearest, cut = (
        Done(MACHINE, [{"table": "depth", "key": {}, "rows": [{"depth": "linear", "error_max": 1.0} | more]}])
        for more in ({}, {"rounding": "nearest"}, {"rounding": "truncate"})
    )
    assert old.tables["depth"] == nearest.tables["depth"] and compared(old, nearest) == []
    assert {change["change"] for change in compared(old, cut)} == {"only before", "only after"}


def picked(**figures) -> Done:
    row = {"storage": "rg8", "encoding": "stereographic", "angle_sup_deg": None, "skipped": None}
    return Done(MACHINE, [{"table": "pick", "key": {}, "rows": [row | figures]}])


@pytest.mark.parametrize(
    ("why", "lost", "found"),
    [({}, ("not measured", ""), ("new", "")), ({"skipped": "no GL"}, ("not measured", "worse"), ("new", "better"))],
)
def test_an_unmeasured_figure_is_worse_only_if_the_row_states_a_reason(why, lost, found):
    measured = picked(angle_sup_deg=0.95)
    for runs, expected in (((measured, picked(**why)), lost), ((picked(**why), measured), found)):
        changes = {change["column"]: (change["change"], change["verdict"]) for change in compared(*runs)}
        assert changes["angle_sup_deg"] == expected and changes.keys() <= {"angle_sup_deg", "skipped"}


def test_new_rows_and_missing_rows_are_on_separate_lines():
    rows = [{"encoding": name, "storage": storage} for name in ("xy", "xyz") for storage in ("rg8", "rgba8")]
    done = [
        Done(MACHINE, [{"table": "quality", "key": {}, "rows": [row]} for row in part]) for part in (rows[:2], rows[2:])
    ]
    lines = in_short(compared(*done), most=2)
    assert sorted((line["change"], line["rows"], line["verdict"]) for line in lines) == [
        ("only after", 2, ""),
        ("only before", 2, "gone"),
    ]


def step_of_quality(row: dict) -> dict:
    return {"table": "quality", "key": {}, "rows": [row]}


def quality_of(**psnr: float) -> Done:
    """Return a run of encodings in `rg8` with these PSNR values."""
    rows = [{"encoding": name, "storage": "rg8", "psnr_db": db, "angle_max_deg": 90 / db} for name, db in psnr.items()]
    return Done(MACHINE, [{"table": "quality", "key": {}, "rows": rows}])


def test_the_total_counts_rows_and_figures():
    before, after = quality_of(xy=40.0, xyz=45.0, cube=50.0, octahedral=49.0), quality_of(xy=39.0, xyz=46.0, cube=48.0)
    assert total(compared(before, after)) == "4 rows, 6 figures: 2 rows worse, 1 row gone, 1 row better"
    assert total(compared(quality_of(), quality_of(xy=39.0))) == "1 row, 0 figures: 1 row new"


def broken_fold() -> tuple[Done, Done]:
    """Return two runs of an encoding in four storages: `rg16f` loses 1.7 dB, `rgba8` almost nothing."""
    names = ("rg16f", "rg16", "rg8", "rgba8")
    before = [(79.9, math.inf, 0.005), (101.1, math.inf, 0.001), (48.6, 50.0, 0.1), (49.9, 50.0, 0.1)]
    after = [(78.24, 83.0, 0.006), (56.7, 55.4, 0.036), (10.9, 11.0, 22.0), (49.8983, 50.0, 0.1001)]
    runs = []
    for figures in (before, after):
        rows = [
            {"encoding": "mine", "storage": name, "psnr_db": psnr, "psnr_article_db": article, "angle_mean_deg": mean}
            for name, (psnr, article, mean) in zip(names, figures, strict=True)
        ]
        skipped = {"encoding": "mine", "storage": "rg8", "backend": "jax", "skipped": "no twin"}
        runs.append(Done(MACHINE, [{"table": "quality", "key": {}, "rows": [*rows, skipped]}]))
    return runs[0], runs[1]


def test_rows_are_ordered_by_their_shown_figure_with_small_changes_last():
    """A column with an infinite old value does not rank rows; a loss below 0.1 dB is only "slightly worse"."""
    lines = in_short(compared(*broken_fold()))
    assert [(line["row"], line["column"], line["change"], line["verdict"]) for line in lines] == [
        ("mine rg16", "psnr_db", "-44.4", "worse"),
        ("mine rg8", "psnr_db", "-37.7", "worse"),
        ("mine rg16f", "psnr_db", "-1.66", "worse"),
        ("mine rgba8", "psnr_db", "-0.0017", "slightly worse"),
    ]
    assert total(compared(*broken_fold())).endswith(
        ": 3 rows worse, 1 row slightly worse (slightly: by less than 0.1 dB, about 1%)"
    )


def test_an_encoding_that_is_no_longer_exact_is_among_the_worst():
    (line,) = in_short(compared(quality_of(xy=math.inf), quality_of(xy=50.0)))
    assert (line["column"], line["before"], line["verdict"]) == ("psnr_db", math.inf, "worse")
    ranked = in_short(compared(quality_of(xy=60.0, xyz=math.inf), quality_of(xy=55.0, xyz=50.0)))
    assert [line["row"] for line in ranked] == ["xyz rg8", "xy rg8"]


def test_the_first_line_states_the_changed_encoding_its_rows_and_the_change():
    """A row that states why it has no figures is not counted."""
    before, after = broken_fold()
    assert what_matters(before, after, compared(before, after)) == [
        "mine: worse in 3 of 4 rows, slightly worse in 1; largest change in quality rg16: "
        "angle_mean_deg from 0.001000 to 0.03600 degrees, psnr_db from 101.1 to 56.70 dB"
    ]
    assert what_matters(before, before, []) == []


def test_missing_rows_are_counted_among_all_earlier_rows():
    """The total includes rows that stated why they had no figures."""
    rows = [{"encoding": "xy", "storage": storage, "psnr_db": 40.0, "skipped": None} for storage in ("rg8", "rgba8")]
    rows[1] |= {"psnr_db": None, "skipped": "no GL device"}
    before, other = Done(MACHINE, [step_of_quality(row) for row in rows]), quality_of(xyz=40.0)
    lines = sentences(before, other, compared(before, other))
    assert lines[0].startswith("xy: gone in all 2 rows"), lines


def test_changed_encodings_are_reported_in_five_sentences_and_a_count():
    names = [f"code{number}" for number in range(7)]
    before, after = (quality_of(**{name: db - index for index, name in enumerate(names)}) for db in (60.0, 50.0))
    lines = what_matters(before, after, compared(before, after))
    assert len(lines) == 6 and lines[-1] == "and 2 more of 7"
    assert lines[0].startswith("code0: worse in its only row; largest change in quality rg8: angle_max_deg ")


def test_runs_without_a_common_row_are_reported_first(run, monkeypatch):
    runs = {"before": quality_of(xy=40.0), "after": quality_of(xyz=44.0)}
    monkeypatch.setattr(compare_command, "read_to_show", lambda folder, **_: runs[folder.name])
    for kind in ("table", "markdown"):
        assert run("compare", "before", "after", "--format", kind)[1].startswith("the runs have no row in common\n")


def test_csv_has_plain_numbers(run, monkeypatch):
    monkeypatch.setattr(compare_command, "read_to_show", lambda folder, **_: broken_fold()[folder.name == "after"])
    out = run("compare", "before", "after", "--format", "csv")[1]
    assert "-inf" in out and "-44.4" in out and "+0.035" in out and "'" not in out


def test_columns_that_all_lines_share_are_not_repeated_below_the_table(run, monkeypatch):
    runs = {"before": quality_of(xy=40.0, xyz=45.0), "after": quality_of(xy=39.0, xyz=44.0)}
    monkeypatch.setattr(compare_command, "read_to_show", lambda folder, **_: runs[folder.name])
    for kind in ("table", "markdown"):
        status, out, _ = run("compare", "before", "after", "--format", kind)
        *above, last = out.splitlines()
        assert status == 0 and last == "2 rows, 4 figures: 2 rows worse"
        (head,) = (line for line in above if "verdict" in line)
        assert "figures" in head and "rows" not in head
    status, out, _ = run("compare", "before", "after", "--format", "csv")
    assert status == 0 and out.splitlines()[0] == "table,row,column,before,after,change,verdict"


def test_environment_settings_are_recorded_and_reported_if_they_differ(run, monkeypatch):
    """XLA's flags and Mesa's variables affect figures; the location of a cache does not."""
    flags = "--xla_cpu_enable_fast_math=true"
    monkeypatch.setenv("XLA_FLAGS", flags)
    monkeypatch.setenv("MESA_SHADER_CACHE_DIR", "/somewhere")
    assert settings()["XLA_FLAGS"] == flags and not any("CACHE" in name for name in settings())
    set_here = {"setting XLA_FLAGS": flags}
    runs = {"one": Done({"machine": {"python": "3"}}, []), "two": Done({"machine": {"python": "3"} | set_here}, [])}
    monkeypatch.setattr(compare_command, "read_to_show", lambda folder, **_: runs[folder.name])
    status, _, err = run("compare", "one", "two")
    assert status == 0
    assert f"figures may differ because settings changed: XLA_FLAGS was not set and is now {flags}" in err, err


def test_environment_settings_are_shown_in_a_row(run, monkeypatch):
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    monkeypatch.setenv("MESA_NO_ERROR", "1")
    words = ["quality", "--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--format", "json"]
    devices = {row["backend"]: row["device"] for row in json.loads(run(*words)[1])}
    assert devices["jax"] == "cpu, MESA_NO_ERROR=1" and devices["glsl"].endswith(", MESA_NO_ERROR=1")


def test_a_broken_encoder_comes_before_counts_that_changed_from_0_to_2():
    """The first line shows decibels, and rows that changed together share one line."""
    costs = [
        {"encoding": "mine", "operation": name, "stage": "fragment", "family": f, "conversion": 0, "instructions": 20}
        for name in ("encode", "decode")
        for f in ("navi21", "navi31", "skl", "tgl", "dg2")
    ]
    quality = [
        {"encoding": "mine", "storage": "rgba8", "normals": name, "mse": 6e-7, "psnr_db": 62.1, "angle_mean_deg": 0.04}
        for name in ("sphere", "axes")
    ]
    broken = [quality[0], quality[1] | {"mse": 0.003, "psnr_db": 25.3, "angle_mean_deg": 1.2}]
    before, after = (
        Done(MACHINE, [{"table": "cost", "key": {}, "rows": counts}, {"table": "quality", "key": {}, "rows": errors}])
        for counts, errors in ((costs, quality), ([row | {"conversion": 2} for row in costs], broken))
    )
    first, *others = in_short(compared(before, after))
    assert (first["table"], first["column"], first["before"], first["after"]) == ("quality", "psnr_db", 62.1, 25.3)
    assert [(line["table"], line["rows"], line["column"]) for line in others] == [("cost", 10, "conversion")]


def step_of(*rows: dict) -> Done:
    return Done(MACHINE, [{"table": "cost", "key": {"family": "navi31"}, "rows": list(rows)}])


def test_rows_of_one_step_are_paired_by_identity():
    """A missing row is reported and shifts no other row; rows with the same name are paired in order."""
    names = [("xyz", "encode"), ("xyz", "decode"), ("octahedral", "encode"), ("octahedral", "encode")]
    about = [
        {"encoding": e, "operation": o, "stage": "fragment", "family": "navi31", "instructions": x}
        for x, (e, o) in enumerate(names)
    ]
    changes = compared(step_of(*about), step_of(about[0], about[2], about[3] | {"instructions": 9}))
    lost, other = sorted(changes, key=lambda change: change["column"])
    assert (lost["row"], lost["change"]) == ("xyz decode fragment navi31", "only before")
    assert (other["row"], other["before"], other["after"]) == ("octahedral encode fragment navi31", 3, 9)


def test_a_small_difference_does_not_count_even_if_significant():
    base = 10 + np.linspace(0, 0.01, 9)
    for factor, changed in ((1.02, False), (0.98, False), (1.08, True), (0.92, True)):
        assert mann_whitney(base, base * factor) < 1e-4
        assert bool(compared(run_of(timed("a", base)), run_of(timed("a", base * factor)))) == changed


def test_time_changes_must_exceed_noise_and_a_minimum_on_the_same_machine():
    rng = np.random.default_rng(0)
    base = 10 + rng.uniform(-0.5, 0.5, 9)
    slow, slightly, noisy = base * 1.2, base * 1.02, 10 + rng.uniform(-3, 3, 9) + 0.6
    for times, changed in ((slow, True), (slightly, False), (noisy, False), (rng.permutation(base), False)):
        rows = compared(run_of(timed("a", base)), run_of(timed("a", times)))
        assert bool(rows) == changed, (times, rows)
    elsewhere = run_of(timed("a", slow), facts={"machine": {"GL": "two"}})
    assert compared(run_of(timed("a", base)), elsewhere) == []


def test_a_folder_that_is_not_a_run_is_a_one_line_error(run, tmp_path):
    status, out, err = run("compare", str(tmp_path), str(tmp_path))
    assert (status, out) == (2, "") and "is not a results folder" in err and err.count("\n") == 1


EMPTIED = {"lines": 2, "digest": "of the rows", "finished": True}


@pytest.mark.parametrize(
    ("facts", "rows", "said"),
    [
        (EMPTIED, "", "empty/rows.jsonl has 0 of the 2 lines that it had when the run finished"),
        (EMPTIED, '{"table": "quality", "key"', "empty/rows.jsonl has 0 of the 2 lines"),
        ({"finished": False}, "", "empty has no rows: none of its steps was finished"),
    ],
)
def test_a_run_without_rows_is_not_compared(run, tmp_path, monkeypatch, facts, rows, said):
    """A one-line error states the reason; a history leaves the run out."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("empty", rows), ("whole", json.dumps(step_of_quality({"encoding": "xy"})) + "\n")):
        Path(name).mkdir()
        about = {"schema": SCHEMA} | (facts if name == "empty" else {"finished": False})
        Path(name, "run.json").write_text(json.dumps(about))
        Path(name, "rows.jsonl").write_text(text)
    for words in (("whole", "empty"), ("empty", "whole")):
        status, out, err = run("compare", *words)
        assert (status, out, err.count("\n")) == (2, "", 1), err
        assert err.startswith(f"normalbench: {said}") and "measure it again" in err, err
    status, out, err = run("history", "whole", "empty")
    assert status == 0 and "gone" not in out and "left out: empty: it has no rows" in err, (out, err)
