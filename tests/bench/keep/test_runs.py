"""Results folders: finished steps stay, stopped runs resume, and reading never writes."""

import json
import re
import sys
from pathlib import Path

import pytest
from typed import word_with

from normalbench.bench.door.cli import app as cli
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.output.sources import sources
from normalbench.bench.ground.user_files import with_files
from normalbench.bench.keep import journal
from normalbench.bench.keep.runs import ROWS, Run, opened, read_run, same_work, unfinished
from normalbench.bench.keep.schema import SCHEMA
from normalbench.bench.run.measuring import files_of
from normalbench.bench.run.workers.orders import Packing
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Step

FACTS = {"schema": SCHEMA, "request": {"count": 1}, "sources": "abc", "machine": {"GL": "one"}, "finished": False}


def kept(run: Run, count: int, measured: list[int]) -> list[list[dict]]:
    """Return the rows of `count` steps, which were stored earlier or are measured now."""

    def measure(step: Step) -> list[dict]:
        measured.append(step.case)
        return run.keep("table", step, [{"number": step.case, "figure": step.case / 3, "nothing": None}])

    steps = [Step({"number": number}, number, str(number)) for number in range(count)]
    return [run.find("table", step) or measure(step) for step in steps]


def test_a_finished_step_is_not_measured_twice(tmp_path):
    measured: list[int] = []
    for last in (3, 5):
        with opened(tmp_path / "run", FACTS) as run:
            rows = kept(run, last, measured)
    assert measured == [0, 1, 2, 3, 4] and rows[1] == [{"number": 1, "figure": 1 / 3, "nothing": None}]
    steps = read_run(tmp_path / "run").steps
    assert [row["number"] for step in steps for row in step["rows"]] == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("cut", range(1, 80, 7))
def test_only_a_truncated_line_is_measured_again(tmp_path, cut):
    folder, measured = tmp_path / "run", []
    with opened(folder, FACTS) as run:
        kept(run, 3, measured)
    whole = (folder / ROWS).read_bytes()
    (folder / ROWS).write_bytes(whole[:-cut])
    assert len(read_run(folder).steps) == 2, "the cut line is not there"
    assert (folder / ROWS).read_bytes() == whole[:-cut], "reading does not write"
    measured.clear()
    with opened(folder, FACTS) as run:
        kept(run, 3, measured)
    assert measured == [2] and (folder / ROWS).read_bytes() == whole


def step(**row) -> str:
    return json.dumps({"table": "quality", "key": {}, "rows": [row]})


@pytest.mark.parametrize(
    "file, text, said",
    [
        ("run.json", "[" * 100_000, "is not a results folder"),
        ("run.json", "[]", "run.json: [] is not an object"),
        ("run.json", '{"command": "run"}', "run.json, command: 'run' is not a list"),
        ("run.json", '{"machine": {"GL": [1]}}', "run.json, machine, GL: [1] is neither text nor a number"),
        ("run.json", "{}", "run.json: another version of normalbench measured this run; measure it again"),
        (ROWS, "not a step", "rows.jsonl, line 1 is damaged"),
        (ROWS, '{"table": "quality", "key": {}, "rows": 3}', "line 1: 3 is not a list"),
        (ROWS, '{"table": ["x"], "key": 3, "rows": []}', "line 1, table: ['x'] is not text"),
        (ROWS, '{"table": "quality", "key": {}}', "line 1 is missing"),
        (ROWS, '{"table": "quality", "key": {}, "rows": [1]}', "line 1, row 1: 1 is not an object"),
        (ROWS, step(psnr_db="47.5"), "line 1, row 1, psnr_db: '47.5' is not a number"),
        (ROWS, step(psnr_db=10**400), "line 1, row 1, psnr_db: 100000... (40 digits)… is too large"),
        (ROWS, step(count="many").replace('"many"', "9" * 5000), "line 1 is damaged"),
        (ROWS, step(psnr_db={"a": 1}), "row 1, psnr_db: {'a': 1} is neither text nor a number"),
        (ROWS, f"{step(storage='rg8')}\n{step(storage=8)}", "line 2, row 1, storage: 8 is a number; in "),
        (ROWS, step(encoding=["xyz"]), "row 1, encoding: ['xyz'] is neither text nor a number"),
    ],
)
def test_a_damaged_folder_is_a_one_line_error_and_not_a_failed_gate(run, tmp_path, file, text, said):
    folder, gates = tmp_path / "run", tmp_path / "gates.toml"
    folder.mkdir()
    (folder / "run.json").write_text(json.dumps(FACTS | {"finished": True}))
    (folder / file).write_text(text + "\n")
    gates.write_text('[[gate]]\nencoding = "xyz"\npsnr_db = "at least 1"\n')
    for command in (["report"], ["compare", str(folder)], ["check", str(gates), "--run"]):
        status, out, err = run(*command, str(folder))
        assert (status, out) == (2, "") and said in err and err.count("\n") == 1, (command, err)


