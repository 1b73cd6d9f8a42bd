"""Damaged shaders and twins: typing errors and malicious changes in a good shader and its twin."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from damaged import mutated
from typed import encodings_named, first_look

from normalbench.bench.ground.output.errors import UsageError

from .kind import MEASURED, REFUSED, Attack, Kind, one_line

SHADER = """
const float HALF = 0.5;
vec2 mine_encode(vec3 n, vec3 view) {
    vec2 e = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    for (int i = 0; i < 3; i++) e += (n.z < 0.0) ? e * 0.0 : vec2(0.0);
    return e * HALF + HALF;
}
vec3 mine_decode(vec2 e, vec3 view) {
    e = (e - HALF) / HALF;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    return normalize(n);
}
"""
TWIN = """
import jax.numpy as jnp
from normalbench.encodings.vec import Vec2, Vec3
def encode(n, view):
    s = 0.5 / (abs(n.x) + abs(n.y) + abs(n.z))
    return Vec2(n.x * s + 0.5, n.y * s + 0.5)
def decode(e, view):
    x, y = e.x * 2.0 - 1.0, e.y * 2.0 - 1.0
    z = 1.0 - abs(x) - abs(y)
    s = 1.0 / jnp.sqrt(x * x + y * y + z * z)
    return Vec3(x * s, y * s, z * s)
"""
IN_GLSL = """
0.5 0.0 1e38 -1 n e view vec2 vec3 float int ++ -- * / ; { } ( ) // /* */ break; discard; gl_Position sqrt out const
inout [9] e.zw return sampler2D
"""
LINES = (
    "#if 0\n",
    "#define n e\n",
    '#include "x"\n',
    "while (true)",
    "return e;",
    "\\\n",
    "\u00e9",
    "\t",
    "sampler2D t;",
)
SLIPS = (*IN_GLSL.split(), *LINES)
IN_PYTHON = "0.0 n e return None raise : ( ) Vec3 jnp 1/0 [] * exit() yield def"
PHRASES = ("import os", "\n", "    ", "lambda: 0", "while True: pass", "print('x' * 9)", "\ufeff", "\u00e9", "\x00")
PYTHON = (*IN_PYTHON.split(), *PHRASES)


def slipped(text: str, words: tuple[str, ...], rng: np.random.Generator) -> bytes:
    """Return a text with a word inserted or overwritten, a line deleted or doubled, or bytes changed."""
    if rng.random() < 0.2:
        return mutated(text.encode(), rng)
    lines = text.splitlines(keepends=True)
    for _ in range(rng.integers(1, 3)):
        index = int(rng.integers(len(lines)))
        line, place = lines[index], int(rng.integers(len(lines[index]) + 1))
        word = words[rng.integers(len(words))]
        match rng.integers(4):
            case 0:
                lines[index] = line[:place] + word + line[place:]
            case 1:
                lines[index] = line[:place] + word + line[place + len(word) :]
            case 2:
                lines[index] = line * 2
            case _:
                lines[index] = "\n"
    return "".join(lines).encode()


def shaders(folder: Path) -> Attack:
    """Return an attack on the first check of shaders, in this process: they are accepted, or refused in one line."""
    path = folder / "mine.glsl"

    def case(seed: int) -> str:
        path.write_bytes(slipped(SHADER, SLIPS, np.random.default_rng(seed)))
        look = first_look(path)
        message = look.get("error", look.get("broken", ""))
        assert message.isprintable() and len(message) < 2000 and look, look
        return REFUSED if message else MEASURED

    return case


def both(folder: Path) -> Attack:
    """Return an attack on a shader and its twin as a command reads them, each in a limited process."""
    os.chdir(folder)
    paths = [folder / f"mine.{ending}" for ending in ("glsl", "py")]

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        for path, text, words in zip(paths, (SHADER, TWIN), (SLIPS, PYTHON), strict=True):
            hurt = seed % 4 == 0 if path.suffix == ".glsl" else seed % 4 > 0
            path.write_bytes(slipped(text, words, rng) if hurt else text.encode())
        try:
            return MEASURED if encodings_named("mine.glsl") else REFUSED
        except UsageError as error:
            return one_line(error)

    return case


KINDS = (
    Kind("shader", shaders, 1320, 40, seconds=15.0, chunk=250),
    Kind("shader and twin", both, 80, 0, seconds=120.0, chunk=20),
)
