"""A comparison of a codec's code with the catalogue: the file is read again and run, and the results are compared."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from ....encodings.storages.rounding import store_texel
from ..translator.reduce import table_name
from ..translator.tree import Program
from .channels import Channels
from .kinds.table import kind_of
from .reference import Reference, reference, signed
from .run import runner
from .run.interface import Interface, Ran

# How far codes may be apart before they are stored, as languages round sums and roots differently; beside a step of the
# storage, where they lie on two sides of a tie.
CODE = 2.0**-20
# How many of the texels may differ: ties are few where steps are large.
MOST_SHARE = 1e-3
# How far decoded components may be apart, beside this share of the codec's own error there; and how many normals may
# exceed it: those next to where a map is singular.
DECODED, OF_ERROR = 2.0**-19, 1 / 8
MOST_SINGULAR = 5e-3
# As many texels of a user's own encoder may be other ones of the same normals.
MOST_SINGULAR_TEXELS = 0.02
# How much farther off the texel of a search may be, in degrees of normals: two codes that are as near in float32.
SEARCHED = 1e-3
EPSILON = 2.0**-23


@dataclass(frozen=True)
class Agreement:
    """The differences between a file's results and the catalogue's.

    Attributes:
        count: the number of values.
        texels: the number of different texels that the values have in the catalogue.
        differing: the number of values whose texel differs from the catalogue's.
        steps: the largest difference of a number, in steps of the storage, in texels that decode differently.
        are_ties: whether no number differs by more than a step or CODE, whichever is larger.
        share: the share of the texels that may differ.
        worse: the largest error that a differing texel adds when decoded, in `unit`.
        unpacked: the number of equal texels that unpack to numbers other than the catalogue's, plus the number of
            those whose numbers differ when read from the render target.
        targets: the number of equal texels that the render target's own conversion would store differently.
        decoded: the largest difference of a decoded component.
        far: the number of values with a component that differs by more than DECODED and OF_ERROR allow, or is not a
            number.
        searches: whether the encoder takes the best of several codes.
        is_ours: whether the codec is the catalogue's.
        plural: the name of the values, in the plural.
        unit: the unit of their errors.
    """

    count: int
    texels: int
    differing: int
    steps: int
    are_ties: bool
    share: float
    worse: float
    unpacked: int
    targets: int
    decoded: float
    far: int
    searches: bool
    is_ours: bool
    plural: str
    unit: str

    @property
    def holds(self) -> bool:
        """Whether the file agrees with the catalogue, except for ties in rounding, equivalent codes of a search and
        values next to singularities of the map."""
        is_rare = self.differing <= self.share * self.count
        agrees = is_rare or self.worse <= SEARCHED if self.searches else is_rare and self.are_ties
        # Next to a pole a longitude may be any, and the normal is the same.
        is_singular = self.differing <= MOST_SINGULAR_TEXELS * self.count and self.worse <= SEARCHED
        agrees |= is_singular and not self.is_ours
        is_decoded = self.far <= MOST_SINGULAR * self.count
        return agrees and is_decoded and not self.unpacked and not self.targets

    @property
    def _share_text(self) -> str:
        return f"{self.differing} of {self.count} {self.plural}"

    @property
    def says(self) -> str:
        """The agreement in words, for the comment at the head of a file."""
        if not self.differing:
            codes = f"all {self.texels} texels of {self.count} {self.plural} are equal, bit for bit"
        elif self.searches:
            near = "equally accurate" if self.worse <= SEARCHED else f"up to {self.worse:.1g} {self.unit} farther off"
            codes = f"the texels of {self._share_text} differ, {near}: the search finds equivalent codes"
        else:
            steps = f"by at most {self.steps} step{'s' * (self.steps != 1)}"
            how = steps if self.steps else "but decode to the same values"
            codes = f"the texels of {self._share_text} differ, {how}"
        codes += "" if self.are_ties or self.searches else ", which is more than the rounding of ties explains"
        wrong = f"; {self.unpacked} numbers differ when unpacked" if self.unpacked else ""
        wrong += f"; {self.targets} texels of the render target differ" if self.targets else ""
        far = f", {self.far} of them next to singularities of the map" if self.far else ""
        decoded = f"within {self.decoded / EPSILON:.3g} x 2^-23" if self.decoded else "equal"
        return f"{codes}; decoded {self.plural} are {decoded}{far}{wrong}"


def interface_of(codec: Any, prefix: str, program: Program) -> Interface:
    """Return the inputs and outputs of a codec's functions.

    Args:
        codec: a codec of any kind.
        program: the codec's functions, without unused settings.
    """
    parameters = program.function(f"{prefix}_encode").parameters
    names, kinds = ([getattr(parameter, word) for parameter in parameters] for word in ("name", "kind"))
    kind, channels = kind_of(codec), Channels(codec)
    tables = codec.encoding.tables() if hasattr(codec.encoding, "tables") else {}
    return Interface(
        prefix,
        channels.numbers.size,
        channels.numbers.sign_bits,
        channels.words,
        tuple(place for name, place in kind.settings.items() if name in names),
        {table_name(name, prefix, codec.encoding.prefix): table for name, table in tables.items()},
        kind.is_ours(codec),
        kind.given(codec),
        kind.result(codec),
        next((struct.name for struct in program.structs if struct.name in kinds), ""),
        kind.fields,
    )


def agreement(codec: Any, language: str, path: Path, interface: Interface) -> Agreement:
    """Run a file and return its agreement with the catalogue.

    Raises:
        MissingError: the tool that runs the language is not installed.
        ShaderError: the file does not compile or run.
    """
    expected = reference(codec)
    ran = runner(language).run(path, interface, expected.n, expected.view, expected.texels)
    return compared(codec, expected, ran)


def compared(codec: Any, expected: Reference, ran: Ran) -> Agreement:
    """Return the differences between `ran`, the results of a file, and `expected`, the catalogue's."""
    channels = Channels(codec)
    integers = np.stack([channels.bits_in(ran.words, i) for i in range(len(channels.channels))], axis=1)
    apart = np.stack(
        [
            np.abs(signed(c, integers[:, i]) - signed(c, expected.integers[:, i]))
            for i, c in enumerate(channels.channels)
        ],
        axis=1,
    )
    kind = kind_of(codec)
    differs = (ran.words != expected.words).any(axis=1)
    same = ~differs
    given = _given(expected)
    units = kind.units(given)
    every = np.abs(ran.decoded.astype(np.float64) - expected.decoded) / units
    # Two codes may stand for one value: angles of -180 and 180 degrees.
    apart[(every <= DECODED).all(axis=1)] = 0
    off = every[same]
    allowed = DECODED + OF_ERROR * (np.abs(expected.decoded - given) / units).max(axis=1, keepdims=True)[same]
    return Agreement(
        count=len(differs),
        texels=len(np.unique(expected.words, axis=0)),
        differing=int(differs.sum()),
        steps=int(apart.max(initial=0)),
        are_ties=bool(((apart <= 1) | (_numbers_apart(expected, ran) <= CODE)).all()),
        share=MOST_SHARE + max(channels.numbers.storage.levels(i) for i in range(len(channels.channels))) * CODE,
        worse=_worse(codec, expected, ran, differs),
        unpacked=int((ran.unpacked[same] != expected.stored[same]).any(axis=1).sum())
        + int((ran.from_targets != expected.stored)[same].any(axis=1).sum()),
        targets=int(_targets_apart(channels, expected, ran, same)),
        decoded=float(off.max(initial=0.0)),
        far=int((~(off <= allowed)).any(axis=1).sum()),
        searches=kind.searches(codec),
        is_ours=kind.is_ours(codec),
        plural=kind.plural,
        unit=kind.unit,
    )


