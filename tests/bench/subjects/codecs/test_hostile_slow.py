"""Users' code that hangs, crashes, exhausts memory or lies, and loses only its own rows with a stated reason."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from test_hostile import GOOD

pytestmark = pytest.mark.usefixtures("gl")


TWIN = """
import ctypes, os, subprocess, sys, time
import jax.numpy as jnp
import numpy as np
from normalbench.encodings.vec import Vec2, Vec3
def decode(e, view):
    return Vec3(e.x, e.y, jnp.sqrt(jnp.maximum(1.0 - e.x * e.x - e.y * e.y, 0.0)))
def encode(n, view):
    BODY
    return Vec2(n.x, n.y)
TOP
"""


# (at the end of the file, in encode, what is said)
TWINS = {
    "ends_at_once": ("os._exit(0)", "pass", "ended the process with status 0"),
    "ends_in_encode": ("", "os._exit(3)", "ended the process with status 3"),
    "loops_at_once": ("while True: pass", "pass", "SIG(XCPU|KILL)"),
    "loops_in_encode": ("", "while True: pass", "SIG(XCPU|KILL)"),
    "crashes": ("", "ctypes.string_at(0)", "SIGSEGV"),
    "grows": ("", "np.ones(1 << 36)", "MemoryError"),
    "prints": ("", "while True: print('x' * 10000)", "File too large"),
    "raises": ("", "raise ValueError('what is this?')", r"ValueError in line \d+: what is this"),
    "exits": ("raise SystemExit(0)", "pass", "SystemExit"),
    "is_flat": ("", "return Vec2(n.x[0], n.y[:2])", "IndexError|ValueError|TypeError"),
    "lists": ("", "return [n.x, n.y]", "encode returns list, not a Vec2 or a Vec3"),
    "has_three": ("", "return Vec3(n.x, n.y, n.z)", "encode returns 3 numbers"),
    "recurses": ("", "return encode(n, view)", "RecursionError"),
}


BOMB = "#define A0 s += sin(s);\n" + "".join(f"#define A{i + 1} A{i} A{i} A{i} A{i}\n" for i in range(12))


SHADERS = {
    "bomb": (BOMB + GOOD.replace("return n.xy;", "float s = n.x; A12 return n.xy * s;"), "its shader|error"),
    "large": (
        GOOD.replace("return n.xy;", "float a[100000000]; a[int(n.z * 9e7)] = n.x; return vec2(a[int(n.x*9e7)]);"),
        "",
    ),
    "endless": (
        GOOD.replace("return n.xy;", "float s = n.x; while (s < 2.0) s *= 0.5; return n.xy * s;"),
        "do not end here",
    ),
    "long": (
        GOOD.replace(
            "return n.xy;",
            "float s; for (int i = 0; i < 256; i++) for (int j = 0; j < 256; j++) s += n.x; return n.xy * s;",
        ),
        "do not end here",
    ),
    "not_a_number": (GOOD.replace("return n.xy;", "return sqrt(n.xy - 2.0);"), "not finite"),
    "unclosed": (GOOD + "/* never closed", "not closed"),
    "misspelt": (GOOD.replace("n.xy", "n.xq"), r"misspelt\.glsl:2"),
    "half": (GOOD.split("vec3 NAME_decode")[0], "no function vec3 half_decode"),
    "garbage": ("\x00\x01\x02\xff", "no function|the character U.0000 is not supported"),
    "uniform": ("uniform float k;\n" + GOOD.replace("return n.xy;", "return n.xy * k;"), "reads the uniform k, which"),
    "texture": (
        "layout(binding = 0) uniform sampler2D table[2];\n"
        + GOOD.replace("return n.xy;", "return texture(table[0], n.xy).xy;"),
        "reads the uniform table, which has no value here",
    ),
    "block": (
        "buffer Data { vec2 scale; int unread; };\n" + GOOD.replace("return n.xy;", "return n.xy * scale;"),
        "reads scale of a block",
    ),
    "empty": ("", "no function vec2"),
    "stops": ("#error no\n" + GOOD, r"stops\.glsl:1"),
}


# Of these no more than the two functions is read.
READ_IN_PART = {
    "includes": '#include "/etc/hostname"\n' + GOOD,
    "with_main": GOOD + "void main() {}",
    "with_version": "#version 450\n" + GOOD,
}


# Linux counts the peak of who starts a process as that process's: this one has the tests before it in its
# memory, so a small process comes between. It writes the peak of the command and of its children.
WATCHED = """
import os, subprocess, sys
_, status, usage = os.wait4(subprocess.Popen(sys.argv[2:]).pid, 0)
open(sys.argv[1], "w").write(str(usage.ru_maxrss))
sys.exit(os.waitstatus_to_exitcode(status))
"""


def measured(folder: Path, *names: str) -> tuple[list[dict], str]:
    """Return the rows of the named files and the messages, from a process whose memory is watched."""
    command = [sys.executable, "-m", "normalbench", "quality", "--encoding", ",".join(names), "--format", "json"]
    command += ["--normals", "hemisphere", "--count", "4096", "--storage", "rgba8"]
    peak = folder / "peak"
    watched = [sys.executable, "-c", WATCHED, str(peak), *command]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        status = subprocess.run(watched, cwd=folder, stdout=out, stderr=err).returncode
        out.seek(0)
        err.seek(0)
        rows, messages = out.read(), err.read()
    assert status == 0 and "Traceback" not in messages, messages
    assert int(peak.read_text()) < 2 << 20, "2 GiB, in kilobytes"
    return json.loads(rows), messages


def written(folder: Path, name: str, shader: str = GOOD, twin: str = "") -> str:
    (folder / f"{name}.glsl").write_text(shader.replace("NAME", name))
    if twin:
        (folder / f"{name}.py").write_text(twin)
    return f"{name}.glsl"


def twin_of(name: str) -> str:
    top, body, _ = TWINS[name]
    return TWIN.replace("BODY", body).replace("TOP", top)


def test_two_dozen_hostile_files_do_not_affect_other_files(tmp_path):
    files = [written(tmp_path, name, twin=twin_of(name)) for name in TWINS]
    files += [written(tmp_path, name, text) for name, (text, _) in SHADERS.items()]
    files += [written(tmp_path, name, text) for name, text in READ_IN_PART.items()]
    good = written(tmp_path, "good", twin=TWIN.replace("BODY", "pass").replace("TOP", ""))
    rows, messages = measured(tmp_path, *files, "octahedral", good)
    figures = {(row["encoding"], row["backend"]): row["psnr_db"] for row in rows}
    assert all(figures[name, backend] for name in ("octahedral", "good") for backend in ("jax", "glsl"))
    assert all(figures[name, "glsl"] == figures["good", "glsl"] for name in READ_IN_PART)
    assert "/etc/hostname is outside the folder of includes.glsl" in messages
    lines = [line for line in but_the_domain(messages) if not re.search(rf"\b({'|'.join(READ_IN_PART)})\b", line)]
    for name, (*_, why) in {**TWINS, **SHADERS}.items():
        (line,) = [line for line in lines if re.search(rf"\b{name}\.(glsl|py)", line)]
        assert re.search(why, line), line
        # A twin costs the rows by JAX, a shader all of them.
        assert bool(figures.get((name, "glsl"))) == (name in TWINS) and not figures.get((name, "jax")), name
    assert len(lines) == len(TWINS) + len(SHADERS)


def but_the_domain(said: str) -> list[str]:
    """Return all lines except notes on the assumed domain and on the backend."""
    return [line for line in said.splitlines() if not re.search("assumed to be made only for|computed by XLA", line)]


def test_a_twin_that_contradicts_its_shader_is_reported(tmp_path):
    twin = TWIN.replace("BODY", "return Vec2(n.y, n.x)").replace("TOP", "")
    rows, messages = measured(tmp_path, written(tmp_path, "turned", twin=twin))
    assert len(rows) == 2 and re.search(r"turned\.py: encode differs from the GLSL for \d+% of inputs", messages)
    assert len(but_the_domain(messages)) == 1


def test_nothing_in_the_current_folder_is_imported(tmp_path):
    """The user's folder has a module with the name of each module in the standard library."""
    for name in sorted(sys.stdlib_module_names - {"__main__"}):
        (tmp_path / f"{name}.py").write_text(f"open('{tmp_path}/ran-{name}', 'w'); raise SystemExit('ran {name}')")
    path = written(tmp_path, "mine")
    script = "import sys; from normalbench.bench.door.cli.app import program; sys.exit(program())"
    words = ["quality", "--encoding", path, "--normals", "axes", "--backend", "glsl", "--format", "json"]
    done = subprocess.run([sys.executable, "-P", "-c", script, *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and json.loads(done.stdout)[0]["psnr_db"], done.stderr
    words = ["cost", "--isa", "--encoding", path, "--family", "navi21", "--format", "json"]
    done = subprocess.run([sys.executable, "-P", "-c", script, *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode in (0, 3) and not list(tmp_path.glob("ran-*")), done.stderr
