"""Measuring in the page with a browser's own renderer: codes of the run, faults, interruptions and saved devices."""

import json
import re
from functools import cache

import numpy as np
import pytest
from browsing import AXE, PHONE, Laboratory, no_files, no_swiftshader

from normalbench.bench.measures.live import checks, normals, programs
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.normals.octahedral import encode
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec3

MEASURE = "[data-live=measure]"


OCTAHEDRAL = Codec(ENCODINGS["octahedral"], STORAGES["rgba8"])


# The least share of codes that are equal at 8 and 10 bits, which GLSL and JAX keep as well.
LEAST_SHARE = 0.999


SECONDS = 120


KEYS = {
    *("encoding", "storage", "rounding", "target", "normals", "equal", "one_step", "further"),
    *("mean_deg", "max_deg", "run_mean_deg", "encode_ms", "decode_ms", "timer"),
}


class Measured(Laboratory):
    """A laboratory that measures times only if asked."""

    def __init__(self, browser, path, **more):
        super().__init__(browser, path, **more)
        self.page.locator("#measure-times").uncheck()

    def reset(self):
        super().reset()
        self.page.locator("#measure-times").uncheck()

    def ask(self, script, *given):
        return self.page.evaluate(script, *given)

    def only(self, *encodings):
        """Measure only the codecs of these encodings."""
        self.ask(
            "names => { live.measuring.codecs = live.data.codecs.filter((c) => names.includes(c.encoding)); }",
            encodings,
        )

    def start(self):
        self.page.locator("[data-measure]").click()

    def finish(self) -> list[dict]:
        self.page.wait_for_selector(f"{MEASURE} progress", state="hidden", timeout=1000 * SECONDS)
        return self.ask("live.measuring.rows.map((row) => ({ ...row, difference: row.difference }))")

    @property
    def status(self) -> str:
        return self.page.locator("[data-measured]").inner_text()


@pytest.fixture(scope="module")
def open_laboratory(gl_browser, report):
    opened = Measured(gl_browser, report)
    yield opened
    opened.context.close()


@pytest.fixture
def laboratory(open_laboratory, report):
    open_laboratory.reset()
    yield open_laboratory
    assert not [line for line in open_laboratory.said if "rror" in line], open_laboratory.said
    assert open_laboratory.asked == [report.as_uri()], "a page that asks for nothing"


@no_files
def test_codes_measured_on_this_device_match_the_run_and_are_saved(laboratory, tmp_path):
    """For every codec of the small run at least 99.9% of the codes are equal, and the angles match the run's."""
    laboratory.start()
    rows = laboratory.finish()
    assert len(rows) == laboratory.ask("live.data.codecs.length") >= 8, laboratory.status
    for row in rows:
        assert row["equal"] >= LEAST_SHARE * row["normals"] and not row["further"], (row["encoding"], row["difference"])
        assert row["mean_deg"] == pytest.approx(row["run_mean_deg"], abs=1e-9), row
        assert row["target"] == "RGBA8", row
    shown = laboratory.page.locator("[data-results] tbody tr")
    assert shown.count() == len(rows)
    with laboratory.page.expect_download() as download:
        laboratory.page.locator("[data-save]").click()
    assert re.fullmatch(r"normalbench-[a-z0-9-]+\.json", download.value.suggested_filename)
    assert download.value.suggested_filename in laboratory.page.locator("[data-keep] code").inner_text()
    download.value.save_as(tmp_path / "device.json")
    saved = json.loads((tmp_path / "device.json").read_text())
    assert saved["normalbench_device"] == 1 and "SwiftShader" in saved["renderer"] and "Chrome" in saved["browser"]
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", saved["made"]) and saved["sources"]
    assert all(set(row) == KEYS for row in saved["codecs"]), saved["codecs"][0]
    assert all(row["equal"] + row["one_step"] + row["further"] == row["normals"] for row in saved["codecs"])
    assert not laboratory.asked[1:], "nothing is asked for"


STORED = """checks => live.measuring.codecs = live.data.storages
  .filter(({ encoding }) => encoding === "octahedral")
  .map((codec) => ({ ...codec, checks: checks[codec.storage] }))"""


@no_swiftshader
def test_every_storage_is_read_back_as_in_the_run(laboratory):
    """Fixed point, halves, numbers across bytes and packed integers match; SwiftShader truncates small floats."""
    given = {name: checks.checks(Codec(ENCODINGS["octahedral"], STORAGES[name])) for name in programs.USUAL}
    laboratory.ask(STORED, given)
    laboratory.start()
    rows = {row["storage"]: row for row in laboratory.finish()}
    assert set(rows) == set(programs.USUAL)
    small = rows.pop("r11g11b10f")
    for row in rows.values():
        assert row["equal"] == row["normals"] and row["difference"] == "none", (row["storage"], row["difference"])
    targets = {name: row["target"] for name, row in rows.items() if name != "rg16"}
    assert targets == {"rgba8": "RGBA8", "rgb10a2": "RGB10_A2", "rg8": "RG8", "rg16f": "RG16F", "rgb8_12_12": "RGBA8"}
    assert rows["rg16"]["target"] in ("RG16", "R32UI")
    assert 0.2 < small["equal"] / small["normals"] < 0.4 and small["one_step"] > 0.4 * small["normals"]
    assert re.match(r"x differs for \d+ normals, by 1 step; y differs for \d+ normals, by 1 step;", small["difference"])
    assert small["mean_deg"] > 1.5 * small["run_mean_deg"]