def test_two_processes_cannot_write_to_the_same_folder(tmp_path):
    with opened(tmp_path / "run", FACTS), pytest.raises(UsageError, match="another process is writing"):
        opened(tmp_path / "run", FACTS).__enter__()


LONG = "llvmpipe of a very long name that goes on and on, "


@pytest.mark.parametrize(
    "other, said",
    [
        ({"sources": "b"}, "from other sources (a there, b here); name"),
        ({"machine": {"GL": "d"}}, "from another machine: GL (c there, d here); name"),
        ({"machine": {}}, "from another machine: GL (c there, not recorded here); name"),
        ({"sources": "b", "machine": {"GL": "d"}}, "from other sources (a there, b here) and from another machine: GL"),
        (
            {"machine": dict.fromkeys("ABCDE", "d") | {"GL": "c"}},
            "machine: A (not recorded there, d here), B (not recorded there, d here), C (not recorded there, d here), "
            "2 more; name",
        ),
        ({"machine": {"GL": LONG}}, "machine: GL (c there, llvmpipe of a very long name that goes o... here)"),
    ],
)
def test_a_run_from_other_sources_or_another_machine_is_not_extended(tmp_path, other, said):
    """The message names the difference with both values."""
    folder, facts = tmp_path / "run", FACTS | {"sources": "a", "machine": {"GL": "c"}}
    with opened(folder, facts) as run:
        kept(run, 1, [])
    before = (folder / ROWS).read_bytes()
    with pytest.raises(UsageError, match=re.escape(said)), opened(folder, facts | other):
        pass
    assert (folder / ROWS).read_bytes() == before


def test_long_facts_are_shown_around_their_difference(tmp_path):
    with opened(tmp_path / "run", FACTS | {"machine": {"GL": LONG + "15.0.6"}}):
        pass
    with (
        pytest.raises(UsageError, match=r"goes on and on, 15\.0\.6 there, .* goes on and on, 15\.0\.7 here"),
        opened(tmp_path / "run", FACTS | {"machine": {"GL": LONG + "15.0.7"}}),
    ):
        pass


def test_a_finished_run_is_extended_and_keeps_its_rows(tmp_path):
    folder, measured = tmp_path / "run", []
    with opened(folder, FACTS) as run:
        kept(run, 2, measured)
        run.finish()
    before = (folder / ROWS).read_bytes()
    with opened(folder, FACTS | {"request": {"count": 2}}) as run:
        kept(run, 3, measured)
        assert not read_run(folder).finished, "it is not finished until its new rows are there"
        run.finish()
    assert measured == [0, 1, 2] and (folder / ROWS).read_bytes().startswith(before)
    done = read_run(folder)
    assert done.finished and [entry["request"] for entry in done.facts["before"]] == [{"count": 1}]


def test_another_request_does_not_finish_a_stopped_first_request(tmp_path):
    """The facts of a new run do not state whether it is finished."""
    first = {name: fact for name, fact in FACTS.items() if name != "finished"}
    with opened(tmp_path / "run", first):
        pass
    with opened(tmp_path / "run", first | {"request": {"count": 2}}) as run:
        run.finish()
    assert not read_run(tmp_path / "run").finished


def test_another_request_does_not_finish_a_stopped_earlier_request(tmp_path):
    folder, measured, other = tmp_path / "run", [], FACTS | {"request": {"count": 2}}
    with opened(folder, FACTS) as run:
        kept(run, 1, measured)
    for facts, is_finished in ((other, False), (FACTS, True)):
        with opened(folder, facts) as run:
            kept(run, 2, measured)
            run.finish()
        assert read_run(folder).finished is is_finished


def test_a_folder_with_something_else_is_not_touched(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(UsageError, match="contains no run"), opened(tmp_path, FACTS):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]
    with pytest.raises(UsageError, match="not a results folder"):
        read_run(tmp_path)


def test_a_full_disk_does_not_lose_finished_rows(tmp_path, monkeypatch):
    folder, measured = tmp_path / "run", []
    with opened(folder, FACTS) as run:
        kept(run, 1, measured)
    before = (folder / ROWS).read_bytes()

    def full(_):
        raise OSError(28, "No space left on device")

    with opened(folder, FACTS) as run:
        monkeypatch.setattr(journal.os, "fsync", full)
        with pytest.raises(UsageError, match="No space left on device; 1 finished steps are kept"):
            kept(run, 2, measured)
    assert (folder / ROWS).read_bytes() == before


def test_the_newest_stopped_run_of_the_same_work_is_resumed(tmp_path):
    for name, facts in (("1", FACTS), ("2", FACTS), ("3", FACTS | {"sources": "other"}), ("4", FACTS)):
        with opened(tmp_path / name, facts) as run:
            if name == "4":
                run.finish()
    assert unfinished(tmp_path, FACTS) == tmp_path / "2"
    assert unfinished(tmp_path / "nowhere", FACTS) is None
    assert same_work(FACTS, FACTS | {"time": "now", "finished": True})


