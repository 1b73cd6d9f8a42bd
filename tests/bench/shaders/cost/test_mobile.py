"""Instructions on GPUs of phones and small boards: what listings hold, the device that is not there, and the build."""

import json
import subprocess
from pathlib import Path

import pytest
from null_devices import NO_DEVICE, tried

from normalbench.bench.ground.options.gpu_families import CHOICES, FAMILIES, MOBILE, TURNIP
from normalbench.bench.ground.output.errors import MissingError, UsageError
from normalbench.bench.keep.machine import require_mobile
from normalbench.bench.shaders.isa import driver_files, isa
from normalbench.bench.shaders.isa.mobile import build, driver, ir3_disassembly, qpu_disassembly
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines.kernels import STAGES
from normalbench.gbuffer.defines.packings import PACKINGS

LISTINGS = Path(__file__).with_name("mobile_listings")
# By hand, line by line, of listings that Mesa 22.3.6 wrote.
COUNTED = {
    "a630-spheremap-encode": {"other_alu": 13, "transcendental": 1, "control_flow": 1, "waiting": 10},
    "a630-spheremap-decode": {"other_alu": 14, "transcendental": 1, "control_flow": 1, "waiting": 14},
    "a650-octahedral-encode": {"other_alu": 21, "transcendental": 1, "control_flow": 1, "waiting": 16},
    "v3d42-spheremap-encode": {"other_alu": 14, "transcendental": 1, "memory": 8},
    "v3d42-spheremap-decode": {"other_alu": 16, "transcendental": 2, "memory": 9},
}
OPERATIONS = {"v3d42-spheremap-encode": 31, "v3d42-spheremap-decode": 32}
EVERY = ["cost", "--isa", "--format", "json", "--encoding", "spheremap", "--storage", "rgba8", "--stage", "fragment"]


@pytest.fixture(autouse=True)
def nothing_remembered():
    """Which drivers there are is asked anew before each test and after it."""
    driver_files.driver_file.cache_clear()
    yield
    driver_files.driver_file.cache_clear()


@pytest.mark.parametrize("name", COUNTED)
def test_the_kinds_of_a_recorded_listing_are_those_counted_by_hand(name):
    read = cost.READERS[FAMILIES[name.split("-")[0]].vendor]
    counts = dict.fromkeys(read.KINDS, 0) | COUNTED[name]
    assembly = (LISTINGS / f"{name}.asm").read_text()
    assert read.kinds(assembly, sum(counts.values())) == counts
    assert read.kinds(assembly, sum(counts.values()) + 1) is None
    assert read.jumps(assembly) == (0, 0)


@pytest.mark.parametrize("name", OPERATIONS)
def test_the_operations_of_a_recorded_listing_are_those_counted_by_hand(name):
    assert qpu_disassembly.slots((LISTINGS / f"{name}.asm").read_text()) == {"vliw_slots": OPERATIONS[name]}


def test_every_recorded_listing_is_counted():
    assert {path.stem for path in LISTINGS.iterdir()} == set(COUNTED)


@pytest.mark.parametrize(
    "line, kind, total",
    [
        ("(sy)(ss)cov.u32f32 r0.x, r1.x", "conversion", 1),
        ("(rpt2)mov.f32f32 r0.x, (r)r1.x", "other_alu", 3),
        ("sam (f32)(xy)r0.x, r0.x, s#0, t#0", "memory", 1),
        ("stib.b.untyped.1d.u32.1.imm r0.x, r1.x, 0", "memory", 1),
        ("hrsq hr0.x, hr0.y", "transcendental", 1),
        ("br !p0.x, #l9", "control_flow", 1),
        ("(rpt5)nop", "waiting", 6),
    ],
)
def test_a_line_of_ir3_has_its_kind(line, kind, total):
    counts = ir3_disassembly.kinds(line, total)
    assert counts and counts[kind] == total, counts


@pytest.mark.parametrize(
    "line, kind",
    [
        ("nop                           ; nop                         ; thrsw", "waiting"),
        ("nop                           ; nop                         ; ldvary.r0", "memory"),
        ("ftoin r0, r1                  ; fmul r1, r2, r3", "conversion"),
        ("recip rf9, rf8                ; nop                         ; thrsw", "transcendental"),
        ("mov tmua, r0                  ; nop", "memory"),
        ("b.anya  -80", "control_flow"),
    ],
)
def test_a_line_of_v3d_has_its_kind(line, kind):
    counts = qpu_disassembly.kinds(line, 1)
    assert counts and counts[kind] == 1, counts


