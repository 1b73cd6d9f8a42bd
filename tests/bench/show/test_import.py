"""`normalbench import` and the device tables: rows are added once, all or none, and appear on the page."""

import json

import devices as made
import pytest

from normalbench.bench.tables.devices.agreement import sentences
from normalbench.bench.tables.registry import TABLES


def test_codecs_and_facts_have_their_columns_and_unique_names(run, tmp_path):
    made.write_ten(tmp_path / "ten")
    for words, count in (((), 350), (("--facts",), 40)):
        status, out, _ = run("devices", *words, "--devices", str(tmp_path / "ten"), "--format", "json")
        rows, table = json.loads(out), TABLES["devices"]
        assert status == 0 and len(rows) == count == len({table.name_of(row) for row in rows})
        assert all(tuple(row) == tuple(table.empty()) for row in rows)


def test_a_readers_own_codec_keeps_its_row(run, tmp_path):
    row = made.codec_rows()[0] | {"encoding": "my_own", "storage": "mine"}
    path = made.write(tmp_path / "a.json", codecs=[row])
    (shown,) = json.loads(run("devices", "--devices", str(path), "--format", "json")[1])
    assert (shown["encoding"], shown["storage"], shown["same_percent"]) == ("my_own", "mine", 100)


@pytest.mark.parametrize("where, said", [(None, "name the run's folder with -o RUN"), ("nowhere", "is not a results")])
def test_folder_that_is_not_a_run_is_a_one_line_error_and_unchanged(run, tmp_path, where, said):
    words = ("-o", str(tmp_path / where)) if where else ()
    status, out, err = run("import", str(made.write(tmp_path / "a.json")), *words)
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err, err
    assert [path.name for path in tmp_path.iterdir()] == ["a.json"]


def test_gates_check_devices(run, tmp_path):
    made.write(tmp_path / "a.json", truncated=("RGB10_A2",))
    gate = f'[[gate]]\ntable = "devices"\ndevices = "{tmp_path}/a.json"\nfurther = "at most 0"\n'
    (tmp_path / "gates.toml").write_text(gate)
    status, out, err = run("check", str(tmp_path / "gates.toml"), "--format", "json")
    failing = [row["row"] for row in json.loads(out) if row["holds"] != "pass"]
    assert status == 1 and len(failing) == 8 and all("rgb10a2" in name for name in failing), err


def test_gates_check_facts(run, tmp_path):
    """A gate asks for facts explicitly, or names a column that only facts have."""
    made.write(tmp_path / "a.json")
    for how in ("facts = true\n", ""):
        gate = f'[[gate]]\ntable = "devices"\ndevices = "{tmp_path}/a.json"\n{how}number = "at least 23"\n'
        (tmp_path / "gates.toml").write_text(gate)
        rows = json.loads(run("check", str(tmp_path / "gates.toml"), "--format", "json")[1])
        assert {row["row"].split(" 156 ")[1]: row["holds"] for row in rows}["highp mantissa bits"] == "pass", how


def test_the_chart_has_a_dot_per_positive_time_with_the_fastest_first():
    from normalbench.bench.tables.devices.charts import timed

    rows = []
    for name, ms in (("A", 0.05), ("B", 0.01), ("C", 0.0)):
        about = {"device": name, "browser": "Chromium 156"}
        rows += [about | row for row in made.codec_rows(ms_per_bit=ms)]
    dots = timed([*rows, rows[0] | {"encoding": "below", "encode_ms": -1.0, "decode_ms": 0.5}])
    assert len(dots) == 70 and {row["device"] for row in dots} == {"A, Chromium 156", "B, Chromium 156"}
    assert dots[0]["codec"] == "xyz rgba8" and dots[-1]["codec"] == "octahedral_precise rg16"


def test_the_sentences_list_devices_that_agree_and_how_the_others_differ():
    rows = []
    for name, truncated in (("A", ()), ("B", ()), ("C", ("RGB10_A2",))):
        about = {"device": name, "browser": "Chromium 156", "sources": "x"}
        for row in made.codec_rows(truncated):
            rows.append(about | row | {"same_percent": 100 * row["equal"] / row["normals"]})
    first, second = sentences(rows)
    assert first == "A, Chromium 156 and B, Chromium 156 agree with the run in every code of 35 codecs."
    assert second.startswith("C, Chromium 156 differs in 8 of 35 codecs, most in xyz rgb10a2: 87.6% of its codes, ")
    near = rows[0] | {"device": "D", "one_step": 1, "same_percent": 100 - 100 / 65536}
    lines = sentences([near])
    assert lines == [
        "D, Chromium 156 differs in 1 of 1 codec, most in spheremap rgba8: 0.00153% of its codes, by one step each."
    ]
    assert "2 versions of the program" in sentences([*rows, rows[0] | {"sources": "y"}])[-1]


def test_an_older_file_in_a_folder_does_not_stop_a_gate(run, tmp_path):
    """The gate checks the newer file, and nothing that it needs is missing."""
    made.write(tmp_path / "files/a.json")
    made.write(tmp_path / "files/b.json", made="2026-11-24T15:00:00Z")
    gate = f'[[gate]]\ntable = "devices"\ndevices = "{tmp_path}/files"\nfurther = "at most 0"\n'
    (tmp_path / "gates.toml").write_text(gate)
    status, _, err = run("check", str(tmp_path / "gates.toml"))
    assert status == 0 and "left out: " in err and "a.json" in err, err
