"""The content of the report, for runs that are complete, partial, old, stopped or hostile."""

import re
import time

import numpy as np
import pytest
from PIL import Image
from test_report import HOSTILE, Read, a_run, quality_row, reported

from normalbench.bench.subjects.normals.normal_sets import hemisphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.quality.charts import histogram_chart
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports.charts import draw, plots
from normalbench.reports.page import page
from normalbench.reports.page.markdown import LONGEST

FORBIDDEN = ("<script>alert", "<img src=x", "\u202e", "\x1b")


def test_a_hostile_run_injects_nothing(run, tmp_path):
    """Names come from users' files: in rows, columns, tables, facts and image names."""
    rows = [quality_row(HOSTILE, skipped=HOSTILE), quality_row("octahedral", psnr_db=49.0) | {HOSTILE: HOSTILE}]
    tables = {
        "quality": rows,
        "render": [{"encoding": HOSTILE, "storage": HOSTILE, "scene": HOSTILE, "psnr_db": 1.0, "normal_psnr_db": 2.0}],
        "sweep": [{"pipeline": HOSTILE, "ms_frame": 1.0, "ms_lights": 0.5, "clock": HOSTILE}],
        "cost": [{"family": "../../..", "encoding": HOSTILE, "stage": "fragment", "instructions": 3}],
        HOSTILE: [{HOSTILE: HOSTILE}],
    }
    folder = a_run(tmp_path / "run", tables, machine={HOSTILE: HOSTILE}, command=[HOSTILE], time=HOSTILE)
    text, read = reported(run, folder, "this version has no such table")
    kinds = [attributes.get("type") for attributes in read.all("script")]
    assert kinds.count(None) == len(page.SCRIPTS), "only the page's own"
    assert set(kinds) <= {None, "application/json", "text/plain"}, "the others are data"
    assert not any(name.startswith("on") for _, attributes in read.tags for name in attributes)
    assert all(a.get("src", "").startswith("data:") for a in read.all("img"))
    assert not any(part in text for part in FORBIDDEN)
    assert "<script>alert(1)</script>" in read.text, "it is shown as it is"
    run("report", str(folder), "--charts")
    charts = list((folder / "charts").glob("*.svg"))
    assert charts and not any("<script" in chart.read_text() for chart in charts)


def test_page_of_one_table_does_not_mention_other_tables(run, tmp_path):
    row = {"depth": "linear", "storage": "r32f", "rebuilt": "eye_ray", "backend": "jax", "near": 0.1, "far": 10.0}
    rows = [TABLES["depth"].empty() | row | {"fov": 60.0, "distance": d, "error_max": d / 1e6} for d in (1.0, 10.0)]
    request = {"tables": ["depth"], "count": 4096, "seed": 0}
    _, read = reported(run, a_run(tmp_path / "run", {"depth": rows}, request=request))
    assert "Results of this run" in read.text and "no rows" not in read.text
    assert "Normal accuracy" not in read.text, "nobody asked for it"
    assert "Depth accuracy" in read.text and "largest position error, near 0.1, far 10" in read.text
    assert not (tmp_path / "run/charts").exists()
    assert run("report", str(tmp_path / "run"), "--charts")[0] == 0
    assert {path.name for path in (tmp_path / "run/charts").iterdir()} == {"depth.png", "depth.svg"}


def test_a_chart_is_drawn_once_for_each_file(tmp_path, monkeypatch):
    """The layout is computed for the first file."""
    figure = draw.figure([histogram_chart(0, [quality_row("xy")])])
    drawn, painted = [], type(figure).draw
    monkeypatch.setattr(type(figure), "draw", lambda self, renderer: drawn.append(self.dpi) or painted(self, renderer))
    plots.save(figure, *((tmp_path / f"chart.{ending}", ending) for ending in ("svg", "png", "pdf")))
    assert len(drawn) == 3 and drawn[1] == plots.DPI
    with Image.open(tmp_path / "chart.png") as image:
        assert image.size == tuple(np.rint(figure.get_size_inches() * plots.DPI).astype(int))