def test_jumps_ahead_and_back_are_told_apart():
    ahead, back = "br p0.x, #l2\nadd.f r0.x, r0.x, r0.y\nl2:\nend\n", "l1:\nadd.f r0.x, r0.x, r0.y\nbr p0.x, #l1\nend\n"
    assert (ir3_disassembly.jumps(ahead), ir3_disassembly.jumps(back)) == ((1, 0), (0, 1))
    assert qpu_disassembly.jumps("b.anya  64\nb  -80\n") == (1, 1)


def test_a_listing_that_is_not_understood_has_no_kinds():
    assert ir3_disassembly.kinds("frobnicate r0.x, r0.y", 1) is None
    assert qpu_disassembly.kinds("frobnicate r0, r1 ; nop", 1) is None


def test_mobile_stands_for_both_vendors():
    assert CHOICES["mobile"] == CHOICES["qualcomm"] + CHOICES["broadcom"] == ("a630", "a650", "a660", "v3d42")
    assert FAMILIES["a660"].null_device == "msm 660 0x060600ff"


@pytest.mark.usefixtures("radv", "own_cache")
def test_without_a_build_the_rows_say_how_to_build(run, monkeypatch):
    monkeypatch.delenv(driver.VARIABLE, raising=False)
    monkeypatch.setattr(driver_files, "_descriptions", lambda: iter(()))
    status, out, err = run(*EVERY, "--family", "mobile")
    assert status == 3 and "normalbench doctor --build-mesa DIR" in err
    assert {row["skipped"] for row in json.loads(out) if row["skipped"]} == set(map(driver_files.no_driver, MOBILE))
    with pytest.raises(MissingError, match=r"no Qualcomm turnip: .*; no Broadcom v3dv: .*build-mesa"):
        require_mobile()


@pytest.mark.usefixtures("intel", "own_cache")
@pytest.mark.parametrize("family, version", [("a630", [1, 9, 0]), ("v3d42", [1, 0, 0])])
def test_the_null_device_answers_for_itself_alone(family, version):
    told = driver.variables(FAMILIES[family].null_device)
    assert tried(told) == [0, NO_DEVICE, NO_DEVICE, version]


