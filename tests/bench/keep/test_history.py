"""`normalbench history`: the commit, the row and the figure of each change, without the noise in times."""

import json
import os
import re
import subprocess
from pathlib import Path

import histories
import numpy as np
import pytest
from histories import DAY, FIRST, FOLD, LONGER, SHORTER, name_of
from manual import PAGES, ROOT

from normalbench.bench.keep.commit import commit_of
from normalbench.bench.keep.history import Series
from normalbench.bench.keep.runs import _begun_facts
from normalbench.bench.keep.time_steps import time_steps
from normalbench.bench.tables.registry import TABLES


@pytest.fixture
def thirty(tmp_path):
    return histories.write_history(tmp_path / "history")


def rows_of(run, *words):
    status, out, err = run("history", *map(str, words), "--format", "json")
    assert status == 0, err
    return json.loads(out)


def test_thirty_commits_have_two_regressions_one_of_them_mended(run, thirty):
    """The regressions are in two tables; times of four pipelines are noise and are not reported."""
    rows = rows_of(run, thirty)
    changes = {(row["commit"], row["table"], row["row"], row["column"], row["verdict"], row["mended"]) for row in rows}
    mine, longer = (name_of(FOLD), "quality", "mine rg8 sphere jax"), (name_of(LONGER), "cost")
    assert changes == {
        (*mine, "psnr_db", "worse", None),
        (*mine, "angle_mean_deg", "worse", None),
        (*longer, "mine decode fragment navi21", "instructions", "worse", name_of(SHORTER)),
        (*longer, "mine decode fragment navi31", "instructions", "worse", name_of(SHORTER)),
    }
    assert rows[0]["column"] == "psnr_db"


def test_text_output_has_a_sentence_and_a_line_for_each_regression(run, thirty):
    """Regressions that are not mended come first."""
    status, out, err = run("history", str(thirty), "--format", "markdown")
    assert (status, err) == (0, "")
    lead, *rest = (line for line in out.splitlines() if line and not line.startswith("|"))
    assert lead.startswith(f"30 runs, from {name_of(0)[:8]}, 2026-01-01 (Change 0) to ")
    assert "(Shorten the fold)" in rest[0] and "psnr_db from 48.25 to 45.12 dB" in rest[0]
    assert (
        "(Guard the decoder" in rest[1] and f"mended at {name_of(SHORTER)[:8]}, 2026-01-22 (Drop the guard)" in rest[1]
    )
    head, _, first, second = (line for line in out.splitlines() if line.startswith("|"))
    assert all(column in head for column in ("commit", "table", "row", "column", "before", "after", "mended"))
    assert all(word in first for word in (name_of(FOLD)[:8], "quality", "mine rg8", "psnr_db", "45.12"))
    assert all(word in second for word in (name_of(LONGER)[:8], "cost", "instructions", name_of(SHORTER)[:8]))


def test_the_manual_shows_the_printed_output(run, thirty, monkeypatch):
    """The page is docs/runs-and-reports.md, at 120 columns."""
    monkeypatch.setenv("COLUMNS", "120")
    shown = re.search(r"<!-- history -->\n```text\n(.*?)```", PAGES[ROOT / "docs/runs-and-reports.md"], re.S)
    assert shown and shown[1] == run("history", str(thirty))[1]


def test_figures_by_commit_have_a_line_for_each_change(run, thirty):
    """JSON has each figure of each run."""
    words = ("--by", "commit", "--encoding", "mine", "--storage", "rg8", "--column", "psnr-db")
    status, out, _ = run("history", str(thirty), *words, "--format", "markdown")
    lines = [line for line in out.splitlines() if line.startswith("|")][2:]
    assert status == 0 and [line.split("|")[1].strip() for line in lines] == [name_of(n)[:8] for n in (0, FOLD, 29)]
    rows = rows_of(run, thirty, *words)
    assert [row["value"] for row in rows] == [48.25] * FOLD + [45.125] * (30 - FOLD)


