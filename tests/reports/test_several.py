"""Several runs on one page: what differs first, every figure side by side, whatever names hold."""

import math

import pytest
from browsing import AXE
from test_report import FORBIDDEN, HOSTILE, Read, a_run, quality_row

from normalbench.bench.keep import side_by_side
from normalbench.bench.keep.runs import read_run


def two_backends(encoding: str, jax: float, glsl: float) -> list[dict]:
    by_glsl = {"backend": "glsl", "device": "a device", "psnr_db": glsl}
    return [quality_row(encoding, psnr_db=jax), quality_row(encoding, **by_glsl)]


@pytest.fixture
def runs(tmp_path):
    """Three runs: the GLSL of the second is off, on another machine; the third has a row more, and exact ones."""
    tables = {
        "one": [*two_backends("xy", 40.0, 40.0), *two_backends("octahedral", 50.0, 50.0)],
        "two": [*two_backends("xy", 40.0, 39.5), *two_backends("octahedral", 50.0, 50.25)],
        "three": [*two_backends("xy", 40.0, 40.0), *two_backends("octahedral", math.inf, math.inf), quality_row("xyz")],
    }
    machines = {"one": {"GL": "A", "jax": "1"}, "two": {"GL": "B", "jax": "1"}, "three": {"GL": "A", "jax": "1"}}
    return {n: a_run(tmp_path / n, {"quality": rows}, machine=machines[n]) for n, rows in tables.items()}


def test_what_differs_comes_first_then_the_machines_and_how_far_back_ends_agree(runs):
    sheets = list(side_by_side.sheets({name: read_run(folder) for name, folder in runs.items()}))
    assert [sheet.title for sheet in sheets] == [
        "From one to two, the worst first",
        "From one to three, the worst first",
        "Every figure that differs",
        "The machines",
        "JAX and GLSL, device by device: the largest difference",
    ]
    worst = sheets[0].rows[0]
    assert (worst["verdict"], worst["before"], worst["after"]) == ("worse", 40.0, 39.5)
    (differing,) = [r for r in sheets[2].rows if r["row"] == "xy rgba8 nearest playground glsl"]
    assert differing["figure"] == "psnr_db"
    assert [differing[name] for name in runs] == [40.0, 39.5, 40.0]
    assert sheets[3].rows[0]["fact"] == "GL", "what differs comes first"
    apart = {row["run"]: row for row in sheets[4].rows if row["figure"] == "psnr_db"}
    assert apart["one"]["largest"] == 0 and apart["two"]["largest"] == 0.5
    assert apart["two"]["where"] == "xy rgba8 playground" and apart["two"]["device"] == "a device"
    assert apart["three"]["rows"] == 1, "infinite figures are not subtracted"


def test_runs_that_are_the_same_say_so(runs):
    same = read_run(runs["one"])
    first, *_ = side_by_side.sheets({"a": same, "b": same})
    assert first.rows == [{"table": "all", "change": "no figure differs"}]


def test_runs_of_one_name_are_numbered():
    assert side_by_side.labels(["a", "b", "a"]) == ["a (1)", "b", "a (2)"]


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["{one}", "{two}", "--pictures", "beside"], "--pictures is for the page of one run"),
        (["{one}", "{two}", "--charts"], "--charts is for the page of one run"),
        (["{one}", "nowhere"], "nowhere"),
        (["{one}", "{two}", "-o", "/proc/nowhere/page.html"], "cannot write"),
    ],
)
def test_bad_input_is_one_line(run, runs, arguments, said):
    status, out, err = run("report", *(argument.format(**runs) for argument in arguments))
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


def test_a_text_for_a_pull_request_has_what_differs(run, runs):
    status, out, _ = run("report", str(runs["one"]), str(runs["two"]), "--markdown")
    assert status == 0 and out.startswith("## normalbench: one, two\n")
    assert "**From one to two, the worst first**" in out and "| fact " in out and "Every figure" not in out
    assert (
        "xy: worse in 1 of 2 rows; most in quality rgba8 nearest playground glsl: psnr_db from 40.00 to 39.50 dB" in out
    )


def test_hostile_runs_inject_nothing(run, tmp_path):
    for name in ("a", "b"):
        rows = [quality_row(HOSTILE, psnr_db=40.0 + len(name)), quality_row("xy") | {HOSTILE: HOSTILE}]
        a_run(tmp_path / name, {"quality": rows, HOSTILE: [{HOSTILE: HOSTILE}]}, machine={HOSTILE: HOSTILE + name})
    assert run("report", str(tmp_path / "a"), str(tmp_path / "b"), "-o", str(tmp_path / "p.html"))[0] == 0
    text = (tmp_path / "p.html").read_text()
    assert not any(part in text for part in FORBIDDEN)
    kinds = [attributes.get("type") for attributes in Read(text).all("script")]
    assert kinds.count(None) == 2 and set(kinds) <= {None, "application/json"}


@pytest.mark.slow
def test_a_figure_is_chosen_and_what_differs_is_marked(browser, run, runs, tmp_path):
    assert run("report", *map(str, runs.values()), "-o", str(tmp_path / "p.html"))[0] == 0
    page = browser.new_page()
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((tmp_path / "p.html").as_uri())
    part = page.locator("#quality [data-figures]")
    assert part.locator("[data-figure]").input_value() == "psnr_db", "the figure in which most differs"
    assert part.locator("tbody tr.differs").count() == 3
    part.get_by_label("only what differs").check()
    assert part.locator("[data-shown]").text_content() == "3 of 5 rows"
    part.locator("[data-figure]").select_option("angle_mean_deg")
    assert part.locator("[data-shown]").text_content() == "0 of 5 rows", "a row that one run has is not a difference"
    part.get_by_label("only what differs").uncheck()
    assert part.locator("tbody tr").first.locator("td").all_text_contents() == ["0.3000"] * 3
    part.locator("[data-figure]").select_option("psnr_db")
    part.locator("thead button", has_text="three").click()
    assert part.locator("tbody tr").first.locator("td").last.text_content() == "inf", "the best on top"
    from axe_playwright_python.base import AXE_FILE_PATH

    page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    assert page.evaluate(AXE) == [] == said
    page.close()
