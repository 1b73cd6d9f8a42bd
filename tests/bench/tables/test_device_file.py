"""Device files: reading them, and one-line errors for damaged, hostile and enormous files."""

import json
import os
import time

import devices as made
import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.devices import device_file
from normalbench.bench.tables.devices.device_file import read_device_file
from normalbench.bench.tables.devices.names import browser_name, device_name, told_apart


@pytest.mark.parametrize(
    "renderer, name",
    [
        (made.SWIFTSHADER, "SwiftShader"),
        (made.GEFORCE, "GeForce RTX 4090"),
        ("ANGLE (NVIDIA Corporation, NVIDIA GeForce RTX 4090/PCIe/SSE2, OpenGL 4.5.0)", "GeForce RTX 4090"),
        ("ANGLE (NVIDIA, NVIDIA GeForce GTX 980 Direct3D11 vs_5_0 ps_5_0), or similar", "GeForce GTX 980 or similar"),
        (made.APPLE, "Apple M2"),
        (made.MALI, "Mali-G78"),
        ("Adreno (TM) 740", "Adreno 740"),
        ("ANGLE (Intel, Intel(R) Iris(R) Xe Graphics (0x46A8) Direct3D11 vs_5_0, D3D11)", "Intel Iris Xe Graphics"),
        ("ANGLE (AMD, AMD Radeon RX 6800 XT (RADV NAVI21), Vulkan 1.3)", "Radeon RX 6800 XT"),
        ("ANGLE (Mesa, llvmpipe (LLVM 19.1.7, 256 bits), OpenGL 4.5)", "llvmpipe"),
        ("ANGLE (Samsung Xclipse 920) on Vulkan 1.1.179", "Samsung Xclipse 920"),
        ("Apple GPU", "Apple GPU"),
        ("", "unknown device"),
        ("ANGLE (,,)", "unknown device"),
        ("x" * 1000, "x" * 48),
    ],
)
def test_a_renderer_has_a_short_name(renderer, name):
    assert device_name(renderer) == name


def test_renderers_with_the_same_short_name_are_distinguished_in_any_order():
    """Renderers are told apart by their API, or by four digits of a hash if the API is the same too."""
    other = "ANGLE (NVIDIA Corporation, NVIDIA GeForce RTX 4090/PCIe/SSE2, OpenGL 4.5.0)"
    assert told_apart([made.GEFORCE, other]) == {
        made.GEFORCE: "GeForce RTX 4090 (Direct3D11)",
        other: "GeForce RTX 4090 (OpenGL)",
    }
    every = ["Mali-G78", made.MALI, made.MALI.replace("3.2", "3.1"), "Mali-G78 ", made.APPLE]
    names = told_apart(every)
    assert len(set(names.values())) == len(every), names
    assert names == told_apart(reversed(every)) and names[made.APPLE] == "Apple M2"


@pytest.mark.parametrize(
    "agent, name",
    [
        (made.CHROMIUM, "Chromium 156"),
        (made.FIREFOX, "Firefox 153"),
        (made.SAFARI, "Safari 18"),
        ("Mozilla/5.0 Chrome/120.0.0.0 Safari/537.36 Edg/121.0.0.0", "Edge 121"),
        ("Mozilla/5.0 (iPhone) AppleWebKit/605.1.15 CriOS/120.0 Mobile Safari/604.1", "Chrome on iOS 120"),
        ("", "unknown browser"),
        ("curl", "curl"),
    ],
)
def test_a_browser_has_a_short_name(agent, name):
    assert browser_name(agent) == name


def test_a_file_is_read_unchanged_except_for_times_and_control_characters(tmp_path):
    """Times are converted to UTC, and control characters are removed."""
    path = made.write(tmp_path / "a.json", made="2026-11-23T16:00:00+01:00", vendor="a\u202eb\n\x1b[31mc")
    file = read_device_file(path).file
    assert file.made == "2026-11-23T15:00:00Z" and file.vendor == "a b [31mc"
    assert [row.model_dump() for row in file.codecs] == made.codec_rows()
    assert file.identity == (made.SWIFTSHADER, "Chromium 156")


