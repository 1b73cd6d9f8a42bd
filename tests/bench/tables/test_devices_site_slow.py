"""`normalbench site`: its page for ten devices, all-or-nothing writing, and users' files that stay unchanged."""

import time

import devices as made
import test_devices_site
from test_devices_site import Read, files_of

from normalbench.bench.show.site_files import MARKER

site = test_devices_site.site


def test_each_device_has_a_section_and_every_link_leads_to_a_section(site):
    page = Read(site / "index.html")
    sections = {attributes["id"] for tag, attributes in page.tags if tag == "section"}
    devices = {section for section in sections if section.startswith("device-")}
    assert len(devices) == 10 and {"device-mali-g78-chromium-156", "device-apple-m2-safari-18"} <= devices
    assert {link for link in page.links if link.startswith("#device-")} == {f"#{section}" for section in devices}
    ids = [attributes["id"] for _, attributes in page.tags if "id" in attributes]
    assert len(ids) == len(set(ids)) and files_of(site).keys() == {"index.html", MARKER}


MOST_SECONDS = 10


def test_ten_devices_take_less_than_ten_seconds(run, tmp_path, monkeypatch):
    """The cache is empty, so that instructions are counted again. The best of up to three runs counts, because the
    machine may be busy."""
    made.write_ten(tmp_path / "files")
    times: list[float] = []
    while not times or (times[-1] >= MOST_SECONDS and len(times) < 3):
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / f"cache-{len(times)}"))
        begun = time.perf_counter()
        status, out, err = run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))
        times.append(time.perf_counter() - begun)
        assert (status, err) == (0, "") and out == f"{tmp_path}/site/index.html: 10 devices\n"
    assert min(times) < MOST_SECONDS, f"{times} s"
