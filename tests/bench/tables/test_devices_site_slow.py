"""`normalbench site`: what it makes of ten devices, that it writes all or nothing, and that it leaves others' files."""

import time

import devices as made
import test_devices_site

site = test_devices_site.site


MOST_SECONDS = 10


def test_ten_devices_take_less_than_ten_seconds(run, tmp_path, monkeypatch):
    """With nothing in the cache, so that instructions are counted anew. The best of three, on a machine that may do
    other things."""
    made.write_ten(tmp_path / "files")
    times: list[float] = []
    while not times or (times[-1] >= MOST_SECONDS and len(times) < 3):
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / f"cache-{len(times)}"))
        begun = time.perf_counter()
        status, out, err = run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))
        times.append(time.perf_counter() - begun)
        assert (status, err) == (0, "") and out == f"{tmp_path}/site/index.html: 10 devices\n"
    assert min(times) < MOST_SECONDS, f"{times} s"