def test_markdown_has_no_mentions_or_links_and_fits_a_comment(run, tmp_path):
    many = [quality_row(f"code_{n}", normals=f"set_{n % 40}") for n in range(1000)]
    first = quality_row("@everyone", psnr_db=60.0)
    folder = a_run(tmp_path / "run", {"quality": [first, quality_row(HOSTILE), *many]})
    status, out, _ = run("report", str(folder), "--markdown")
    assert status == 0 and len(out) <= LONGEST and "`@everyone" in out and out.rstrip().endswith("shows them all.")
    outside = re.sub(r"`[^`\n]*`", "", out)
    assert not re.search(r"http|@|\]\(|<(?!/?(details|summary)>)", outside), "what is odd is code"
    assert out.startswith("## normalbench: run\n")


def test_markdown_of_a_real_run_is_short_and_without_links(run, results, tmp_path):
    folder, *_ = results
    status, _, err = run("report", str(folder), "--markdown", "-o", str(tmp_path / "comment.md"))
    text = (tmp_path / "comment.md").read_text()
    assert (status, err) == (0, "") and len(text) < 65536
    assert "JAX and GLSL agree within 0.0" in text
    assert "| octahedral " in text and "http" not in text and "](" not in text


def test_report_leaves_the_run_unchanged_and_matches_the_page_of_run(run, results, tmp_path):
    folder, out, _ = results
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    assert f"Page: {folder / 'report.html'}" in out
    begin = time.process_time()
    status, _, err = run("report", str(folder), "--charts", "-o", str(tmp_path / "page.html"))
    assert status == 0, err
    assert time.process_time() - begin < 60, "seconds of all cores"
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
    # Elsewhere the files of rows are not beside the page.
    links = re.compile(rb'[:,] <a href="\w+\.(csv|json)">[^<]*</a>')
    assert links.search(before[folder / "report.html"]) and not links.search((tmp_path / "page.html").read_bytes())
    assert (tmp_path / "page.html").read_bytes() == links.sub(b"", before[folder / "report.html"])
    names = {path.name for path in (tmp_path / "page-charts").iterdir()}
    assert {"angles-0.png", "angles-0.svg", "sphere-16-bits.png", "sphere-16-bits.svg"} <= names


def test_the_page_is_small_fetches_nothing_and_begins_with_the_answer(results):
    text = (results[0] / "report.html").read_text()
    read = Read(text)
    assert len(text) < 4e6
    assert "default-src 'none'" in next(a["content"] for a in read.all("meta") if a.get("http-equiv"))
    fetched = [a[n] for _, a in read.tags for n in ("src", "href", "xlink:href", "srcset", "action") if n in a]
    beside = {path.name for path in results[0].iterdir()}
    assert fetched and all(f.startswith(("data:", "#")) or f in beside for f in fetched)
    assert not re.search(r"@import|url\((?!#)", text)
    assert read.text.index("JAX and GLSL agree within 0.0") < read.text.index("How it was measured")


def test_no_two_elements_share_an_id(results):
    text = (results[0] / "report.html").read_text()
    ids = [attributes["id"] for _, attributes in Read(text).tags if "id" in attributes]
    assert len(ids) == len(set(ids)) > 30


def test_maps_are_in_the_page_with_means_by_area(results):
    read = Read((results[0] / "report.html").read_text())
    alts = [a["alt"] for a in read.all("img") if a.get("data-which") == "mean"]
    assert len(alts) == len(list((results[0] / "sphere").iterdir()))
    case = quality.QualityCase(Codec(ENCODINGS["xy"], STORAGES["rgba8"]), hemisphere(2**18), "jax")
    measured = quality.measure(case)["angle_mean_deg"]
    (text,) = [alt for alt in alts if alt.startswith("xy rgba8,")]
    (mean,) = re.findall(r"mean ([\d.]+) degrees facing the viewer", text)
    assert float(mean) == pytest.approx(measured, rel=0.01) and "away" not in text, "it cannot hold what faces away"
