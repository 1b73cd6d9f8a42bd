"""Odd words on the command line, and files with odd names or of odd kinds."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NoReturn
from unittest.mock import patch

import numpy as np
from written import packed, some_normals, write_image

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.run import measuring

from .kind import MEASURED, Attack, Kind, command, outcome

# Commands that end soon; `{}` is where an odd word goes.
COMMANDS = (
    "list {}",
    "columns {}",
    "tune {}",
    "tune octahedral --storage {}",
    "quality --normals axes --backend jax --encoding {}",
    "quality --normals axes --backend jax --encoding xyz --storage {}",
    "quality --normals axes --backend jax --encoding mine.hlsl -D {}",
    "quality --normals axes --backend jax --encoding mine.hlsl --prelude {}",
    "quality --normals axes --backend jax --encoding mine.hlsl --include {}",
    "quality --normals axes --backend jax --encoding mine.hlsl --language {}",
    "quality --normals {} --backend jax --encoding xyz",
    "quality --normals axes --backend {} --encoding xyz",
    "quality --normals sphere --backend jax --encoding xyz --count {}",
    "quality --normals sphere --backend jax --encoding xyz --count 64 --seed {}",
    "quality --normals axes --backend jax --encoding xyz --format {}",
    "quality --normals axes --backend jax --encoding xyz {}",
    "depth --depth {} --backend jax",
    "depth --near {} --backend jax --depth linear --storage r16f",
    "frames --encoding {} --backend jax --count 64",
    "cost --encoding {} --operation encode",
    "render --layout {} --scene room",
    "render --scene {} --layout thin",
    "lights --lights {}",
    "run --tables {}",
    "run {}",
    "compare {} run",
    "report {}",
    "check {}",
    "check {} --run run",
    "{}",
)
PLAIN = """
all all,all nope none -1 0 1 nan inf -inf 1e999 1e-999 0x10 1,2 xyz,xyz xyz, XYZ xyz:scale=1 : = -- - --help -o
stereographic:scale=nan stereographic:scale= best_fit:table=nowhere.npy --format=json
. .. / /dev/null /dev/zero ~ * ? [ \\ ' " `id` $(id) ; | %s {} {0} no.png no.glsl no.toml no.npy é 日本
pipe pipe.png pipe.npy pipe.glsl pipe.toml pipe.glb loop.png loop.toml run run/run.json list.npy ../x.toml
marked.toml marked.glsl binary.toml binary.glsl sealed.toml sealed.png a,b.png ='x'.png /nowhere/x.toml
mine.hlsl mine.hlsl:A:B:define=A mine.hlsl:define= mine.hlsl:include=/ mine.hlsl:prelude=/etc/passwd mine.hlsl:prelude=
mine.hlsl:A,mine.hlsl:B mine.hlsl:A,loop.hlsl:B loop.hlsl pipe.hlsl mine.hlsl:prelude=pipe.hlsl X=/ X= =X A=1 hlsl wgsl
empty.png empty.toml empty.npy empty.glsl empty.obj /proc/self/mem /proc/self/environ
"""
ODD = ("", " ", ",", ",,", "\x07", "\x1b[31m", "\x00", "\r", "\n", "a\nb", "\u202e", "\udcff", "\ufeff", "\U0001d51b")
LONG = ("9" * 400, "a" * 300, "a" * 5000, "a" * 300 + ".toml")
WORDS = (*PLAIN.split(), *ODD, *LONG, "a folder", "best_fit:table=a folder")


def prepare(folder: Path) -> None:
    """Write a file of each odd kind: pipes, links in a loop, unreadable files, byte-order marks."""
    os.chdir(folder)
    Path("a folder").mkdir(exist_ok=True)
    for name in ("pipe", "pipe.png", "pipe.npy", "pipe.glsl", "pipe.hlsl", "pipe.toml", "pipe.glb"):
        if not Path(name).exists():
            os.mkfifo(name)
    for name in ("loop.png", "loop.toml", "loop.hlsl"):
        Path(name).unlink(missing_ok=True)
        Path(name).symlink_to(name)
    for ending in ("png", "toml", "npy", "glsl", "obj"):
        Path(f"empty.{ending}").touch()
    for ending in ("toml", "glsl"):
        Path(f"binary.{ending}").write_bytes(np.random.default_rng(0).bytes(999))
        Path(f"marked.{ending}").write_bytes(b"\xef\xbb\xbf# a mark\n")
    Path("mine.hlsl").write_text('#include "/etc/passwd"\nfloat2 A(float3 n) { return n.xy; }\n')
    np.save("list.npy", some_normals()[0])
    eight = packed(some_normals()[:4, :4], np.uint8)
    for name in ("a,b.png", "='x'.png", "sealed.png"):
        write_image(Path(name), eight)
    Path("sealed.toml").write_text("[[gate]]\n")
    for name in ("sealed.png", "sealed.toml"):
        Path(name).chmod(0)


MEASURING = "here it would be measured"


def would_measure(*_: object) -> NoReturn:
    """Raise an error instead of measuring, because some words select the whole catalogue."""
    raise UsageError(MEASURING)


def odd_words(folder: Path) -> Attack:
    """Return an attack with one or more odd words in a command, which must always end soon."""
    prepare(folder)

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        pattern = COMMANDS[seed % len(COMMANDS)]
        word = WORDS[seed // len(COMMANDS) % len(WORDS)] if seed < len(COMMANDS) * len(WORDS) else glued(rng)
        words = [word if part == "{}" else part for part in pattern.split()]
        with patch.object(measuring, "progress", would_measure):
            status, _, err = command(*words)
        return MEASURED if MEASURING in err else outcome(status, err)

    def glued(rng: np.random.Generator) -> str:
        parts = [WORDS[rng.integers(len(WORDS))] for _ in range(rng.integers(1, 4))]
        return ("", ",", ".", ":", "=")[rng.integers(5)].join(parts)

    return case


KINDS = (Kind("words", odd_words, 2500, 130, seconds=10.0, chunk=400),)