@pytest.mark.parametrize("name, beside", [("a.obj", "b.mtl"), ("a.gltf", "b.bin"), ("a.glsl", "a.py"), ("a.png", "")])
def test_a_files_fingerprint_includes_the_files_read_with_it(tmp_path, name, beside):
    paths = [tmp_path / file for file in (name, beside) if file]
    options, keys = TABLES["quality"].options(normals=str(paths[0])), []
    for content in ("one", "other"):
        for path in paths:
            path.write_text(content + path.suffix)
            keys.append(json.dumps(files_of(options)))
    assert len(set(keys)) == len(keys)


@pytest.mark.parametrize(
    "word, names",
    [
        ("best_fit:table=t/scales.npy", ["t/scales.npy"]),
        ("mine.glsl/rg8+xyz", ["mine.glsl"]),
        ("octahedral/rg8+t/other.hlsl:Encode:Decode", ["t/other.hlsl"]),
        ("mine.glsl/rg8+best_fit:table=t/scales.npy", ["mine.glsl", "t/scales.npy"]),
        ("a+b.glsl", ["a+b.glsl"]),
        ("t+/mine.glsl/rg8+xyz", ["t+/mine.glsl"]),
        ("best_fit:table=t+/scales.npy", ["t+/scales.npy"]),
        ("t//mine.glsl", ["t/mine.glsl"]),
    ],
)
def test_files_within_a_name_are_fingerprinted_and_sent_to_workers(tmp_path, monkeypatch, word, names):
    """A changed table or a changed half of a chain must be measured again."""
    monkeypatch.chdir(tmp_path)
    options, keys = TABLES["quality"].options(encoding=f"octahedral,{word}"), []
    Path("t").mkdir()
    Path("t+").mkdir()
    for content in ("one", "other"):
        for name in names:
            Path(name).write_text(content + name)
            keys.append(json.dumps(files_of(options)))
    assert len(set(keys)) == len(keys) == 2 * len(names), keys
    assert with_files(word, {"mine.glsl": "x/mine.glsl"}) == re.sub(r"^mine\.glsl", "x/mine.glsl", word)
    packing = Packing()
    assert packing.packed(word) == word and sorted(packing.files) == sorted(names)


@pytest.mark.parametrize(
    "name, ways",
    [
        ("mine.hlsl", [{"define": "A"}, {"define": "A=2"}, {"language": "slang"}, {}]),
        ("mine.hlsl:E:D", [{"define": "A"}, {}]),
        ("frame.png", [{"unpack": True}, {"unpack": False}, {"curve": "srgb"}, {}]),
    ],
)
def test_a_file_read_in_another_way_is_measured_separately(tmp_path, monkeypatch, name, ways):
    """The folder does not matter, because workers have the file in a folder of their own."""
    keys = []
    for folder in ("here", "there"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / name.partition(":")[0]).write_text("text")
        monkeypatch.chdir(tmp_path / folder)
        for way in ways:
            given = {"normals": name} if name.endswith("png") else {"encoding": word_with(name, **way)}
            reading = way if name.endswith("png") else {}
            keys.append(json.dumps(files_of(TABLES["quality"].options(**given, **reading))))
    assert keys[: len(ways)] == keys[len(ways) :] and len(set(keys)) == len(ways), keys


def test_sources_have_a_digest_of_sixteen_characters():
    assert sources() == sources() and len(sources()) == 16


def test_an_unknown_table_is_a_one_line_error(run, tmp_path):
    status, out, err = run("run", "--tables", "colours", "-o", str(tmp_path / "run"))
    assert (status, out) == (2, "") and "unknown table 'colours'; known: all, pick, budget, quality" in err
    assert not (tmp_path / "run").exists()


THREE = ("run", "--tables", "quality", "--encoding", "octahedral,spherical,spheremap", "--storage", "rg8")


THREE += ("--normals", "axes", "--backend", "jax")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The folder of a finished run with three rows; each test uses a copy."""
    folder = tmp_path_factory.mktemp("three") / "run"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["normalbench", *THREE, "-o", str(folder)])
        assert cli.main() == 0
    return folder


@pytest.mark.parametrize("name", ["rows.jsonl", "run.json", "quality.csv"])
def test_a_runs_own_files_are_not_overwritten(run, tmp_path, name):
    folder = tmp_path / "run"
    with opened(folder, FACTS) as open_run:
        kept(open_run, 1, [])
        open_run.finish()
    (folder / "quality.csv").write_text("mine")
    before = (folder / name).read_bytes()
    for command in (("report", str(folder)), ("report", str(folder), "--markdown"), ("list", "--format", "csv")):
        status, _, err = run(*command, "-o", str(folder / name))
        assert status == 2 and "belongs to the run in its folder" in err and err.count("\n") == 1, err
    assert (folder / name).read_bytes() == before
