"""The content of the report, for runs that are complete, partial, old, stopped or hostile."""

import hashlib
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from packed import packed_text
from PIL import Image

from normalbench.bench.ground.output.sources import sources
from normalbench.bench.keep.schema import SCHEMA
from normalbench.bench.tables.charts import bins
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.cost.charts import front_chart
from normalbench.bench.tables.quality.charts import histogram_chart, steps
from normalbench.bench.tables.quality.work import beside
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.render.charts import image_chart
from normalbench.reports.charts import pareto, wire

HOSTILE = "<script>alert(1)</script>\"'><img src=x onerror=alert(2)>$\\frac{`|\n@everyone [a](http://evil.example)\u202e\ud800\x1b[2J"


def quality_row(encoding: str, **more) -> dict:
    about = {"encoding": encoding, "storage": "rgba8", "rounding": "nearest", "normals": "playground"}
    figures = {"psnr_db": 50.0, "psnr_article_db": 49.0, "angle_mean_deg": 0.3, "angle_p99_deg": 0.6}
    figures |= {"angle_max_deg": 0.9, "effective_bits": None, "angle_counts": "0.25:3 0.28125:1"}
    return TABLES["quality"].empty() | about | {"backend": "jax", "bits": 16} | figures | more


def text_of_page(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


def a_run(folder: Path, tables: dict[str, list], **facts) -> Path:
    """Write a made-up results folder."""
    folder.mkdir(parents=True, exist_ok=True)
    about = {
        "schema": SCHEMA,
        "request": {"tables": ["all"], "count": 4096, "seed": 0},
        "finished": True,
        "machine": {"GL": "none"},
    }
    lines = [json.dumps({"table": table, "key": {}, "rows": rows}) + "\n" for table, rows in tables.items()]
    (folder / "rows.jsonl").write_text("".join(lines))
    about |= {"lines": len(lines), "digest": hashlib.sha256("".join(lines).encode()).hexdigest()}
    (folder / "run.json").write_text(json.dumps(about | facts))
    return folder


def test_the_rows_of_a_table_are_finished_once_for_a_page(run, tmp_path, monkeypatch):
    """One report finishes both rows in a single call."""
    work = import_module("normalbench.bench.tables.quality.work")
    seen: list[int] = []
    counting = replace(work.WORK, finish=lambda rows: seen.append(len(rows)) or work.WORK.finish(rows))
    monkeypatch.setattr("normalbench.bench.tables.table.import_module", lambda _: SimpleNamespace(WORK=counting))
    folder = a_run(tmp_path / "run", {"quality": [quality_row("xy"), quality_row("octahedral")]})
    assert run("report", str(folder))[0] == 0 and seen == [2]


class Read(HTMLParser):
    """A page's tags with their attributes, and its text."""

    def __init__(self, text: str):
        super().__init__()
        self.tags: list[tuple[str, dict]] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text += data

    def all(self, name: str) -> list[dict]:
        return [attributes for tag, attributes in self.tags if tag == name]


def reported(run, folder: Path, told: str = "") -> tuple[str, Read]:
    """Return the page of a run and its parsed text; `told` is the expected line on standard error, if any."""
    status, out, err = run("report", str(folder))
    assert status == 0 and (told in err and err.count("\n") == 1 if told else not err), err
    assert out == f"{folder / 'report.html'}\n"
    text = (folder / "report.html").read_text()
    return text, Read(text)


def test_names_cannot_reach_files_outside_the_run(run, tmp_path):
    rows = [quality_row("secret", normals=".."), quality_row("../secret"), quality_row("secret")]
    folder = a_run(tmp_path / "run", {"quality": rows})
    (folder / "images").mkdir()
    for name in ("normals.png", "secret-rgba8-decoded.png"):
        Image.new("RGB", (8, 8), "red").save(tmp_path / name)
        (folder / "images" / f"playground-{name}").symlink_to(tmp_path / name)
    np.savez(tmp_path / "a.npz", angle=np.ones((8, 8), np.uint8), codes=np.ones((8, 8, 1), np.uint32), bits=[8])
    (folder / "images" / "playground-secret-rgba8.npz").symlink_to(tmp_path / "a.npz")
    _, read = reported(run, folder)
    assert "secret" in read.text and not any(a.get("id") == "pictures" for a in read.all("section"))


def test_page_reports_a_stopped_run_and_other_sources(run, tmp_path):
    folder = a_run(tmp_path / "run", {"quality": [quality_row("octahedral")]}, finished=False, sources="other")
    _, read = reported(run, folder)
    assert "This run is not finished. Completed steps: 1." in read.text
    assert f"(sources other); this page was generated with sources {sources()}." in read.text
    assert "Measure it again: normalbench run." in read.text
    assert "it was requested but has no rows" in read.text


def test_rows_of_one_set_with_several_counts_are_not_compared(run, tmp_path):
    rows = [quality_row("xy", count=1000, psnr_db=60.0), quality_row("octahedral", count=4096)]
    _, read = reported(run, a_run(tmp_path / "run", {"quality": [*rows, quality_row("xy", count=4096, psnr_db=45.0)]}))
    assert "playground of 4096 normals, rgba8: dB by backend" in read.text
    assert "playground of 1000 normals, rgba8: dB by backend" in read.text


def lines_without_room(text: str) -> list[str]:
    """Return the lines of a page in Markdown that follow another line without an empty line between."""
    lines = text.splitlines()
    return [line for before, line in pairwise(lines) if before and line]


def test_rows_without_figures_do_not_get_a_separate_table(run, tmp_path):
    """Such rows have no count of normals; the page gives the reason in the table of all rows."""
    lost = {"psnr_db": None, "psnr_article_db": None, "angle_mean_deg": None, "count": None, "skipped": "no twin"}
    rows = [quality_row("mine", **lost), quality_row("mine", backend="glsl", count=4096)]
    rows += [quality_row("xy", count=4096), quality_row("mine", storage="rg8", **lost)]
    folder = a_run(tmp_path / "run", {"quality": rows})
    _, read = reported(run, folder)
    status, text, _ = run("report", str(folder), "--markdown")
    for page_text in (read.text, text):
        assert "playground, rgba8: dB by backend" in page_text and "None normals" not in page_text
        assert "playground, rg8" not in page_text and status == 0
    assert all(line.startswith(("|", "-")) for line in lines_without_room(text)), text
    assert "no twin" in packed_text(text_of_page(folder), "data-quality")


def test_infinite_column_has_no_star_and_the_article_column_is_hidden(run, tmp_path):
    """Rounded to 8 bits as in the article, many exact encodings lose nothing, so the column is of no use."""
    best = {"psnr_db": math.inf, "psnr_article_db": math.inf, "angle_mean_deg": 0.1}
    rows = [quality_row("xyz", **best), quality_row("octahedral", **best), quality_row("xy")]
    text, _ = reported(run, a_run(tmp_path / "run", {"quality": rows}))
    shown = text[
        text.index('id="quality-1-caption"') : text.index("How this was measured", text.index('id="quality-1-caption"'))
    ]
    assert "PSNR article" not in shown and '<td class="n">inf</td>' in shown
    assert 'class="n best"' not in shown, "two encodings share the smallest mean angle"
    rows[0] |= {"psnr_db": 60.0, "psnr_article_db": 55.0}
    rows[1] |= {"psnr_article_db": 60.0}
    text, _ = reported(run, a_run(tmp_path / "run", {"quality": rows}))
    shown = text[
        text.index('id="quality-1-caption"') : text.index("How this was measured", text.index('id="quality-1-caption"'))
    ]
    assert "PSNR article" in shown and '<td class="n best">inf</td>' in shown


def test_page_lists_what_a_run_skipped(run, tmp_path):
    folder = a_run(tmp_path / "run", {"quality": [quality_row("xy")]}, left_out=["mine.glsl: line 3 does not compile"])
    _, read = reported(run, folder)
    assert "Skipped in this run: mine.glsl: line 3 does not compile." in read.text


def test_encoding_without_a_twin_appears_in_charts_and_tables(run, tmp_path):
    rows = [quality_row("xy"), quality_row("xy", backend="glsl"), quality_row("mine", backend="glsl")]
    folder = a_run(tmp_path / "run", {"quality": rows})
    text, read = reported(run, folder)
    assert "Angles on playground, by jax or glsl" in read.text
    assert 'data-codec="mine rgba8"' in text and text.count(">mine rgba8</option>") == 2


def test_page_of_a_run_from_another_version_shows_how_to_measure_it_again(run, tmp_path):
    """The command is the same, without the folder of the run."""
    command = ["run", "--tables", "quality", "-o", "old run", "--normals", "my set.npy"]
    folder = a_run(tmp_path / "run", {"quality": [quality_row("xy")]}, sources="other", command=command)
    advice = "Measure it again: normalbench run --tables quality --normals 'my set.npy'."
    assert advice in reported(run, folder)[1].text
    assert "Measure it again" in run("report", str(folder), "--markdown")[1]


def test_a_row_without_an_encoding_has_no_empty_heading(run, tmp_path):
    """Such a row is the cost of a storage alone."""
    about = {"measure": "isa", "storage": "rg8", "operation": "encode", "stage": "fragment", "family": "navi31"}
    rows = [TABLES["cost"].empty() | about | {"instructions": count} for count in (3, 4)]
    text, _ = reported(run, a_run(tmp_path / "run", {"cost": rows}))
    assert "<th scope=row></th>" not in text and "Every row of cost" in text


def test_rows_from_another_version_are_shown_as_they_are(run, tmp_path):
    tables = {
        "quality": [
            {"encoding": "octahedral", "psnr": 50.0},
            {"encoding": "xy", "other": [1, 2]},
            quality_row("mine", bits=1e999),
        ],
        "render": [{"psnr": "high"}],
        "lights": [{"experiment": "equal", "sum": 1.0, "lights": 8}],
        "sweep": [{"ms_frame": 3.0, "ms_lights": 1.0}],
        "depth": [{"distance": 1.0, "error_max": 0.1, "near": 0.1, "far": 1.0, "fov": 60.0}],
        "colours": [{"red": 1}],
        "cost": [{"bits": 10**400, "instructions": 1e999, "stage": "fragment", "codes": ["xy"]}],
    }
    text, read = reported(run, a_run(tmp_path / "run", tables), "Rows of colours are left out")
    assert "The rows of quality do not match this version and are shown as they are; measure them again: " in read.text
    assert "normalbench run --tables quality." in read.text
    assert "Rows of colours are left out, because this version has no such table." in read.text
    assert "The charts of depth cannot be drawn from these rows" in read.text
    assert "octahedral" in packed_text(text, "data-quality") and "its rows have no histograms" in read.text


def test_rows_of_a_removed_table_are_left_out_with_a_note(run, tmp_path):
    """The note is printed both for the page and for Markdown."""
    tables = {"throughput": [{"encoding": "xy", "rate": 1.0}], "growth": [], "quality": [quality_row("xy")]}
    folder = a_run(tmp_path / "run", tables)
    for words in ((), ("--markdown",)):
        status, _, err = run("report", str(folder), *words)
        message = f"{folder}: Rows of throughput, growth are left out, because this version has no such table\n"
        assert status == 0 and message in err and "Traceback" not in err


def test_an_empty_run_still_has_a_page(run, tmp_path):
    _, read = reported(run, a_run(tmp_path / "run", {}))
    assert "Nothing yet" in read.text


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["{tmp}"], "is not a results folder"),
        (["{run}", "-o", "{tmp}"], "is a folder; name a file"),
        (["{run}", "-o", "/proc/nowhere/page.html"], "cannot write"),
        (["{run}", "--markdown", "-o", "/proc/nowhere/page.md"], "cannot write"),
    ],
)
def test_bad_input_is_a_one_line_error(run, tmp_path, arguments, said):
    folder = a_run(tmp_path / "run", {})
    status, out, err = run("report", *(a.format(tmp=tmp_path, run=folder) for a in arguments))
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert {path.name for path in folder.iterdir()} == {"run.json", "rows.jsonl"}