def test_rows_with_different_counts_are_not_compared_and_this_is_reported(run, tmp_path):
    """With far fewer normals, the largest sampled error is smaller although the encoding has not changed."""
    for number, count in enumerate((2**20, 2**14)):
        steps = histories.steps(0, np.random.default_rng(1))
        for row in (row for step in steps for row in step["rows"] if "count" in row):
            row["count"] = count
        histories.write_run(tmp_path / str(number), number, steps, request={"count": count})
    _, out, _ = run("history", str(tmp_path))
    counted = sum("count" in row for step in steps for row in step["rows"])
    lines = [f"{counted} rows not compared, because their counts of normals differ", "no figure got worse"]
    assert counted and out.splitlines()[1:] == lines


def test_a_name_without_a_row_lists_the_known_names(run, thirty, tmp_path):
    status, _, err = run("history", str(thirty), "--encoding", "octahedrul")
    assert status == 2 and "did you mean octahedral?" in err and "all, mine, octahedral" in err
    status, _, err = run("history", str(tmp_path / "nothing"))
    assert status == 2 and "contains no run" in err and err.count("\n") == 1


def test_a_table_with_a_single_time_counts_as_timed():
    assert Series(TABLES["maps"], "a").is_timed and not Series(TABLES["quality"], "a").is_timed


def test_only_a_lasting_change_in_timings_is_reported(run, tmp_path):
    """From one commit on, a pipeline is 30% slower; the other times are noise."""
    noise = np.random.default_rng(1)
    for number in range(30):
        steps = histories.steps(number, noise)
        slow = next(step["rows"][0] for step in steps if step["key"].get("pipeline") == "hybrid")
        slow["ms_frame"] *= 1.3 if number >= 16 else 1
        histories.write_run(tmp_path / str(number), number, steps)
    (row,) = rows_of(run, tmp_path, "--tables", "sweep")
    assert (row["row"], row["column"], row["verdict"], row["commit"]) == ("hybrid", "ms_frame", "worse", name_of(16))
    assert 25 < float(row["change"].removesuffix("%")) < 35


def test_times_from_two_machines_are_separate_series(run, tmp_path):
    noise = np.random.default_rng(1)
    for number in range(30):
        steps = histories.steps(0, noise)
        for step in steps[-4:]:
            step["rows"][0]["ms_frame"] *= 2 if number >= 16 else 1
        histories.write_run(tmp_path / str(number), number, steps, machine={"GL": "new" if number >= 16 else "old"})
    assert rows_of(run, tmp_path) == []
    assert run("history", str(tmp_path))[1].splitlines()[1] == "no figure got worse"


@pytest.mark.parametrize(("count", "begin", "end"), [(30, 15, 30), (40, 14, 28), (100, 92, 100), (300, 100, 120)])
def test_a_step_in_timings_is_found_at_its_commit(count, begin, end):
    rng = np.random.default_rng(3)
    times = 10 * np.exp(0.01 * rng.normal(0, 1, count))
    times[begin:end] *= 1.1
    assert time_steps(list(times), count - 1) == [edge for edge in (begin, end) if edge < count]


def test_three_runs_after_a_step_are_too_few():
    assert time_steps([10 + 0.001 * number for number in range(27)] + [20, 20.1, 20.2], 29) == []


def quality(psnr, **more):
    row = {"encoding": "mine", "storage": "rg8", "psnr_db": psnr, "angle_max_deg": None, "skipped": None} | more
    return [{"table": "quality", "key": {}, "rows": [row]}]


def history_of(run, folder, *several, **facts):
    for number, steps in enumerate(several):
        histories.write_run(folder / str(number), number, steps, **facts)
    names = {name_of(number): number for number in range(len(several))} | {None: None}
    return [(names[row["commit"]], row["column"], row["verdict"], names[row["mended"]]) for row in rows_of(run, folder)]


def test_a_figure_that_recovers_is_mended_and_not_better(run, tmp_path):
    """A near recovery after a large loss counts as mended; only a new best value is better."""
    several = [quality(psnr) for psnr in (50.0, 45.0, 47.0, 49.95, 51.0)]
    assert history_of(run, tmp_path, *several) == [(1, "psnr_db", "worse", 3), (4, "psnr_db", "better", None)]