@no_swiftshader
def test_facts_describe_the_behaviour_of_a_device(laboratory):
    """SwiftShader rounds fixed point and halves to nearest even, truncates small floats and computes in 32 bits."""
    laboratory.only("xyz")
    laboratory.start()
    laboratory.finish()
    facts = laboratory.ask("live.measuring.facts")
    assert facts["rounds RGBA8"] == facts["rounds RGB10_A2"] == facts["rounds RG16F"] == "nearest, ties to even", facts
    assert facts["rounds R11F_G11F_B10F"] == "truncate"
    assert facts["renders RGB565"] == facts["renders RGBA32F"] == "yes"
    assert facts["filters RGBA8"].startswith("yes") and facts["filters RGBA32F"] == "no"
    assert facts["resolves RGBA8"] == "the mean of the codes, to within 0.5 steps"
    assert facts["highp mantissa bits"] == 23 and facts["mediump mantissa bits"] >= 10
    assert "RGBA16F stores NaN" in facts["NaN"] and facts["subnormal halves"] == "kept"


def test_an_altered_constant_is_found_and_reported(laboratory):
    """With 1.015625 for 1 in the fold, the codec's row gives the numbers and a normal. No other codec differs."""
    laboratory.only("octahedral", "stereographic", "xyz")
    altered = laboratory.ask(
        """() => {
          const codec = live.data.codecs.find((c) => c.encoding === "octahedral"), before = codec.source;
          codec.source = before.replace("(1.0 - abs(p.yx))", "(1.015625 - abs(p.yx))");
          return codec.source !== before;
        }"""
    )
    assert altered
    laboratory.start()
    rows = {row["encoding"]: row for row in laboratory.finish()}
    wrong = rows.pop("octahedral")
    assert all(row["equal"] == row["normals"] for row in rows.values())
    # half of all directions have z < 0, and most of those lie in groups that nothing is known of
    assert wrong["further"] > 0.5 * wrong["normals"]
    assert re.search(r"x, y differ", wrong["difference"]) and re.search(
        r"normal \d+ \(.*\): here ", wrong["difference"]
    )
    (name,) = laboratory.texts("[data-results] tr.differs th")
    assert name == "octahedral rgba8"


@no_swiftshader
def test_lost_context_is_reported_and_measuring_continues(laboratory):
    laboratory.start()
    laboratory.page.wait_for_selector("[data-results] tbody tr:nth-child(2)", timeout=1000 * SECONDS)
    laboratory.ask("() => { window.loss = live.device.gl.getExtension('WEBGL_lose_context'); loss.loseContext(); }")
    laboratory.page.wait_for_selector("[data-measured]:has-text('context was lost')")
    laboratory.ask("() => loss.restoreContext()")
    rows = laboratory.finish()
    assert len(rows) == laboratory.ask("live.data.codecs.length")
    assert all(row["equal"] == row["normals"] for row in rows), [row["difference"] for row in rows]


@no_swiftshader
def test_timing_waits_until_the_page_is_visible(laboratory):
    laboratory.only("xyz")
    laboratory.page.locator("#measure-times").check()
    hidden = "Object.defineProperty(document, 'visibilityState', { value: '%s', configurable: true })"
    laboratory.ask(hidden % "hidden")
    laboratory.start()
    laboratory.page.wait_for_selector("[data-measured]:has-text('1 of 1')")
    laboratory.page.wait_for_timeout(1000)
    assert laboratory.ask("live.measuring.isBusy")
    laboratory.ask(hidden % "visible")
    laboratory.ask("() => document.dispatchEvent(new Event('visibilitychange'))")
    (row,) = laboratory.finish()
    assert row["timer"] == "EXT_disjoint_timer_query_webgl2"
    times = [row[name] for name in ("encode_ms", "decode_ms")]
    assert all(time is None or 0 < time < 10000 for time in times), times


def stepped(*changes):
    """Return the run's codes of octahedral rgba8 with (normal, number, steps) changed."""
    n, view = normals.normals("sphere")
    codes = checks.ordered(OCTAHEDRAL, checks.reference_of(OCTAHEDRAL, n, view, compiled=False))
    for normal, number, steps in changes:
        codes[normal, number] += steps
    return codes


# As text: Playwright takes seconds to pass as many numbers one by one.
COMPARE = """(text) => {
  const [codec, given, exact] = JSON.parse(text);
  const codes = given.map((one) => Int32Array.from(one));
  return live.measuring.checks.compare(codec, codes, exact && Float32Array.from(exact));
}"""


