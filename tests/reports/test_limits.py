"""How large a page grows: its elements after each view was opened once, scrolled to its end and left."""

import base64
import json
import zlib

import pytest
from browsing import Opened
from test_report import Read, a_run, quality_row
from test_site import LAID_OUT

from normalbench.bench.show.report import report_command
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports.page import data


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A run of every encoding in every storage, by hand."""
    names = [{"encoding": name, "storage": storage} for name in ENCODINGS for storage in STORAGES]
    rows = [quality_row(psnr_db=40.0 + at / 7, **one) for at, one in enumerate(names)]
    images = [TABLES["render"].empty() | LAID_OUT | one | {"psnr_db": 20.0 + at / 7} for at, one in enumerate(names)]
    return a_run(tmp_path_factory.mktemp("large") / "run", {"quality": rows, "render": images})


@pytest.fixture(scope="module")
def large(browser, folder):
    report_command(folder, as_markdown=False, pictures_beside=False, charts_beside=False, output=None)
    page = Opened(browser, folder / "report.html", size=(1440, 900))
    yield page
    page.context.close()


def test_a_table_of_very_many_rows_keeps_five_digits():
    """All of them made 3.4 of the 6.5 MB of a page of everything."""
    for count, kept in ((data.MANY_ROWS, 1.2345678901234567), (data.MANY_ROWS + 1, 1.2346)):
        text = data.block([{"x": 1.2345678901234567, "n": 2**40 + 1}] * count, ())
        found = json.loads(zlib.decompress(base64.b64decode(text), -zlib.MAX_WBITS))
        numbers, whole = found["columns"]
        assert set(numbers["values"]) == {kept} and set(whole["values"]) == {2**40 + 1}, count
        assert found.get("digits") == (None if count == data.MANY_ROWS else data.DIGITS)


def test_a_site_has_long_tables_as_text(folder, run, tmp_path):
    """Without scripts there is nothing that builds them."""
    assert run("site", str(folder), "-o", str(tmp_path / "site"))[0] == 0
    read = Read((tmp_path / "site/layouts.html").read_text(encoding="utf-8"))
    assert len(read.all("tr")) > len(ENCODINGS) * len(STORAGES)
    assert not [one for one in read.all("details") if "data-table" in one]