def test_a_figure_that_some_runs_lack_is_compared_with_its_last_value(run, tmp_path):
    several = [quality(50.0, angle_max_deg=worst) for worst in (0.5, None, 0.6, None, 0.6)]
    assert history_of(run, tmp_path, *several) == [(2, "angle_max_deg", "worse", None)]


def test_a_row_that_can_no_longer_be_measured_is_worse_until_it_recovers(run, tmp_path):
    lost = quality(None, skipped="it does not compile")
    assert history_of(run, tmp_path, quality(50.0), lost, lost, quality(50.0)) == [(1, "psnr_db", "worse", 3)]


def test_a_row_is_gone_if_the_same_request_no_longer_yields_it(run, tmp_path):
    """A row is not gone if a run was stopped or its request was smaller."""
    both, other = quality(50.0) + quality(40.0, encoding="xy"), quality(40.0, encoding="xy")
    assert history_of(run, tmp_path / "same", both, other, other, both) == [(1, "", "gone", 3)]
    assert history_of(run, tmp_path / "stopped", both, other, finished=False) == []
    folder = tmp_path / "less"
    for n, steps in enumerate((both, other, both, other)):
        histories.write_run(folder / str(n), n, steps, request={"tables": ["all" if len(steps) > 1 else "quality"]})
    assert rows_of(run, folder) == []


def test_rows_with_different_numbers_of_normals_are_not_compared(run, tmp_path):
    """A nightly run with more normals alternates with the runs of each commit."""
    for number, (psnr, count) in enumerate(((50.0, 4096), (49.9, 2**20)) * 3):
        histories.write_run(tmp_path / str(number), number, quality(psnr, count=count), request={"count": count})
    assert rows_of(run, tmp_path) == []


def test_other_changes_at_a_commit_are_reported(run, tmp_path):
    histories.write_run(tmp_path / "one", 0, quality(50.0))
    histories.write_run(tmp_path / "two", 1, quality(45.0), machine={"GL": "two"}, sources="t")
    status, _, err = run("history", str(tmp_path / "two"), str(tmp_path / "one"))
    assert status == 0
    assert err == f"normalbench: also changed at {name_of(1)[:8]}: normalbench, GL\n"


def git(folder: Path, *words: str, at: int = FIRST) -> None:
    date = {"GIT_COMMITTER_DATE": f"{at} +0000", "GIT_AUTHOR_DATE": f"{at} +0000", "HOME": str(folder)}
    who = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
    subprocess.run(
        ["git", *who, *words], cwd=folder, check=True, capture_output=True, env={"PATH": "/usr/bin:/bin"} | date
    )


@pytest.fixture
def repository(tmp_path):
    git(tmp_path, "init", "-q")
    (tmp_path / "mine.glsl").write_text("// one\n")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-q", "-m", "Begin\n\nMore of it.")
    return tmp_path


def test_a_run_knows_its_commit(repository):
    head = commit_of(None, repository)
    assert len(head["name"]) == 40 and (head["time"], head["subject"], head["changed"]) == (FIRST, "Begin", False)
    (repository / "mine.glsl").write_text("// two\n")
    assert commit_of(None, repository) == head | {"changed": True}
    assert commit_of("4711", repository) == {"name": "4711"}


@pytest.mark.parametrize("setting", ["core.fsmonitor", "core.hooksPath", "filter.odd.clean", "filter.odd.process"])
def test_programs_named_by_a_repository_are_not_run(repository, setting):
    """The folder may be untrusted: file monitors, hooks and filters must not run."""
    started, hooks = repository / "started", repository / "hooks"
    hooks.mkdir()
    for name in ("program", "post-index-change"):
        (hooks / name).write_text(f"#!/bin/sh\necho started > {started}\ncat\n")
        (hooks / name).chmod(0o755)
    git(repository, "config", setting, str(hooks if setting == "core.hooksPath" else hooks / "program"))
    (repository / ".gitattributes").write_text("* filter=odd\n")
    os.utime(repository / "mine.glsl", (1, 1))
    assert commit_of(None, repository)["subject"] == "Begin"
    assert not started.exists()
    # git itself starts each of them.
    subprocess.run(["git", "status"], cwd=repository, capture_output=True)
    assert started.exists()


