"""The interface of a codec's functions in every language: six functions, and their results for normals and texels."""

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
        prefix: P, the beginning of their names.
        size: the number of components of a code, 1 to 4, including a sign bit.
        sign_bits: 1 if the last component of a code is a sign that is stored elsewhere, else 0.
        words: the number of 32-bit integers in a texel: 1, 2 or 4.
        settings: the places, in the rows `n` and `view`, of the other inputs of both `P_encode` and `P_decode`, such
            as view.xyz.
        tables: the lookup tables by name, float32 of shape (height, width, channels).
        is_ours: whether the file has no text from users.
        value: the places of the input of `P_encode`.
        result: the number of values that `P_decode` returns.
        structure: the type of the input of `P_encode` and the result of `P_decode`, if that is a structure; else
            empty.
        fields: the fields of the structure, in the order of `value`; decoded values are laid out like the input, in
            two rows.
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
        """The macros with which wrapper shaders call the six functions, by name: RUN_ENCODE, RUN_SIZE and others."""
        return self.defines_with(", ".join)

    def defines_with(
        self, listed: Callable[[Sequence[str]], str], construct: str = "{}({})", parts: Parts = lambda path, _: [path]
    ) -> dict[str, object]:
        """Return the macros of `defines` for a language with a different syntax.

        Args:
            listed: (places) -> the inputs as text, instead of a list such as n.xyz, view.x.
            construct: a format for the text of a structure, from its name and its fields.
            parts: (path, size) -> the parts of a decoded value, one after the other.
        """
        value = [construct.format(self.structure, listed(self.value))] if self.structure else [listed(self.value)]
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
        """Return for each of the two rows of a decoded value the (path, size) pairs of its parts."""
        if not self.structure:
            return [[("decoded", self.result)], []]
        rows: dict[str, list[tuple[str, int]]] = {"n": [], "view": []}
        for name, place in zip(self.fields, self.value, strict=True):
            row, _, numbers = place.partition(".")
            rows[row].append((f"decoded.{name}", len(numbers)))
        return list(rows.values())


class Ran(NamedTuple):
    """The results of the six functions.

    Attributes:
        codes: float32 of shape (count, size).
        words: uint32 of shape (count, words).
        unpacked: from `words`; float32 of shape (count, size).
        decoded: from `codes`; float32 of shape (count, result).
        targets: from `codes`; float32 of shape (count, 4).
        from_targets: from the texels of the input; float32 of shape (count, size).
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
    """A runner of files in one language.

    Attributes:
        prepared: (path, interface) -> a context manager that yields a `Run`; the file is compiled once.
        how: returns one line with compiler, version and device.

    Both raise MissingError if a tool is missing, with what to install.
    """

    prepared: Callable[[Path, Interface], AbstractContextManager[Run]]
    how: Callable[[], str]

    def run(self, path: Path, interface: Interface, n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        """Run the functions of a file and return their results.

        Args:
            path: the file; its tables are next to it if the language needs that.
            n, view: the inputs of the functions, as unit normals and view-space positions; float32 of shape (count,
                3 or 4). Only the first three columns of `view` are used.
            texels: the input of `P_from_target`, float32 of shape (count, 4). A sign bit is taken from the code.

        Raises:
            MissingError: a tool is missing; what to install.
            ShaderError: the file does not compile, or it does not run; one line.
            NoDeviceError: there is no OpenGL device, for the languages that need one.
        """
        with self.prepared(Path(path), interface) as run:
            parts = [run(n[block], view[block], texels[block]) for block in blocks(len(n))]
        return Ran(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def blocks(count: int) -> Iterator[slice]:
    """Return slices of at most BLOCK rows that cover `count` rows; one empty slice for 0 rows."""
    return (slice(start, min(start + BLOCK, count)) for start in range(0, max(count, 1), BLOCK))


def rows_of(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> np.ndarray:
    """Return a shader's input: three rows of four numbers for each normal, float32 of shape (GIVEN count, 4).

    The fourth number of a view is 0. Its bits are combined with the words before unpacking, so that a compiler cannot
    see that these are the packed words: Mesa simplifies (a + b) - b to a.
    """
    given = np.zeros((len(n), GIVEN, 4), np.float32)
    given[:, 0, : n.shape[1]], given[:, 1, :3], given[:, 2] = n, view[:, :3], texels
    return given.reshape(-1, 4)


def ran_of(output: np.ndarray, words: np.ndarray, interface: Interface) -> Ran:
    """Return the results of the six functions from a shader's output: six rows of four numbers and four words for
    each value. Unused parts are left out."""
    rows, size = output.reshape(-1, MADE, 4), interface.size
    words = np.ascontiguousarray(words.reshape(-1, 4)[:, : interface.words])
    code, unpacked, first, target, back, second = np.ascontiguousarray(rows.transpose(1, 0, 2))
    decoded = np.concatenate([first, second], axis=1) if interface.result > first.shape[1] else first
    return Ran(code[:, :size], words, unpacked[:, :size], decoded[:, : interface.result], target, back[:, :size])
