"""Instructions from Intel's compilers: listings, comparable kernels and the null device."""

import json
import os
import subprocess
import sys

import pytest
from vendors import INSTRUCTIONS, INTEL

from normalbench.bench.ground.compilers.text import judged, own
from normalbench.bench.ground.options.gpu_families import FAMILIES
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.keep.machine import require_intel
from normalbench.bench.shaders.isa import null_device

# What a process with the null device finds: errno of each try, 0 where it works.
TRIES = """
import fcntl, json, os, struct
def tried(what):
    try:
        what()
    except OSError as error:
        return error.errno
    return 0
capability = 0xC010640C
zero, null, pipe = os.open("/dev/zero", os.O_RDWR), os.open("/dev/null", os.O_RDWR), os.pipe()[0]
print(json.dumps([
    tried(lambda: fcntl.ioctl(zero, capability, bytes(16))),
    tried(lambda: fcntl.ioctl(null, capability, bytes(16))),
    tried(lambda: os.open("/dev/dri/renderD128", os.O_RDWR)),
    tried(lambda: os.open("/dev/dri/card0", os.O_RDWR)),
    tried(lambda: fcntl.ioctl(pipe, 0x541B, bytes(4))),
]))
"""


NO_DEVICE = 19  # ENODEV


def tried(**told: str) -> list[int]:
    done = subprocess.run([sys.executable, "-c", TRIES], capture_output=True, text=True, env=os.environ | told)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.usefixtures("intel", "own_cache")
def test_the_null_device_answers_only_for_itself():
    """DRM requests on other files and the opening of real devices are refused; other requests pass."""
    told = null_device.variables(FAMILIES["skl"].null_device)
    assert tried(**told) == [0, NO_DEVICE, NO_DEVICE, NO_DEVICE, 0]
    assert tried(LD_PRELOAD=told["LD_PRELOAD"]) == [NO_DEVICE] * 4 + [0]


@pytest.mark.usefixtures("intel")
def test_the_null_device_is_built_once_and_rebuilt_if_damaged(own_cache, monkeypatch):
    path = null_device.library()
    built_ns = path.stat().st_mtime_ns
    assert path.parent == own_cache / "normalbench" and null_device.library().stat().st_mtime_ns == built_ns
    whole = path.read_bytes()
    path.write_bytes(whole[:100])
    assert null_device.library().read_bytes() == whole
    monkeypatch.setattr(null_device, "SOURCE", own_cache / "null_i915.c")
    monkeypatch.setattr(
        null_device, "own", lambda path: judged(path.read_text(), "c") if "915" in path.name else own(path)
    )
    (own_cache / "null_i915.c").write_text("int nothing;\n")
    assert null_device.library().name[:26] != path.name[:26]
    assert not [file for file in path.parent.iterdir() if file.suffix != ".so"]


def without_cc(monkeypatch, _):
    monkeypatch.setattr(null_device, "COMPILER", "no-such-cc")


def with_a_broken_cc(monkeypatch, folder):
    (folder / "cc").write_text("#!/bin/sh\necho 'stdio.h: no such file' >&2\nexit 1\n")
    (folder / "cc").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")


@pytest.mark.usefixtures("intel", "own_cache")
@pytest.mark.parametrize(
    "take, status, said",
    [(without_cc, 3, "apt-get install gcc"), (with_a_broken_cc, 0, "stdio.h: no such file; libc's headers")],
)
def test_a_machine_without_a_c_compiler_loses_only_intels_rows(run, monkeypatch, tmp_path, take, status, said):
    take(monkeypatch, tmp_path)
    exit_status, out, err = run(*INSTRUCTIONS, "--stage", "fragment", "--family", "navi21,skl")
    rows = json.loads(out)
    assert (exit_status, err.count("\n")) == (status, 1) and said in err, err
    (lost,) = [row for row in rows if row["skipped"]]
    assert lost["family"] == "skl" and said in lost["skipped"] and lost["instructions"] is None
    counted = [row for row in rows if row["family"] == "navi21"]
    assert len(counted) == 6 and all(row["instructions"] > 0 for row in counted)


@pytest.mark.usefixtures("intel", "own_cache")
def test_missing_c_compiler_for_intels_counts_is_reported(monkeypatch):
    require_intel()
    monkeypatch.setattr(null_device, "COMPILER", "no-such-cc")
    null_device.library().unlink()
    with pytest.raises(MissingError, match="apt-get install gcc"):
        require_intel()


# To encode octahedral, by hand; Tiger Lake's wait is one more (Mesa 22.3.6).
OCTAHEDRAL = {"hsw": 11, "bdw": 11, "skl": 11, "tgl": 12, "adl": 12, "dg2": 11}


def test_intels_compilers_give_the_known_counts(vendor_rows, is_every=False):
    rows = vendor_rows(INTEL, is_every)
    assert {row["transcendental"] for row in rows if row["encoding"] == "octahedral"} == {1}
    if {row["driver"] for row in rows} != {"Mesa 22.3.6"}:
        pytest.skip("counts hold for one Mesa")
    for name in INTEL.families(is_every):
        asked = (name, "fragment", "encode")
        chosen = [row for row in rows if (row["family"], row["stage"], row["operation"]) == asked]
        counts = {row["encoding"]: row["instructions"] for row in chosen}
        assert counts["octahedral"] == OCTAHEDRAL[name], name
        order = [counts[encoding] for encoding in ("xy", "stereographic", "spheremap", "octahedral")]
        assert order == sorted(set(order)), name
