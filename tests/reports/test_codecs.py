"""The view Codecs: a list of all, and everything about one codec in a card, as the run's rows have it."""

import json

import pytest
from languages import SHORT
from test_pictures import pick_row
from test_report import a_run, quality_row

from normalbench.bench.door import run_code
from normalbench.bench.keep.runs import read_run
from normalbench.bench.show.kept_code import FILE, read_code
from normalbench.encodings.storages.rules import rule_of_first
from normalbench.encodings.storages.storage import STORAGES

QUALITY = [
    quality_row("octahedral", psnr_db=49.85, angle_mean_deg=0.29, angle_max_deg=0.92),
    quality_row("octahedral", psnr_db=1.0, backend="glsl"),
    quality_row("spheremap", psnr_db=48.73, angle_mean_deg=0.33, angle_max_deg=1.31),
    quality_row("stereographic", psnr_db=45.5, angle_mean_deg=0.41, angle_max_deg=0.95),
    quality_row("mine", psnr_db=50.5, angle_mean_deg=0.27, angle_max_deg=0.9),
    quality_row("octahedral", storage="rgb10a2", bits=20, psnr_db=61.57, angle_mean_deg=0.0756, angle_max_deg=0.237),
    quality_row("spheremap", storage="rgb10a2", bits=20, psnr_db=60.64, angle_mean_deg=0.0862, angle_max_deg=0.348),
]


CODES = (("octahedral", 0.3355, 30), ("spheremap", 0.4918, 17), ("xy", 0.9, 9))


ANSWER = [pick_row(*code) | {"rounding": "nearest"} for code in CODES]


@pytest.fixture(scope="module")
def codecs_page(tmp_path_factory):
    from normalbench.bench.show.report import write_report

    folder = a_run(tmp_path_factory.mktemp("codecs") / "run", {"pick": ANSWER, "quality": QUALITY})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run_code, "LANGUAGES", SHORT)
        run_code.keep_code(folder, read_run(folder))
    return write_report(folder, read_run(folder), folder / "report.html")


@pytest.mark.parametrize(
    ("one", "other", "count", "same"),
    [
        ("rg8", "rgba8", 2, True),
        ("rg8", "rgb10a2", 2, False),
        ("rg8", "rg8_snorm", 2, False),
        ("rgba16", "rg16", 2, True),
        ("rgba16f", "rg16f", 2, True),
        ("rgb10a2", "rgb8_10_10_2", 2, False),
    ],
)
def test_storages_of_the_same_first_numbers(one, other, count, same):
    """Numbers that lie across channels are not filtered as others are."""
    assert (rule_of_first(STORAGES[one], count) == rule_of_first(STORAGES[other], count)) is same


@pytest.mark.parametrize("damage", ["{", '{"languages": {}, "pieces": [], "codecs": 1}', "one place too far"])
def test_kept_code_that_is_damaged_is_left_out(codecs_page, tmp_path, damage):
    kept = json.loads((codecs_page.parent / FILE).read_text())
    assert read_code(codecs_page.parent)["codecs"]["octahedral rg8"]["proven"]
    if damage.startswith("one"):
        kept["pieces"].pop()
        damage = json.dumps(kept)
    (tmp_path / FILE).write_text(damage)
    assert read_code(tmp_path) == {}