def script(folder: Path, name: str, text: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(f"#!/bin/sh\n{text}\n")
    (folder / name).chmod(0o755)


@pytest.fixture
def tools(tmp_path, monkeypatch):
    """Programs to build with that make what the real ones would, as far as it is looked for."""
    folder = tmp_path / "bin"
    for name in [*build.PROGRAMS, *build.DEBIAN_PROGRAMS, "python3"]:
        script(folder, name, "exit 0")
    script(folder, "meson", 'mkdir -p "$2" && touch "$2/build.ninja" && echo configured')
    makes = "; ".join(
        f'mkdir -p "$2/src/{name}/vulkan"; echo \'{{"ICD": {{"library_path": "/x/libvulkan_{name}.so"}}}}\' '
        f'> "$2/src/{name}/vulkan/{name}_devenv_icd.x86_64.json"'
        for name in ("freedreno", "broadcom")
    )
    script(folder, "ninja", makes)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")
    monkeypatch.delenv(driver.VARIABLE, raising=False)
    return folder


@pytest.fixture
def tarball(tmp_path):
    """A source of Mesa, as far as the build looks at it."""
    source = tmp_path / "mesa-1.2.3"
    source.mkdir()
    (source / "meson.build").write_text("project('mesa')\n")
    path = tmp_path / "mesa.tar.gz"
    subprocess.run(["tar", "czf", str(path), "-C", str(tmp_path), source.name], check=True)
    return str(path)


@pytest.mark.usefixtures("own_cache", "tools")
def test_a_build_is_remembered_and_found(run, tmp_path, tarball):
    where = tmp_path / "mesa"
    status, _, err = run("doctor", "--build-mesa", str(where), "--mesa-source", tarball, "--yes")
    assert status == 0 and build.COST in err, err
    assert driver.folder() == where and driver_files.driver_file(TURNIP).is_relative_to(where)
    assert [path.name for path in where.iterdir() if path.name.endswith(".part")] == []


@pytest.mark.usefixtures("own_cache")
def test_a_build_goes_on_where_it_was_ended(run, tmp_path, tarball, tools):
    where = tmp_path / "mesa"
    whole = (tools / "ninja").read_text()
    script(tools, "ninja", "echo 'x.c:1: error: no such thing'; exit 1")
    words = ["doctor", "--build-mesa", str(where), "--mesa-source", tarball, "--yes"]
    status, _, err = run(*words)
    assert status == 2 and "ninja fails: x.c:1: error: no such thing; see" in err and driver.folder() is None
    (tools / "ninja").write_text(whole)
    script(tools, "meson", "exit 1")
    status, _, err = run(*words)
    assert status == 0 and "fetching" not in err and "configuring" not in err, err


@pytest.mark.usefixtures("tools")
def test_a_build_that_cannot_be_remembered_says_how_to_name_it(run, tmp_path, tarball, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    where = tmp_path / "mesa"
    status, _, err = run("doctor", "--build-mesa", str(where), "--mesa-source", tarball, "--yes")
    assert status == 2 and f"set {driver.VARIABLE}={where}" in err, err


@pytest.mark.usefixtures("own_cache", "tools")
def test_nothing_is_built_unless_somebody_agrees(run, tmp_path, tarball, monkeypatch):
    monkeypatch.setattr(build, "_agrees", lambda: False)
    status, _, err = run("doctor", "--build-mesa", str(tmp_path / "mesa"), "--mesa-source", tarball)
    assert status == 2 and "nothing was built; --yes builds without asking" in err
    assert not (tmp_path / "mesa").exists()


@pytest.mark.usefixtures("own_cache")
def test_what_is_missing_is_one_line_with_the_packages(run, tmp_path, tarball, tools, monkeypatch):
    for name in ("meson", "flex"):
        (tools / name).unlink()
    monkeypatch.setenv("PATH", str(tools))
    script(tools, "pkg-config", '[ "$2" != libdrm ]')
    words = ["doctor", "--build-mesa", str(tmp_path / "mesa"), "--mesa-source", tarball, "--yes"]
    status, _, err = run(*words)
    assert status == 3 and err.count("\n") == 1, err
    assert "missing: meson, flex, libdrm; install them (Debian: apt-get install meson flex libdrm-dev)" in err


@pytest.mark.usefixtures("own_cache", "tools")
@pytest.mark.parametrize(
    "words, said",
    [
        (["--build-mesa", "mesa", "--yes", "--mesa-source", "no/such.tar"], "--mesa-source no/such.tar: no such file"),
        (["--build-mesa", "mesa", "--yes", "--mesa-source", __file__], "test_mobile.py: "),
        (["--build-mesa", "mesa", "--plot", "sphere.png"], "leave out the file and its options"),
        (["--yes"], "go with --build-mesa DIR"),
    ],
)
def test_bad_words_are_one_line(run, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    status, _, err = run("doctor", *words)
    assert status == 2 and said in err.splitlines()[-1], err


def test_another_system_than_debian_is_told_to_give_a_tarball(monkeypatch):
    monkeypatch.setattr(build, "_release", lambda: iter(['ID="fedora"', "VERSION_CODENAME="]))
    with pytest.raises(UsageError, match="--mesa-source FILE or URL"):
        build._codename()


@pytest.fixture
def built():
    """A build of the user's; the tests that need one are skipped on other machines."""
    if any(isa.missing(library) for library in MOBILE):
        pytest.skip("Mesa's mobile drivers are not built here")


@pytest.mark.usefixtures("built", "own_cache")
def test_every_encoding_and_packing_is_counted():
    """With kinds that add up wherever the driver lists its code: all but v3dv's compute shaders."""
    packings = list(dict.fromkeys(packing for several in PACKINGS.values() for packing in several))
    chosen = cost.cases(ENCODINGS.values(), packings, cost.OPERATIONS)
    rows = [row for row, _ in cost.isa_rows(chosen, list(STAGES), CHOICES["mobile"], [], cost.nobody)]
    assert len(rows) == len(chosen) * len(STAGES) * 4
    for row in rows:
        assert row["skipped"] is None and row["instructions"] >= 0, row
        if (row["family"], row["stage"]) != ("v3d42", "compute"):
            assert sum(row[kind] for kind in cost.READERS[FAMILIES[row["family"]].vendor].KINDS) == row["instructions"]
        if row["encoding"] == "xyz":
            assert row["instructions"] == 0, row