def test_filters_of_a_submodule_are_not_run(repository):
    """A submodule has its own settings, which `git status` follows."""
    inner, started = repository / "inner", repository / "started"
    inner.mkdir()
    git(inner, "init", "-q")
    (inner / "file.txt").write_text("x\n")
    git(inner, "add", ".")
    git(inner, "commit", "-q", "-m", "Begin")
    git(repository, "add", "inner")
    git(repository, "commit", "-q", "-m", "Take it")
    git(inner, "config", "filter.odd.clean", f"touch {started}; cat")
    (inner / ".gitattributes").write_text("*.txt filter=odd\n")
    os.utime(inner / "file.txt", (1, 1))
    assert commit_of(None, repository)["subject"] == "Take it" and not started.exists()
    subprocess.run(["git", "status"], cwd=repository, capture_output=True)
    assert started.exists(), "git itself starts it"


def test_missing_objects_are_not_fetched_from_a_repositorys_remote(repository):
    """A partial clone fetches missing objects with a program that its settings name."""
    started = repository / "started"
    tree = subprocess.run(["git", "rev-parse", "HEAD^{tree}"], cwd=repository, capture_output=True, text=True).stdout
    (repository / ".git" / "objects" / tree[:2] / tree[2:].strip()).unlink()
    settings = {"url": str(repository), "promisor": "true", "uploadpack": f"touch {started}; false"}
    for name, value in settings.items():
        git(repository, "config", f"remote.origin.{name}", value)
    git(repository, "config", "core.repositoryformatversion", "1")
    git(repository, "config", "extensions.partialClone", "origin")
    assert commit_of(None, repository)["subject"] == "Begin" and not started.exists()
    subprocess.run(["git", "status"], cwd=repository, capture_output=True)
    assert started.exists(), "git itself starts it"


def test_commits_within_one_second_keep_their_order(repository):
    """A rebase makes such commits."""
    ranks = []
    for number in range(3):
        git(repository, "commit", "-q", "--allow-empty", "-m", str(number), at=FIRST + DAY)
        ranks.append(commit_of(None, repository)["rank"])
    assert ranks == [1, 2, 3]


def test_a_folder_without_a_repository_has_no_commit(tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    assert commit_of(None, tmp_path) == {}
    monkeypatch.setenv("PATH", "")
    assert commit_of(None, tmp_path) == {}


def test_changes_without_git_are_in_run_order_under_their_given_names(run, tmp_path):
    for name, day, psnr in (("b", 3, 45.0), ("a", 1, 50.0), ("c", 2, 50.0)):
        when = f"2026-01-0{day}T00:00:00+0000"
        histories.write_run(tmp_path / name, 0, quality(psnr), time=when, commit={"name": f"change {name}"})
    (row,) = rows_of(run, tmp_path)
    assert (row["commit"], row["time"]) == ("change b", "2026-01-03T00:00:00Z")


def test_a_resumed_run_belongs_to_the_commit_at_which_it_resumes(tmp_path):
    histories.write_run(tmp_path / "run", 0, quality(50.0), finished=False)
    facts = json.loads((tmp_path / "run/run.json").read_text())
    assert _begun_facts(tmp_path / "run", facts | {"commit": {"name": "next"}})["commit"] == {"name": "next"}


def test_an_edited_commit_causes_no_error(run, tmp_path):
    for n, commit in enumerate(({"name": "a", "time": 1e300, "rank": "x"}, {"name": 3, "time": -5, "subject": None})):
        histories.write_run(
            tmp_path / str(n), n, quality(50.0 - n), time=f"2026-01-0{n + 1}T00:00:00+0000", commit=commit
        )
    (row,) = rows_of(run, tmp_path)
    assert (row["commit"], row["time"]) == ("3", "2026-01-02T00:00:00Z")
