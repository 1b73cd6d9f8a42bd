"""The statistics of a row, against NumPy in float64 and against the laws they obey."""

import os
import subprocess
import sys

import jax
import pytest
from test_metrics import rows_of

from normalbench.bench.measures.metrics import meter as metrics
from normalbench.bench.subjects.normals.normal_sets import CHUNK, sphere


def test_rows_do_not_depend_on_how_the_work_is_cut_up(monkeypatch):
    """One core or four, and blocks of any size: the same bits. Other lanes: the last digits of the sums alone."""
    normals = sphere(5 * CHUNK + 99)
    usual = rows_of(normals)
    for threads in (1, 4):
        monkeypatch.setattr("normalbench.bench.ground.machine.cores.cores", lambda threads=threads: threads)
        assert rows_of(normals) == usual
    for rows, lanes in ((8, 1024), (32, 1024), (64, 256), (32, 512)):
        monkeypatch.setattr(metrics, "ROWS", rows)
        monkeypatch.setattr(metrics, "SUM_LANES", lanes)
        monkeypatch.setattr(metrics, "_scan", jax.jit(lambda chunk: metrics._traced_scan(chunk)))
        for row, other in zip(usual, rows_of(normals), strict=True):
            for name in ("mse", "psnr_db", "psnr_article_db", "angle_mean_deg", "angle_rms_deg"):
                assert other[name] == pytest.approx(row[name], rel=0 if lanes == 1024 else 1e-13, abs=0), (name, rows)
            same = ("angle_max_deg", "angle_p99_deg", "angle_counts", "worst_normal", "invalid")
            assert [other[name] for name in same] == [row[name] for name in same], rows


ON_DEVICES = """
import jax
from normalbench.bench.measures.metrics.meter import Meter
from normalbench.bench.subjects.normals.normal_sets import CHUNK, sphere

used = set()

class Seen(Meter):
    def decoded(self, block):
        used.update(block.n.x.devices())
        return super().decoded(block)

print(Seen(jax.jit(lambda block: block.n * 0.999 + 0.001)).measure(sphere(4 * CHUNK + 9).loads(), 4 * CHUNK + 9))
print(len(used), len(jax.local_devices()))
"""


def test_chunks_are_dealt_to_all_devices_and_rows_are_the_same():
    """One device of JAX or three: each measures some of the chunks, and no digit of the statistics differs."""
    found = {}
    for count in (1, 3):
        flags = {"XLA_FLAGS": f"--xla_force_host_platform_device_count={count}"}
        done = subprocess.run(
            [sys.executable, "-c", ON_DEVICES], env=os.environ | flags, capture_output=True, text=True, check=True
        )
        *statistics, devices = done.stdout.splitlines()
        assert devices == f"{count} {count}", done.stderr
        found[count] = statistics
    assert found[1] == found[3]
