"""The measured tables of the manual: pages match the stored figures exactly; a nightly run measures them again."""

import math
import re

import pytest
from manual import PAGES, README, ROOT
from manual_tables.table import KEPT, page_with
from manual_tables.tables import TABLES

from normalbench.bench.measures.metrics import published
from normalbench.bench.measures.metrics.code_limits import HEMISPHERE, SPHERE, code_limit

VENDORS = PAGES[ROOT / "docs" / "vendors.md"]


MARKER = re.compile(
    r"^<!-- (headline|answer: [\w ]+|workers simulated|published figures|normalbench [\w ]+) -->$", re.M
)


def kept_figures(marker: str, column: str) -> dict[tuple, object]:
    """Return the stored figures in all columns of this name, by encoding and operation."""
    table = TABLES[marker]
    columns = [nth for nth, each in enumerate(table.columns) if each.name == column]
    return {(line[0], *table.columns[nth].of.values()): line[nth] for line in table.read().lines for nth in columns}


def test_every_marker_has_a_table_and_every_table_a_marker():
    assert sorted(MARKER.findall("\n".join(PAGES.values()))) == sorted(TABLES)
    assert {table.path for table in TABLES.values()} == set(KEPT.iterdir())


@pytest.mark.parametrize("marker", TABLES)
def test_a_page_shows_the_stored_table(marker):
    """The text matches exactly, and the conclusions on the page hold for the table."""
    table = TABLES[marker]
    kept = table.read()
    _, text, _ = table.parts(page_with(marker)[1])
    assert text == table.text(table, kept)
    table.holds(kept.lines)


def test_the_bounds_in_the_manual_match_the_computed_bounds():
    by_domain = {"sphere": code_limit(2**16, SPHERE), "hemisphere": code_limit(2**16, HEMISPHERE)}
    limits = [line for line in TABLES["normalbench quality"].read().lines if line[0] == "limit"]
    assert [line[1] for line in limits] == list(by_domain)
    for _, domain, *figures in limits:
        least = by_domain[domain]
        assert figures[:4] == pytest.approx([least.mean_deg, least.rms_deg, least.max_deg, 16.0], rel=5e-4)
    least = by_domain["sphere"]
    assert f"{least.mean_deg:.3f}°" in PAGES[README] and f"{least.max_deg:.3f}°" in PAGES[README]


def test_the_text_has_the_lowest_roughness_at_which_reflections_are_acceptable():
    lowest = {line[0]: line[2] for line in TABLES["normalbench roughness"].read().lines}
    text = f"{lowest['rg8']:.2f} in 8:8, {lowest['rgb10a2']:.2f} in 10:10 and {lowest['rgb8_12_12']:.2f} in 12:12:"
    assert f"acceptable from roughness {text}" in " ".join(PAGES[README].split()), text


def test_the_text_names_the_compilers_that_counted_the_instructions():
    assert {*re.findall(r"Mesa [\d.]+\d", PAGES[README])} == {*TABLES["headline"].read().drivers}
    (named,) = re.findall(r"^Counted by (NVRTC [\d.]+) and (Mesa [\d.]+)\.", VENDORS, re.M)
    assert {*named} == {*TABLES["normalbench cost nvidia"].read().drivers}


def test_the_headline_table_is_measured_with_the_commands_on_the_page():
    """The commands are for `rg8`; one command counts the costs of both storages."""
    page = PAGES[ROOT / "docs/reading-a-row.md"]
    shown = set(re.findall(r"^    normalbench (.* --encoding optimised_rings.*)$", page, re.M))
    measured = {row.partition(",warped_cube")[0] for row in TABLES["headline"].rows if "--storage rgb10a2" not in row}
    assert shown == measured


def test_figures_from_the_article_match_the_published_figures():
    for (name, *_), psnr in kept_figures("normalbench run", "article_db").items():
        assert psnr == published.PSNR_DB.get(name)
    for (name, operation, *by), count in kept_figures("normalbench cost", "instructions").items():
        slots = published.SLOTS.get((name, operation))
        assert by != [published.SLOTS_BY] or count == (slots and sum(slots)), (name, operation)


def test_every_published_figure_has_a_verdict():
    lines = TABLES["published figures"].read().lines
    assert {verdict for *_, verdict, _, _ in lines} == {"reproduced", "holds", "short by sampling", "different"}
    assert all(why and command for *_, verdict, why, command in lines if verdict == "different")
    assert all(math.isfinite(ours) for _, _, _, ours, *_ in lines)