def _given(expected: Reference) -> np.ndarray:
    """Return the encoded values, laid out like the decoded values; float64 of shape (count, numbers)."""
    return np.concatenate([expected.n, expected.view], axis=1)[:, : expected.decoded.shape[1]].astype(np.float64)


def _numbers_apart(expected: Reference, ran: Ran) -> np.ndarray:
    """Return the distances between the stored numbers of a file and the catalogue, (count, components)."""
    count = expected.integers.shape[1]
    return np.abs(ran.unpacked[:, :count].astype(np.float64) - expected.stored[:, :count])


def _worse(codec: Any, expected: Reference, ran: Ran, differs: np.ndarray) -> float:
    """Return the largest error that differing texels add when decoded, in the kind's unit; 0 if none differ."""
    if not differs.any():
        return 0.0
    errors, given = kind_of(codec).errors, _given(expected)[differs]
    return float((errors(given, ran.decoded[differs]) - errors(given, expected.decoded[differs])).max())


def _targets_apart(channels: Channels, expected: Reference, ran: Ran, same: np.ndarray) -> int:
    """Return the number of texels that the render target's own conversion stores differently than expected, among the
    texels for which `same` is true."""
    target, apart = channels.numbers.target, np.zeros(len(same), bool)
    for index in range(channels.parts or channels.numbers.count):
        stored = np.asarray(store_texel(jnp.asarray(ran.targets[:, index]), target, index))
        apart |= stored != expected.texels[:, index]
    return int((apart & same).sum())