def edited(change) -> bytes:
    """Return a device file with a change to its content."""
    content = made.content()
    change(content)
    return json.dumps(content).encode()


def of_row(**more):
    return lambda content: content["codecs"][1].update(more)


GOOD = json.dumps(made.content()).encode()


NESTED = 100_000


# What is wrong with it, the bytes, and what the line says.
BAD = {
    "empty": (b"", "it is empty"),
    "blank": (b" \n\t", "it is empty"),
    "byte-order mark": (b"\xef\xbb\xbf" + GOOD, "it starts with a byte-order mark"),
    "UTF-16": ("{}".encode("utf-16"), "byte 1: not UTF-8 text"),
    "Latin-1": (GOOD.replace(b"a vendor", b"a v\xe9ndor"), "not UTF-8 text"),
    "cut off": (GOOD[:-20], "this is not JSON"),
    "not JSON": (b"<html>", "line 1, column 1: this is not JSON"),
    "nested": (b"[" * NESTED, "it is nested too deep"),
    "nested elsewhere": (b'{"normalbench_device": 1, "more": ' + b"[" * NESTED, "it is nested too deep"),
    "NaN": (GOOD.replace(b'"normals": 65536', b'"normals": NaN', 1), "codecs[0].normals is not a finite number"),
    "Infinity": (
        GOOD.replace(b'"max_deg": ', b'"max_deg": Infinity, "x": ', 1),
        "codecs[0].max_deg is not a finite number",
    ),
    "too large for a float": (
        GOOD.replace(b'"encode_ms": ', b'"encode_ms": 1e999, "x": ', 1),
        "codecs[0].encode_ms is not a finite number",
    ),
    "too many digits": (GOOD.replace(b"65536", b"9" * 5000, 1), "codecs[0].normals is not a finite number"),
    "a key twice": (GOOD.replace(b'"vendor"', b'"browser"'), "browser is given twice in one object"),
    "a run's rows": (json.dumps([{"encoding": "xy", "psnr_db": 3.0}]).encode(), "not a device file"),
    "a run's facts": (json.dumps({"request": {"tables": "all"}, "finished": True}).encode(), "not a device file"),
    "a later version": (edited(lambda c: c.update(normalbench_device=2)), "normalbench_device: 2 is not supported"),
    "true as a version": (
        edited(lambda c: c.update(normalbench_device=True)),
        "normalbench_device: True is not supported",
    ),
    "no renderer": (edited(lambda c: c.pop("renderer")), "renderer is missing"),
    "a renderer of a number": (edited(lambda c: c.update(renderer=3)), "renderer: 3 is not text"),
    "a long renderer": (edited(lambda c: c.update(renderer="x" * 1025)), "is longer than 1024 characters"),
    "half a character": (edited(lambda c: c.update(vendor="\ud800")), "is not text"),
    "no time": (edited(lambda c: c.update(made="yesterday")), "made: yesterday is not a time such as"),
    "a time before all": (edited(lambda c: c.update(made="0001-01-01T00:00:00+10:00")), "is not a time such as"),
    "codecs of text": (edited(lambda c: c.update(codecs="xy")), "codecs: xy is not a list"),
    "no codecs": (edited(lambda c: c.update(codecs=[])), "codecs: no entries"),
    "many codecs": (
        edited(lambda c: c.update(codecs=[{}] * 4097)),
        "codecs: more than 4096 entries",
    ),
    "a codec of text": (edited(lambda c: c["codecs"].insert(0, "xy")), "codecs, row 1: xy is not an object"),
    "no target": (edited(lambda c: c["codecs"][2].pop("target")), "codecs, row 3, target is missing"),
    "no name": (edited(of_row(encoding="\u202e ")), "encoding: "),
    "the counts": (edited(of_row(equal=1)), "codecs, row 2: equal, one_step and further add up to 1; normals is 65536"),
    "a count below 0": (edited(of_row(further=-1, equal=65537)), "codecs, row 2, further: -1 is less than 0"),
    "a count of a half": (edited(of_row(one_step=0.5)), "one_step: 0.5 is not a whole number"),
    "a count of truth": (edited(of_row(one_step=False)), "one_step: False is not a whole number"),
    "an angle of text": (edited(of_row(mean_deg="3")), "mean_deg: 3 is not a number"),
    "an angle beyond": (edited(of_row(max_deg=181)), "max_deg: 181 is more than 180"),
    "a codec twice": (
        edited(lambda c: c["codecs"].append(c["codecs"][0])),
        "codecs lists spheremap rgba8 nearest RGBA8 twice",
    ),
    "facts in a list": (edited(lambda c: c.update(facts=[])), "facts: [] is not an object"),
    "many facts": (
        edited(lambda c: c.update(facts={str(i): 1 for i in range(513)})),
        "facts: more than 512 entries",
    ),
    "a fact in a list": (edited(lambda c: c["facts"].update(NaN=[1])), "facts, NaN: [1] is neither text nor a number"),
    "a fact of truth": (edited(lambda c: c["facts"].update(NaN=True)), "facts, NaN: True is neither text nor a number"),
    "a long fact": (edited(lambda c: c["facts"].update(NaN="x" * 2000)), "is longer than 1024 characters"),
    "a large fact": (edited(lambda c: c["facts"].update(NaN=10**400)), "facts.NaN is not a finite number"),
    "a long name": (edited(lambda c: c["facts"].update({"n" * 200: 1})), "is longer than 128 characters"),
    "facts that read alike": (
        edited(lambda c: c.update(facts={"a b": 1, "a\nb": 2})),
        "has two names that look the same",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_file_is_a_one_line_error_with_its_name_and_location(run, tmp_path, what):
    data, message = BAD[what]
    path = tmp_path / "bad.json"
    path.write_bytes(data)
    status, out, err = run("devices", "--devices", str(path))
    assert (status, out) == (2, "") and err.startswith(f"normalbench: {path}: ") and message in err, err
    assert err.count("\n") == 1 and len(err) < 400 + len(str(path)), err


def test_missing_file_empty_folder_and_pipe_are_one_line_errors(run, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "empty").mkdir()
    os.mkfifo(tmp_path / "pipe")
    expected = {
        "pipe": "it is not a plain file",
        "none.json": "there is no such file",
        "empty": "no *.json files here",
    }
    for name, message in expected.items():
        status, out, err = run("devices", "--devices", str(tmp_path / name))
        assert (status, out, err.count("\n")) == (2, "", 1) and message in err, err
    status, _, err = run("devices")
    assert status == 2 and "--devices: no device file named" in err


def test_an_enormous_file_is_refused_before_it_is_read(tmp_path):
    """A sparse file of 1 TiB is refused within a second."""
    path, begun = tmp_path / "large.json", time.perf_counter()
    with path.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(UsageError, match=r"large\.json: it is larger than 4 MiB"):
        read_device_file(path)
    took = time.perf_counter() - begun
    assert took < 1, f"{took:.2f} s"


def test_the_largest_accepted_file_is_read_quickly(tmp_path):
    """A file of 4096 codecs and 512 facts takes less than 2 seconds."""
    row = made.codec_rows()[0]
    rows = [row | {"encoding": f"mine_{number}"} for number in range(device_file.MOST_CODECS)]
    facts = {f"fact {number}": number for number in range(device_file.MOST_FACTS)}
    path, begun = made.write(tmp_path / "large.json", codecs=rows, facts=facts), time.perf_counter()
    file = read_device_file(path).file
    took = time.perf_counter() - begun
    assert (len(file.codecs), len(file.facts)) == (4096, 512) and took < 2, f"{took:.2f} s"