def compared(laboratory, *given, codec=OCTAHEDRAL, exact=None):
    numbers = None if exact is None else exact.ravel().tolist()
    return laboratory.ask(COMPARE, json.dumps([record_of(codec), [codes.ravel().tolist() for codes in given], numbers]))


@cache
def record_of(codec):
    """Return a page's data for a codec, with the sums of its codes."""
    return {**programs.program(codec), "checks": checks.checks(codec)}


def test_checksum_locates_differences_of_one_or_two_steps(laboratory):
    comparison = compared(laboratory, stepped((5, 1, 1), (300, 0, -1), (310, 1, 1)))
    assert (comparison["equal"], comparison["oneStep"], comparison["further"]) == (2**16 - 3, 3, 0)
    assert [entry["normal"] for entry in comparison["differing"]] == [5, 300, 310]
    # two numbers of one normal
    comparison = compared(laboratory, stepped((70, 0, 1), (70, 1, -1)))
    assert (comparison["equal"], comparison["oneStep"], comparison["further"]) == (2**16 - 1, 0, 1)
    # three in a group, or a larger step: the whole group
    for changes in (((1, 0, 1), (2, 0, 1), (3, 1, -1)), ((0, 1, 5),)):
        comparison = compared(laboratory, stepped(*changes))
        assert (comparison["equal"], comparison["oneStep"], comparison["further"]) == (2**16 - 128, 0, 128)
    assert comparison["checked"] == [1], "the number that differs is named"
    assert comparison["differing"][0]["normal"] == 0, "normal 0 travels with the page"


def test_rounding_of_a_target_is_identified_exactly(laboratory):
    """The shader's own packing gives the run's codes; then every code of the target is compared."""
    packed = stepped((9, 0, 1), (200, 1, -1), (500, 0, 1))
    target = stepped()
    generator = np.random.default_rng(0)
    down = generator.random(target.shape) < 0.5
    target[down] -= 1
    twice, once = down.all(axis=1), down.any(axis=1) & ~down.all(axis=1)
    comparison = compared(laboratory, packed, target)
    assert (comparison["oneStep"], comparison["further"]) == (once.sum(), twice.sum())
    assert [number["normals"] for number in comparison["numbers"]] == down.sum(axis=0).tolist()
    assert [number["most"] for number in comparison["numbers"]] == [1, 1]


def rounded(x, storage, whole):
    """Return numbers (float32) as a shader stores them, in the order of codes."""
    half = np.float32(0.5)
    if storage == "rg16f":
        words = x.astype(np.float16).view(np.int16).astype(np.int32)
        return np.where(words < 0, -(words & 0x7FFF), words)
    if storage == "rg16_snorm":
        return whole(x * np.float32(32767)).astype(np.int32)
    return whole((x * half + half) * np.float32(65535 if storage == "rg16" else 4095)).astype(np.int32)


# Fixed point, signed and cut off, and halves.
FINE = [("rg16", "nearest"), ("rg16_snorm", "truncate"), ("rg16f", "nearest")]


@pytest.mark.parametrize(("storage", "rounding"), FINE)
def test_codes_of_a_gpu_with_inexact_arithmetic_are_recovered_near_ties(laboratory, storage, rounding):
    """Numbers off by up to 3 units in the last place are rounded the other way near ties, several of them in a group.

    A group is skipped if many of its normals are next to one tie: neighbours of diagonals and, with truncation, also
    of axes.
    """
    codec, generator = Codec(ENCODINGS["octahedral"], STORAGES[storage], rounding), np.random.default_rng(1)
    n, view = normals.normals("sphere")
    run = checks.ordered(codec, checks.reference_of(codec, n, view, compiled=False))
    x = np.stack([np.asarray(plane) for plane in encode(*(Vec3(*part.T) for part in (n, view)))], axis=1)
    x = (x * (1 + generator.integers(-3, 4, x.shape) * 2.0**-23)).astype(np.float32)
    here = rounded(x, storage, np.rint if rounding == "nearest" else np.trunc)
    differing = (here != run).any(axis=1)
    assert 10 < differing.sum() < 2000
    comparison = compared(laboratory, here, codec=codec, exact=np.pad(x, ((0, 0), (0, 2))))
    assert comparison["untold"] <= (2 if rounding == "nearest" else 6) * 128, comparison["numbers"]
    known = 2**16 - comparison["untold"]
    assert known - differing.sum() <= comparison["equal"] <= 2**16 - differing.sum()
    assert all(number["most"] <= 1 for number in comparison["numbers"])


@pytest.mark.parametrize("theme", ["dark"])
def test_measurements_are_accessible(gl_browser, report, theme):
    """The table and the facts meet WCAG 2.1 A and AA."""
    from axe_playwright_python.base import AXE_FILE_PATH

    opened = Measured(gl_browser, report, theme=theme, size=PHONE)
    opened.only("octahedral", "xyz")
    opened.start()
    opened.finish()
    opened.ask(AXE_FILE_PATH.read_text() + "; 0")
    violations = opened.ask(AXE)
    opened.context.close()
    assert violations == []
