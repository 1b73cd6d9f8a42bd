"""What a codec's source code has in every language: six functions, and what they give of normals and texels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...translator.writer import PUBLIC

# How many normals are run at once: it bounds the memory of a run.
BLOCK = 2**16
# What a shader is given of each normal (normal, view, texel), and what it makes (code, unpacked, decoded, target, from
# a target, and what else is decoded): rows of four numbers.
GIVEN, MADE = 3, 6
# What is decoded, under a name, and how many numbers it has, to the texts of its parts.
Parts = Callable[[str, int], Sequence[str]]


@dataclass(frozen=True)
class Interface:
    """The six functions of a file: P_encode, P_pack, P_unpack, P_decode, P_to_target and P_from_target.

    Attributes:
        prefix: P, what their names begin with.
        size: how many numbers a code has, 1 to 4, a sign bit's among them.
        sign_bits: 1 where the last number of a code is a sign that is kept elsewhere, else 0.
        words: how many 32-bit integers a texel has: 1, 2 or 4.
        settings: where in the rows `n` and `view` what both `P_encode` and `P_decode` are given besides lies: view.xyz.
        tables: the look-up tables by name, float32 of shape (height, width, channels).
        is_ours: whether nobody else's code is in the file.
        value: where what `P_encode` is given lies.
        result: how many numbers `P_decode` gives.
        structure: the type of what `P_encode` is given and `P_decode` gives, if that is a structure; else empty.
        fields: of the structure, one for each of `value`; what is decoded lies as what is given, in two rows.
    """

    prefix: str
    size: int
    sign_bits: int
    words: int
    settings: tuple[str, ...] = ()
    tables: Mapping[str, np.ndarray] = field(default_factory=dict)
    is_ours: bool = True
    value: tuple[str, ...] = ("n.xyz",)
    result: int = 3
    structure: str = ""
    fields: tuple[str, ...] = ()

    @property
    def takes_view(self) -> bool:
        """Whether `P_encode` and `P_decode` take the view-space position."""
        return "view.xyz" in self.settings

    @property
    def defines(self) -> dict[str, object]:
        """The macros by which the shaders here call the six functions."""
        return self.defines_with(", ".join)

    def defines_with(
        self, listed: Callable[[Sequence[str]], str], made: str = "{}({})", parts: Parts = lambda path, _: [path]
    ) -> dict[str, object]:
        """The same, where things are written otherwise.

        Args:
            listed: what is given, in place of n.xyz, view.x.
            made: a structure of its name and its fields.
            parts: (path, size) -> what some numbers of what is decoded are, one after the other.
        """
        value = [made.format(self.structure, listed(self.value))] if self.structure else [listed(self.value)]
        named = {name.upper(): f"{self.prefix}_{name}" for name in PUBLIC}
        facts = {"SIZE": self.size, "SIGN": self.sign_bits, "WORDS": self.words, "RESULT": self.result}
        behind = listed(("", *self.settings))
        given = {"VALUE": value[0] + behind, "SETTINGS": behind}
        # What fills a row of four behind a code, and the two rows of what it is decoded to.
        rows = {"REST": ", 0.0" * (4 - self.size)}
        for name, row in zip(("FIRST", "SECOND"), self._decoded_rows(), strict=True):
            texts = [text for path, size in row for text in parts(path, size)]
            rows[name] = ", ".join(texts + ["0.0"] * (4 - sum(size for _, size in row)))
        structure = {"STRUCTURE": self.structure} if self.structure else {}
        return {f"RUN_{name}": value for name, value in {**named, **facts, **given, **rows, **structure}.items()}

    def _decoded_rows(self) -> list[list[tuple[str, int]]]:
        """Of what is decoded, by its two rows, each part and how many numbers it has."""
        if not self.structure:
            return [[("decoded", self.result)], []]
        rows: dict[str, list[tuple[str, int]]] = {"n": [], "view": []}
        for name, place in zip(self.fields, self.value, strict=True):
            row, _, numbers = place.partition(".")
            rows[row].append((f"decoded.{name}", len(numbers)))
        return list(rows.values())


class Ran(NamedTuple):
    """What the six functions gave.

    Attributes:
        codes: float32 of shape (count, size).
        words: uint32 of shape (count, words).
        unpacked: of those words; float32 of shape (count, size).
        decoded: of those codes; float32 of shape (count, result).
        targets: of the codes; float32 of shape (count, 4).
        from_targets: of the texels that were given; float32 of shape (count, size).
    """

    codes: np.ndarray
    words: np.ndarray
    unpacked: np.ndarray
    decoded: np.ndarray
    targets: np.ndarray
    from_targets: np.ndarray


# Values and settings of shape (count, 3 or 4) and texels of shape (count, 4) to what the functions give, up to BLOCK.
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
            n, view: what functions are given, as unit normals and view-space positions; float32 of shape (count, 3 or
                4), of `view` the first three are used.
            texels: what `P_from_target` is given, float32 of shape (count, 4). A sign is the code's own.

        Raises:
            MissingError: a tool is missing; what to install.
            ShaderError: the file does not compile, or it does not run; one line.
            NoDeviceError: there is no GL device, for the languages that need one.
        """
        with self.prepared(Path(path), interface) as run:
            parts = [run(n[block], view[block], texels[block]) for block in blocks(len(n))]
        return Ran(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def blocks(count: int) -> Iterator[slice]:
    """Slices of BLOCK that cover `count` rows; one empty slice for none."""
    return (slice(start, min(start + BLOCK, count)) for start in range(0, max(count, 1), BLOCK))


def rows_of(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> np.ndarray:
    """What a shader is given: three rows of four numbers for each normal, float32 of shape (GIVEN count, 4).

    The fourth number of a view is 0. By its bits the words change before they are unpacked, so that no compiler can
    see that it unpacks what it has packed: Mesa makes a of (a + b) - b.
    """
    given = np.zeros((len(n), GIVEN, 4), np.float32)
    given[:, 0, : n.shape[1]], given[:, 1, :3], given[:, 2] = n, view[:, :3], texels
    return given.reshape(-1, 4)


def ran_of(made: np.ndarray, words: np.ndarray, interface: Interface) -> Ran:
    """What a shader made, six rows of four numbers for each normal and four words, without what is not used."""
    rows, size = made.reshape(-1, MADE, 4), interface.size
    words = np.ascontiguousarray(words.reshape(-1, 4)[:, : interface.words])
    code, unpacked, first, target, back, second = np.ascontiguousarray(rows.transpose(1, 0, 2))
    decoded = np.concatenate([first, second], axis=1) if interface.result > first.shape[1] else first
    return Ran(code[:, :size], words, unpacked[:, :size], decoded[:, : interface.result], target, back[:, :size])
