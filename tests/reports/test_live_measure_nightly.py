"""Measuring in the page with a browser's own renderer: codes of the run, faults, interruptions and saved devices."""

import subprocess
import sys

import pytest
import test_live_measure_slow
from browsing import no_swiftshader
from test_live_measure_slow import LEAST_SHARE, Measured

open_laboratory = test_live_measure_slow.open_laboratory
laboratory = test_live_measure_slow.laboratory


def test_every_encoding_gives_the_runs_codes_in_every_format(gl_browser, tmp_path):
    """At 8 and 10 bits at least 99.9% of the codes are equal, and none is off by more than a step. With SwiftShader,
    which rounds every sum and root as in IEEE 754, all codes are equal."""
    command = (sys.executable, "-m", "normalbench", "run", "--tables", "quality", "--encoding", "all")
    sets = (
        "--storage",
        "rgba8,rgb10a2,rg8,rg16f,rgba16f",
        "--count",
        "4096",
        "--normals",
        "sphere",
        "-o",
        str(tmp_path / "run"),
    )
    done = subprocess.run([*command, *sets], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    opened = Measured(gl_browser, tmp_path / "run/report.html")
    opened.start()
    rows = opened.finish()
    opened.context.close()
    assert len(rows) >= 100
    for row in rows:
        is_fine = "f" in row["storage"]
        least = 0.99 if is_fine else LEAST_SHARE
        assert row["equal"] >= least * row["normals"] and not row["further"], (row["encoding"], row["difference"])


WITHOUT_FLOATS = """{
  const own = WebGL2RenderingContext.prototype.getExtension;
  WebGL2RenderingContext.prototype.getExtension = function (name) {
    return name.includes("color_buffer") ? null : own.call(this, name);
  };
}"""


@no_swiftshader
def test_device_without_float_render_targets_is_measured(gl_browser, report):
    """Angles are returned as bits of integers, which every device can render to."""
    opened = Measured(gl_browser, report, before=WITHOUT_FLOATS)
    opened.only("octahedral")
    opened.start()
    (row,) = opened.finish()
    facts = opened.ask("live.measuring.facts")
    opened.context.close()
    assert row["equal"] == row["normals"] and row["mean_deg"] == pytest.approx(row["run_mean_deg"], abs=1e-9)
    assert facts["renders RGBA16F"] == facts["renders RGBA32F"] == "no" and facts["renders RGBA8"] == "yes"
    assert facts["subnormal halves"] == "RGBA16F cannot be rendered to"


CANCEL_AT_TWO = """() => new MutationObserver((_, observer) => {
  if (!document.querySelector("[data-results] tbody tr:nth-child(2)")) return;
  observer.disconnect();
  document.querySelector("[data-cancel]").click();
}).observe(document.body, { childList: true, subtree: true })"""


def test_cancelled_measurement_keeps_its_results(laboratory):
    laboratory.start()
    # By the page itself: the others may be measured before a click from outside arrives.
    laboratory.page.evaluate(CANCEL_AT_TWO)
    rows = laboratory.finish()
    assert 2 <= len(rows) < laboratory.ask("live.data.codecs.length")
    assert laboratory.status == f"Cancelled. {len(rows)} codecs measured earlier are kept."
    assert laboratory.page.locator("[data-save]").is_visible()


def test_times_are_measured_without_timer_queries(laboratory):
    laboratory.only("octahedral")
    laboratory.page.locator("#measure-times").check()
    laboratory.ask(
        """() => {
          const { gl } = live.device, own = gl.getExtension.bind(gl);
          gl.getExtension = (name) => (name.startsWith("EXT_disjoint") ? null : own(name));
        }"""
    )
    laboratory.start()
    (row,) = laboratory.finish()
    assert row["timer"].startswith("wall clock") and (row["encode_ms"] is None or row["encode_ms"] > 0), (
        laboratory.status
    )


def test_normals_that_differ_from_the_run_are_not_measured(laboratory):
    laboratory.ask("() => { live.data.checks.sums.sphere[0] ^= 1; }")
    laboratory.start()
    assert not laboratory.finish()
    assert laboratory.status == "Not finished: this browser generates different sphere normals from the run's."


@pytest.mark.parametrize(("storage", "rounding"), [("rg16_snorm", "nearest"), ("rgb8_12_12", "nearest")])
def test_more_codes_of_a_gpu_with_inexact_arithmetic_are_recovered_near_ties(laboratory, storage, rounding):
    test_live_measure_slow.test_codes_of_a_gpu_with_inexact_arithmetic_are_recovered_near_ties(
        laboratory, storage, rounding
    )


def test_measurements_are_accessible_in_the_light_theme(gl_browser, report):
    test_live_measure_slow.test_measurements_are_accessible(gl_browser, report, "light")
