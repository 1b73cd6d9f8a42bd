"""What a codec's source code has in every language: six functions, and what they give of normals and texels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...translator.writer import PUBLIC

# How many normals are run at once: it bounds the memory of a run.
BLOCK = 2**16
# What a shader is given of each normal (normal, view, texel), and what it makes (code, unpacked, decoded, target, from
# a target): rows of four numbers.
GIVEN, MADE = 3, 5


@dataclass(frozen=True)
class Interface:
    """The six functions of a file: P_encode, P_pack, P_unpack, P_decode, P_to_target and P_from_target.

    Attributes:
        prefix: P, what their names begin with.
        size: how many numbers a code has, 2 or 3, a sign bit's among them.
        sign_bits: 1 where the last number of a code is a sign that is kept elsewhere, else 0.
        words: how many 32-bit integers a texel has: 1, 2 or 4.
        takes_view: whether `P_encode` and `P_decode` take the view-space position.
        tables: the look-up tables by name, float32 of shape (height, width, channels).
        is_ours: whether nobody else's code is in the file.
    """

    prefix: str
    size: int
    sign_bits: int
    words: int
    takes_view: bool
    tables: Mapping[str, np.ndarray] = field(default_factory=dict)
    is_ours: bool = True

    @property
    def defines(self) -> dict[str, object]:
        """The macros by which the shaders here call the six functions."""
        named = {name.upper(): f"{self.prefix}_{name}" for name in PUBLIC}
        facts = {"SIZE": self.size, "SIGN": self.sign_bits, "WORDS": self.words, "VIEW": int(self.takes_view)}
        return {f"RUN_{name}": value for name, value in {**named, **facts}.items()}


class Ran(NamedTuple):
    """What the six functions gave.

    Attributes:
        codes: float32 of shape (count, size).
        words: uint32 of shape (count, words).
        unpacked: of those words; float32 of shape (count, size).
        decoded: of those codes; float32 of shape (count, 3).
        targets: of the codes; float32 of shape (count, 4).
        from_targets: of the texels that were given; float32 of shape (count, size).
    """

    codes: np.ndarray
    words: np.ndarray
    unpacked: np.ndarray
    decoded: np.ndarray
    targets: np.ndarray
    from_targets: np.ndarray


# Normals and views of shape (count, 3) and texels of shape (count, 4) to what the functions give, up to BLOCK at once.
Run = Callable[[np.ndarray, np.ndarray, np.ndarray], Ran]


@dataclass(frozen=True)
class Runner:
    """What runs files of one language.

    Attributes:
        prepared: (path, interface) -> a context manager that gives a `Run`; the file is compiled once.
        how: one line that says compiler, version and device.

    Both raise MissingError where a tool is missing, with what to install.
    """

    prepared: Callable[[Path, Interface], AbstractContextManager[Run]]
    how: Callable[[], str]

    def run(self, path: Path, interface: Interface, n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        """What the functions of a file give.

        Args:
            path: the file; its tables lie next to it where the language needs that.
            n, view: unit normals and view-space positions, float32 of shape (count, 3).
            texels: what `P_from_target` is given, float32 of shape (count, 4). A sign is the code's own.

        Raises:
            MissingError: a tool is missing; what to install.
            ShaderError: the file does not compile, or it does not run; one line.
            NoDeviceError: there is no GL device, for the languages that need one.
        """
        with self.prepared(Path(path), interface) as run:
            parts = [run(n[block], view[block], texels[block]) for block in blocks(len(n))]
        return Ran(*(np.concatenate(found) for found in zip(*parts, strict=True)))


def blocks(count: int) -> Iterator[slice]:
    """Slices of BLOCK that cover `count` rows; one empty slice for none."""
    return (slice(start, min(start + BLOCK, count)) for start in range(0, max(count, 1), BLOCK))


def rows_of(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> np.ndarray:
    """What a shader is given: three rows of four numbers for each normal, float32 of shape (GIVEN count, 4).

    The fourth number of a normal is 0. By its bits the words change before they are unpacked, so that no compiler can
    see that it unpacks what it has packed: Mesa makes a of (a + b) - b.
    """
    given = np.zeros((len(n), GIVEN, 4), np.float32)
    given[:, 0, :3], given[:, 1, :3], given[:, 2] = n, view, texels
    return given.reshape(-1, 4)


def ran_of(made: np.ndarray, words: np.ndarray, interface: Interface) -> Ran:
    """What a shader made, five rows of four numbers for each normal and four words, without what is not used."""
    rows, size = made.reshape(-1, MADE, 4), interface.size
    words = np.ascontiguousarray(words.reshape(-1, 4)[:, : interface.words])
    code, unpacked, decoded, target, back = np.ascontiguousarray(rows.transpose(1, 0, 2))
    return Ran(code[:, :size], words, unpacked[:, :size], decoded[:, :3], target, back[:, :size])
