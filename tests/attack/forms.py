"""Encoders in the forms that engines use, damaged or wired at random: each is translated, or refused in one line."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from damaged import mutated
from typed import translated

from normalbench.bench.ground.output.errors import MissingError, UsageError
from normalbench.bench.ground.user_files import ENDINGS

from .kind import MEASURED, REFUSED, Attack, Kind, one_line

FORMS = Path(__file__).parents[1] / "inputs" / "encoders"
# What wirings of random words are made of.
PLACES = ("n", "s.normalWS", "o0", "o1.xy", "o1", "t.xyz", "e", "view", "n.xy", "face", "return", "9", "x y", "")
VALUES = ("n", "e", "e.xy", "e.z", "view", "0.5", "1e999", "n)", "gone", "n;n=n", "")
SETTINGS = (
    "define=A=1",
    "define=float3=int",
    "language=slang",
    "language=glsl",
    "include=.",
    "include=/",
)


def forms(folder: Path) -> Attack:
    """Return an attack on the files of engines in turn: changed bytes, functions wired at random, and settings."""
    files = sorted(path for path in FORMS.iterdir() if path.suffix in ENDINGS)

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        original = files[seed % len(files)]
        path = folder / f"mine{original.suffix}"
        data = original.read_bytes()
        path.write_bytes(mutated(data, rng) if rng.random() < 0.6 else data)
        word = str(path)
        if rng.random() < 0.4:
            names = re.findall(r"(\w+)\s*\(", data.decode())
            word += "".join(f":{names[rng.integers(len(names))]}{_wiring(rng)}" for _ in range(2))
        if rng.random() < 0.3:
            word += f":{SETTINGS[rng.integers(len(SETTINGS))]}"
        try:
            translation = translated(word)
        except (UsageError, MissingError) as error:
            one_line(error)
            return REFUSED
        assert len(translation.texts) == 2 and "void main" not in translation.texts[0], word
        return MEASURED

    return case


def _wiring(rng: np.random.Generator) -> str:
    if rng.random() < 0.3:
        return ""
    bound = [
        f"{PLACES[rng.integers(len(PLACES))]}={VALUES[rng.integers(len(VALUES))]}" for _ in range(rng.integers(0, 4))
    ]
    target = f"->{PLACES[rng.integers(len(PLACES))]}" if rng.random() < 0.5 else ""
    return f"({'; '.join(bound)}){target}"


KINDS = (Kind("forms of engines", forms, 500, 0, seconds=60.0, chunk=20),)
