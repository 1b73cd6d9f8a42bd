"""Whether a codec's code gives what the catalogue gives: the file is read again, run, and compared."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rounding import store_texel
from ...ground.angles import angles_deg
from .channels import WORD, Channels
from .reference import Reference, bytes_turned, reference, signed
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
# How much farther off the texel of a search may be, in degrees: two codes that are as near in float32.
SEARCHED_DEG = 1e-3
EPSILON = 2.0**-23


@dataclass(frozen=True)
class Agreement:
    """How a file's results differ from the catalogue's.

    Attributes:
        count: of normals.
        differing: texels that are not the catalogue's.
        steps: by how many steps of the storage a number differs at most.
        are_ties: whether no number differs by more than a step or CODE, whichever is larger.
        share: how many of the texels may differ.
        worse_deg: how much farther off a texel that differs is decoded, at most.
        unpacked: numbers that do not come back from the texels, or from the render target, as the catalogue's do.
        targets: texels that the render target's own conversion would make other than `pack` does.
        decoded: by how much a decoded component differs at most.
        far: normals of which one differs by more than DECODED and OF_ERROR allow, or is no number.
        searches: whether the encoder takes the best of several codes.
        is_ours: whether it is the catalogue's.
    """

    count: int
    differing: int
    steps: int
    are_ties: bool
    share: float
    worse_deg: float
    unpacked: int
    targets: int
    decoded: float
    far: int
    searches: bool
    is_ours: bool = True

    @property
    def holds(self) -> bool:
        """Whether it is the catalogue's but for ties."""
        is_rare = self.differing <= self.share * self.count
        agrees = is_rare or self.worse_deg <= SEARCHED_DEG if self.searches else is_rare and self.are_ties
        # Next to a pole a longitude may be any, and the normal is the same.
        is_singular = self.differing <= MOST_SINGULAR_TEXELS * self.count and self.worse_deg <= SEARCHED_DEG
        agrees |= is_singular and not self.is_ours
        is_decoded = self.far <= MOST_SINGULAR * self.count
        return agrees and is_decoded and not self.unpacked and not self.targets

    @property
    def says(self) -> str:
        """The agreement in words, as a file's head has it."""
        if not self.differing:
            codes = f"all {self.count} texels are equal, bit for bit"
        elif self.searches:
            near = "as near" if self.worse_deg <= SEARCHED_DEG else f"up to {self.worse_deg:.1g} degrees farther off"
            codes = f"{self.differing} of {self.count} texels differ, {near}: a search finds several codes alike"
        else:
            steps = f"{self.steps} step{'s' * (self.steps != 1)}"
            codes = f"{self.differing} of {self.count} texels differ, by {steps} at most"
        codes += "" if self.are_ties or self.searches else ", which is more than a tie"
        wrong = f"; {self.unpacked} numbers come back otherwise" if self.unpacked else ""
        wrong += f"; {self.targets} texels of the render target differ" if self.targets else ""
        far = f", {self.far} of them next to where the map is singular" if self.far else ""
        decoded = f"within {self.decoded / EPSILON:.3g} x 2^-23" if self.decoded else "equal"
        return f"{codes}; decoded normals are {decoded}{far}{wrong}"


def is_catalogues(encoding: Encoding) -> bool:
    """Whether an encoding is the catalogue's, or a variant of one."""
    return encoding.name.partition(":")[0] in ENCODINGS


def interface_of(codec: Codec, prefix: str, takes_view: bool) -> Interface:
    """What the functions of a codec's code are called with."""
    encoding = codec.encoding
    size = encoding.components + encoding.sign_bits
    tables = {f"{prefix}_{name}": table for name, table in encoding.tables().items()}
    return Interface(
        prefix, size, encoding.sign_bits, Channels(codec).words, takes_view, tables, is_catalogues(encoding)
    )


def agreement(codec: Codec, language: str, path: Path, interface: Interface) -> Agreement:
    """Run a file and compare it.

    Raises:
        MissingError: what runs the language is not installed.
        ShaderError: the file does not compile or run.
    """
    expected = reference(codec)
    ran = runner(language).run(path, interface, expected.n, expected.view, expected.texels)
    return compared(codec, expected, ran)


def compared(codec: Codec, expected: Reference, ran: Ran) -> Agreement:
    """How the results of a file differ from the catalogue's."""
    channels = Channels(codec)
    found = np.stack([_bits(channels, at, ran.words) for at in range(len(channels.channels))], axis=1)
    apart = np.stack(
        [
            np.abs(signed(c, found[:, at]) - signed(c, expected.integers[:, at]))
            for at, c in enumerate(channels.channels)
        ],
        axis=1,
    )
    differs = (ran.words != expected.words).any(axis=1)
    same = ~differs
    off = np.abs(ran.decoded.astype(np.float64) - expected.decoded)[same]
    allowed = DECODED + OF_ERROR * np.abs(expected.decoded - expected.n).max(axis=1, keepdims=True)[same]
    return Agreement(
        count=len(differs),
        differing=int(differs.sum()),
        steps=int(apart.max(initial=0)),
        are_ties=bool(((apart <= 1) | (_numbers_apart(expected, ran) <= CODE)).all()),
        share=MOST_SHARE + max(codec.storage.levels(at) for at in range(len(channels.channels))) * CODE,
        worse_deg=_worse(expected, ran, differs),
        unpacked=int((ran.unpacked[same] != expected.stored[same]).any(axis=1).sum())
        + int((ran.from_targets != expected.stored)[same].any(axis=1).sum()),
        targets=int(_targets_apart(codec, expected, ran, same)),
        decoded=float(off.max(initial=0.0)),
        far=int((~(off <= allowed)).any(axis=1).sum()),
        searches=codec.encoding.searches or codec.encoding.is_precise,
        is_ours=is_catalogues(codec.encoding),
    )


def _numbers_apart(expected: Reference, ran: Ran) -> np.ndarray:
    """How far the stored numbers of two texels are apart, (count, components)."""
    count = expected.integers.shape[1]
    return np.abs(ran.unpacked[:, :count].astype(np.float64) - expected.stored[:, :count])


def _worse(expected: Reference, ran: Ran, differs: np.ndarray) -> float:
    """How much farther off the decoded normals of other texels are, at most, in degrees."""
    if not differs.any():
        return 0.0
    ours = angles_deg(expected.n[differs], ran.decoded[differs])
    return float((ours - angles_deg(expected.n[differs], expected.decoded[differs])).max())


def _targets_apart(codec: Codec, expected: Reference, ran: Ran, same: np.ndarray) -> int:
    """Texels of the render target, as its own conversion stores them, that are not the expected ones."""
    target, apart = codec.storage.target, np.zeros(len(same), bool)
    count = Channels(codec).bytes if codec.storage.is_packed else codec.encoding.components
    for at in range(count):
        stored = np.asarray(store_texel(jnp.asarray(ran.targets[:, at]), target, at))
        apart |= stored != expected.texels[:, at]
    return int((apart & same).sum())


def _bits(channels: Channels, at: int, words: np.ndarray) -> np.ndarray:
    """The bits of a number in texels, uint32 of shape (count,)."""
    channel = channels.channels[at]
    bits = bytes_turned(words, channels.bytes) if channel.is_across else words
    word = bits[:, channel.first // WORD]
    return word >> np.uint32(channel.first % WORD) & np.uint32((1 << channel.bits) - 1)
