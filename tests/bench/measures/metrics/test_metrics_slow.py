"""The statistics of a row, compared with NumPy in float64 and with mathematical laws."""

import os
import subprocess
import sys

import jax
import numpy as np
import pytest
from directions import random_directions
from hypothesis import given, settings
from hypothesis import strategies as st
from speed.numpy_baseline import whole_row
from test_metrics import DECODED, measured, rows_of, turned

from normalbench.bench.ground.machine.cores import cores
from normalbench.bench.measures.metrics import meter as metrics
from normalbench.bench.measures.metrics.meter import Meter
from normalbench.bench.subjects.normals.normal_sets import CHUNK, from_arrays, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 3 * CHUNK // 2), st.floats(0.01, 60))
def test_a_row_matches_numpy(count, degrees):
    """Sums and the largest angle match to float32's precision, the percentile to 0.1%, for any count."""
    count = min(count, 40_000) if count % 2 else count
    n = random_directions(count, seed=count)
    spread = np.random.default_rng(count).uniform(0.1, 1, count) * degrees
    other = turned(n, spread, seed=count + 1).astype(np.float32)
    got = measured(DECODED, from_arrays("", "", n, other, np.ones(count, bool)))
    mse, article_mse, mean, rms, p99, largest = whole_row(n, other)
    assert got.count == got.pixels == count
    assert got.mse == pytest.approx(mse, rel=1e-6)
    assert got.article_mse == pytest.approx(article_mse, rel=1e-5, abs=1e-12)
    assert got.angle_mean_deg == pytest.approx(mean, rel=1e-6)
    assert got.angle_rms_deg == pytest.approx(rms, rel=1e-6)
    assert got.angle_max_deg == pytest.approx(largest, rel=1e-6)
    if count > 10_000:
        assert got.angle_p99_deg == pytest.approx(p99, rel=1e-3)


@pytest.mark.parametrize("at", [7, CHUNK + 7])
def test_the_largest_angle_is_found_in_any_chunk(at):
    """The largest angle is in the first or the second of two chunks."""
    n = random_directions(CHUNK + 99)
    degrees = np.where(np.arange(len(n)) == at, 20.0, 1.0)
    got = measured(DECODED, from_arrays("", "", n, turned(n, degrees).astype(np.float32), np.ones(len(n), bool)))
    assert got.angle_max_deg == pytest.approx(20.0, rel=1e-5)
    np.testing.assert_array_equal(got.worst.normal, n[at])


def test_codecs_measured_together_match_codecs_measured_alone():
    """Each chunk is made once for all codecs; their order and number do not change the results."""
    normals = sphere(3 * CHUNK + 5)
    alone = [
        quality.measure(case)
        for case in quality.cases(
            [Codec(ENCODINGS[name], STORAGES["rgba8"]) for name in ("octahedral", "spherical", "xyz")],
            [normals],
            ["jax"],
        )
    ]
    assert rows_of(normals) == alone
    assert list(reversed(rows_of(normals, ("xyz", "spherical", "octahedral")))) == alone


def test_any_count_uses_constant_memory():
    """Chunks are released as soon as they are measured."""
    import gc
    import weakref

    class Load:
        def __init__(self, chunk):
            self.chunk = chunk

        def __call__(self):
            return self.chunk

    chunk, seen, most = sphere(CHUNK).chunk(0), [], 0
    # What other tests have left need not be looked through.
    gc.collect()
    gc.freeze()

    def loads():
        nonlocal most
        for _ in range(40):
            load = Load(chunk)
            seen.append(weakref.ref(load))
            gc.collect()
            most = max(most, sum(ref() is not None for ref in seen))
            yield load
            del load

    Meter(jax.jit(lambda block: block.n)).measure(loads(), CHUNK)
    gc.unfreeze()
    # Two for each thread, and those that one hands on.
    assert most <= 2 * cores() + 4


def test_rows_do_not_depend_on_how_the_work_is_divided(monkeypatch):
    """Threads and block sizes do not change a bit; another number of lanes changes only the last digits of sums."""
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


def test_distributing_chunks_over_devices_does_not_change_the_rows():
    """With one or three JAX devices, each measures some of the chunks, and the statistics match to the last digit."""
    by_count = {}
    for count in (1, 3):
        flags = {"XLA_FLAGS": f"--xla_force_host_platform_device_count={count}"}
        done = subprocess.run(
            [sys.executable, "-c", ON_DEVICES], env=os.environ | flags, capture_output=True, text=True, check=True
        )
        *statistics, devices = done.stdout.splitlines()
        assert devices == f"{count} {count}", done.stderr
        by_count[count] = statistics
    assert by_count[1] == by_count[3]
