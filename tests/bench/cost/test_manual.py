"""The instructions in docs/cost.md and docs/vendors.md are what the compilers of those versions make."""

import json
import os
import re
from itertools import product

import pytest
from manual import PAGES, ROOT, table

from normalbench.bench.metrics import published
from normalbench.bench.options.gpu_families import CHOICES, FAMILIES

VENDORS = PAGES[ROOT / "docs" / "vendors.md"]


def test_the_cost_table_is_what_is_measured(run):
    shown = table("normalbench cost")
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", shown)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d*)" * 6 + r" \|$", shown, re.M)
    assert len(lines) == 8
    names = ",".join(line[0] for line in lines)
    words = ["--isa", "--family", "polaris10,navi31", "--stage", "fragment", "--article", "--format", "json"]
    status, out, err = run("cost", "--encoding", names, *words)
    if status == 3 and not os.environ.get("CI"):
        pytest.skip(err)
    rows = json.loads(out)
    if {row["driver"] for row in rows if row["family"]} != {mesa}:
        pytest.skip(f"this machine's compiler is not {mesa}")
    found = {(row["encoding"], row["operation"], row["family"] or row["compiler"]): row["instructions"] for row in rows}
    found |= {key[:2]: found[key] for key in found if key[2] == published.SLOTS_BY and found[key] is not None}
    for name, *figures in lines:
        for operation, (article, polaris, navi) in zip(("encode", "decode"), (figures[:3], figures[3:]), strict=True):
            key = (name, operation)
            assert (int(article) if article else None) == found.get(key), key
            assert [int(polaris), int(navi)] == [found[*key, "polaris10"], found[*key, "navi31"]], key


@pytest.mark.usefixtures("intel")
def test_the_cost_table_of_two_vendors_is_what_is_measured(run):
    """And the orders below it."""
    shown = table("normalbench cost vendors")
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", shown)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d+)" * 6 + r" \|$", shown, re.M)
    assert len(lines) == 8
    families = ("navi31", "skl", "dg2")
    words = ["--isa", "--family", ",".join(families), "--stage", "fragment", "--storage", "rgba8", "--format", "json"]
    status, out, _ = run("cost", "--encoding", ",".join(line[0] for line in lines), *words)
    rows = json.loads(out)
    assert status == 0
    if {row["driver"] for row in rows} != {mesa}:
        pytest.skip(f"this machine's compiler is not {mesa}")
    found = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in rows}
    for name, *figures in lines:
        keys = [(name, operation, family) for operation in ("encode", "decode") for family in families]
        assert [int(figure) for figure in figures] == [found[key] for key in keys], name
    orders = re.findall(r"^\| (encode|decode) \| (.+) \| (.+) \| (.+) \|$", VENDORS, re.M)
    assert len(orders) == 4
    for operation, *columns in orders:
        for family, names in zip(families, columns, strict=True):
            counts = [found[name, operation, family] for name in names.split(", ")]
            assert counts == sorted(counts), (operation, family, names)


@pytest.mark.usefixtures("intel")
def test_the_cost_table_of_half_arithmetic_is_what_is_measured(run):
    """And the loop above it."""
    shown = table("normalbench cost half")
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", shown)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d+)" * 8 + r" \|$", shown, re.M)
    names = [line[0] for line in lines]
    words = ["--isa", "--family", "navi21,skl", "--stage", "fragment", "--storage", "rgba8", "--format", "json"]
    status, out, _ = run("cost", "--arithmetic", "all", "--encoding", ",".join([*names, "best_fit_searched"]), *words)
    rows = {(row["encoding"], row["operation"], row["family"]): row for row in json.loads(out)}
    assert status == 0 and len(lines) == 3
    if {row["driver"] for row in rows.values()} != {mesa}:
        pytest.skip(f"this machine's compiler is not {mesa}")
    for name, *figures in lines:
        keys = product((name,), ("encode", "decode"), ("navi21", "skl"), ("", ":arithmetic=half"))
        assert [int(figure) for figure in figures] == [rows[n + half, o, f]["instructions"] for n, o, f, half in keys]
    loop = rows["best_fit_searched", "encode", "navi21"]
    assert (loop["instructions"], loop["looped"], loop["loops"]) == (57, 38, 1)