def test_the_page_shows_the_glsl_next_to_each_kernel(run, tmp_path):
    folder, rows = tmp_path / "run", []
    for name, count in (("per_pixel_view", 30), ("spherical", 24)):
        about = {"measure": "isa", "encoding": name, "operation": "encode", "stage": "fragment", "family": "navi31"}
        rows.append(TABLES["cost"].empty() | about | {"instructions": count, "transcendental": 1})
        path, text = cost.listing(rows[-1], "BB0:\n        v_cmp_lt_f32_e32 vcc, 0, v1\n")
        (folder / "disassembly" / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / "disassembly" / path).write_text(text)
    (folder / "disassembly" / "source").mkdir()
    (folder / "disassembly" / "source" / "spherical.glsl").write_text("// <b>spherical</b>\n")
    text, _ = reported(run, a_run(folder, {"cost": rows}))
    kernels = json.loads(packed_text(text, "data-listings"))
    assert "// <b>spherical</b>" in [entry["source"] for entry in kernels.values()], "the GLSL stands beside its kernel"
    assert "<b>spherical" not in text
    (folder / "disassembly" / path).unlink()
    _, read = reported(run, folder)
    assert "spherical" in read.text


def test_charts_of_odd_rows_keep_lines_apart_and_are_valid_json():
    """The rows have roundings, layouts and names from users' files; a browser cannot parse infinity."""
    rows = [quality_row("xy"), quality_row("xy", rounding="truncate"), quality_row('$a\\b"')]
    chart = histogram_chart(0, rows)
    specs = [wire.spec(chart)]
    lines = set(specs[0]["panels"][0]["tables"][0]["line"]["names"])
    assert lines == {"xy rgba8", "xy rgba8 truncate", '$a\\b" rgba8'}
    image = {"encoding": "xy", "storage": "rgba8", "rounding": "nearest", "psnr_db": math.inf, "normal_psnr_db": 50.0}
    chart = image_chart(0, "gloss", [image | {"layout": name} for name in ("thin", "wide")])
    assert chart.y.names == ("xy rgba8 thin", "xy rgba8 wide")
    specs.append(wire.spec(chart))
    panel = pareto.Panel('$x"', [pareto.Point("xy", math.inf, 40.0, 16, codec="xy rgba8")])
    front = front_chart("cost-0", HOSTILE, [panel])
    json.dumps([*specs, wire.spec(front)], allow_nan=False)


def test_every_column_is_defined():
    """This covers rows and summaries; a definition is a sentence."""
    for table in TABLES.values():
        for column in (*table.columns, *table.also):
            assert re.fullmatch(r"\S.*\.", column.says, re.S), f"{table.name}.{column.name}"
        assert table.column("colours") is None
    shown = beside([quality_row("octahedral")])[0]
    assert all(TABLES["quality"].column(column) for column in shown)


def test_histogram_outline_preserves_the_counts():
    bars = bins("0:5 0.00005:2 0.125:10 0.140625:20 0.25:4")
    assert bars[2] == (0.125, 0.140625, 10) and bars[4] == (0.25, 0.28125, 4)
    edges, heights = steps(bars)
    octaves = np.diff(np.log2(edges))
    assert np.dot(octaves, heights) == pytest.approx(41) and heights[0] * octaves[0] == pytest.approx(7)
    assert (np.diff(edges) > 0).all() and 0.0 in heights, "what is between is empty"
    assert bins("nonsense") == [] == bins(None)