@pytest.mark.usefixtures("intel", "nvidia")
def test_the_cost_table_with_nvidia_is_what_is_measured(run):
    """And the orders below it, by the first GPU of each column."""
    shown = table("normalbench cost nvidia")
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d+)" * 10 + r" \|$", shown, re.M)
    assert len(lines) == 8
    families = ("navi31", "dg2", "sm_75", "sm_86", "sm_120")
    words = ["--isa", "--family", ",".join(families), "--stage", "compute", "--storage", "rgba8", "--format", "json"]
    status, out, _ = run("cost", "--encoding", ",".join(line[0] for line in lines), *words)
    rows = json.loads(out)
    assert status == 0
    (said,) = re.findall(r"^These are of (NVRTC [\d.]+) and (Mesa [\d.]+)\.", VENDORS, re.M)
    if {row["driver"].partition(" (")[0] for row in rows} != {*said}:
        pytest.skip(f"this machine's compilers are not {' and '.join(said)}")
    found = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in rows}
    for name, *figures in lines:
        keys = [(name, operation, family) for operation in ("encode", "decode") for family in families]
        assert [int(figure) for figure in figures] == [found[key] for key in keys], name
    orders = re.findall(r"^\| to (encode|decode) \| (.+) \| (.+) \| (.+) \|$", VENDORS, re.M)
    assert len(orders) == 4
    for operation, *columns in orders:
        for family, names in zip(families, columns, strict=False):
            counts = [[found[name, operation, family] for name in some.split(" and ")] for some in names.split(", ")]
            assert counts == sorted(counts), (operation, family, names)
            assert all(len(set(same)) == 1 for same in counts), (operation, family, names)


@pytest.mark.usefixtures("terascale")
def test_the_cost_table_of_the_articles_radeons_is_what_is_measured(run):
    """And the article's cycles next to it."""
    shown = table("normalbench cost terascale")
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", shown)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +([\d.]*)" * 8 + r" \|$", shown, re.M)
    assert len(lines) == 8
    words = ["--isa", "--family", "terascale", "--stage", "fragment", "--storage", "rgba8", "--article"]
    status, out, _ = run("cost", "--encoding", ",".join(line[0] for line in lines), *words, "--format", "json")
    rows = json.loads(out)
    assert status == 0
    cycles = {(row["encoding"], row["operation"], row["device"]): row["cycles"] for row in rows}
    counts = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in rows}
    is_that_mesa = {row["driver"] for row in rows if row["family"]} == {mesa}
    chips = [(family, FAMILIES[family].title) for family in CHOICES["terascale"]]
    columns = [(operation, *chip) for operation in ("encode", "decode") for chip in chips]
    for name, *figures in lines:
        for (operation, family, title), count, cycle in zip(columns, figures[::2], figures[1::2], strict=True):
            assert not is_that_mesa or int(count) == counts[name, operation, family], (name, operation, family)
            assert (float(cycle) if cycle else None) == cycles.get((name, operation, title)), (name, operation, title)


def test_the_cost_table_of_phones_is_what_is_measured(run):
    shown = table("normalbench cost mobile")
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", shown)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d+)" * 6 + r" \|$", shown, re.M)
    assert len(lines) == 6
    words = ["--isa", "--family", "a630,v3d42", "--stage", "fragment", "--storage", "rgba8", "--format", "json"]
    status, out, err = run("cost", "--encoding", ",".join(line[0] for line in lines), *words)
    rows = json.loads(out)
    if status == 3 or {row["driver"] for row in rows} != {mesa}:
        pytest.skip(err or f"this machine's compiler is not {mesa}")
    found = {(row["encoding"], row["operation"], row["family"]): row for row in rows}
    for name, *figures in lines:
        for operation, shown_figures in (("encode", figures[:3]), ("decode", figures[3:])):
            adreno, v3d = (found[name, operation, family] for family in ("a630", "v3d42"))
            measured = [adreno["instructions"], adreno["waiting"], v3d["instructions"]]
            assert [int(figure) for figure in shown_figures] == measured, (name, operation)
