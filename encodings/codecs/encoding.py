"""The definition of an encoding: a pair of maps between unit normals and a few numbers, written twice."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from ..kinds import NORMAL, Kind
from ..vec import Vec2, Vec3, jnp, unit
from .fingerprint import fingerprint

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Array, Float

Code = Vec2 | Vec3

# The pole of an encoding is its z. For another axis there: the components in another order, and the order back.
AXES: Mapping[str, tuple[str, str]] = MappingProxyType({"x": ("yzx", "zxy"), "y": ("zxy", "yzx"), "z": ("xyz", "xyz")})


@dataclass(frozen=True)
class Parameter:
    """A number of an encoding that can be changed: `encode` and `decode` both take it by its name.

    Attributes:
        name: the keyword, and the name on the command line.
        constant: its GLSL macro; its value in `constants` is the published one.
        least, most: its range.
    """

    name: str
    constant: str
    least: float
    most: float


@dataclass(frozen=True)
class LookUp:
    """A lookup table of an encoding that can be changed: `encode` takes it by the keyword `table`.

    Attributes:
        sampler: its key in `tables`.
        levels: how many values each number of the code may have in a storage for which the table can be fitted;
            evenly spread, the same for every number.
        fit: (normals, levels, prior) -> the table with the smallest squared error on the normals. Normals are
            float64 of shape (count, 3); `prior` is the number of normals that the centre of a texel counts as.
    """

    sampler: str
    levels: range
    fit: Callable[[Any, Any, float], Any]


def _none(_: Mapping[str, Any]) -> Mapping[str, float]:
    return {}


@dataclass(frozen=True, eq=False)
class Encoding:
    """A pair of maps between normals and codes, in JAX here and in GLSL in the file next to it.

    The GLSL file defines `<name>_encode(vec3 n, vec3 view)` and `<name>_decode(code, vec3 view)`; the code is a
    vec2 or vec3 of `components + sign_bits` numbers.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (n, view) -> code, unit normal to numbers in [-1, 1] on its domain. `view` is the view-space
            position.
        decode: (code, view) -> normal, not renormalised unless the method does so.
        components: number of components that are stored with the storage's precision.
        domain: the normals that it can hold: "sphere", "hemisphere" (z >= 0) or "view" (facing the viewer).
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed difference between the two languages before storage, encode and decode, in 2^-23 (a unit in
            the last place of 1), times the change of the map's result per unit of its input where that is more than
            one.
        ulps_reason: reason for these numbers.
        sign_bits: number of additional components that are 1 or -1 and take one bit, stored in the sign of the depth.
        constants: numbers that both languages need, by their GLSL name.
        derived: additional constants that follow from these.
        levels: how many values each component may have, evenly spread from -1 to 1; 0, or no levels at all, for an
            ordinary number.
        is_precise: whether the code that decodes nearest is stored, among those with every component rounded down
            or up.
        searches: whether the encoder takes the best of several codes; if two are equally good the languages may
            differ.
        tables: function that returns the lookup tables by GLSL sampler name, float32 arrays of shape (height, width,
            channels).
        functions: prefix of its GLSL functions, for a variant that shares another encoding's file.
        parameters: the constants that may have other values.
        look_up: the table that can be changed.
        axis: which axis of a normal is its z, a key of AXES.
        sign: 1, or -1 if the opposite of a normal is encoded.
        is_half: whether every step of encode and decode is rounded to a 16-bit float; codes are of that type.
        source: the user's file from which its GLSL was translated; None if the GLSL was written.
        before: the codec that normals have passed through before they are encoded; None if they have not.
        is_unit: whether its author's functions take and return numbers in [0, 1], u for c = 2 u - 1: every storage
            holds u.
        packed_bits: number of bits used in a code that is one integer of 32 bits as its author's functions make it:
            its two numbers are the halves, and it is stored unchanged. 0 for any other code.
        declares_half: whether its author's functions use 16-bit numbers.
        own: the same encoding in its author's axes, for a code of another hemisphere than z >= 0, which tables turn.
    """

    kind: ClassVar[Kind] = NORMAL
    name: str
    title: str
    encode: Callable[[Vec3, Vec3], Any]
    decode: Callable[[Any, Vec3], Vec3]
    components: int
    domain: str
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    sign_bits: int = 0
    levels: tuple[int, ...] = ()
    is_precise: bool = False
    searches: bool = False
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    derived: Callable[[Mapping[str, Any]], Mapping[str, float]] = _none
    tables: Callable[[], Mapping[str, Any]] = dict
    functions: str = ""
    parameters: tuple[Parameter, ...] = ()
    look_up: LookUp | None = None
    axis: str = "z"
    sign: int = 1
    is_half: bool = False
    source: Path | None = None
    before: Any = None
    is_unit: bool = False
    packed_bits: int = 0
    declares_half: bool = False
    own: Encoding | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "constants", {**self.constants, **self.derived(self.constants)})

    @property
    def is_packed(self) -> bool:
        """Whether its code is one 32-bit integer, which is stored unchanged."""
        return self.packed_bits > 0

    @property
    def is_also_half(self) -> bool:
        """Whether it is also measured in half arithmetic if the user selects no arithmetic."""
        return self.declares_half and not self.is_packed and not self.is_half

    @property
    def twin(self) -> Path:
        """The path of the Python half of a user's encoding."""
        return (self.source or self.glsl).with_suffix(".py")

    @property
    def prefix(self) -> str:
        """The prefix of the names of its GLSL functions."""
        return self.functions or self.name

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of its encoder and its decoder, without the semicolon."""
        code = f"vec{self.components + self.sign_bits}"
        return (
            f"{code} {self.prefix}_encode(vec3 n, vec3 view)",
            f"vec3 {self.prefix}_decode({code} e, vec3 view)",
        )

    @cached_property
    def fingerprint(self) -> str:
        """16 hex digits that change with its files, constants and tables. Raises OSError where one cannot be read."""
        code = (self.prefix, self.components, self.sign_bits, self.levels, self.is_precise)
        code = (*code, self.axis, self.sign, self.is_half)
        if self.before:
            code = (*code, self.before.name, self.before.encoding.fingerprint)
        return fingerprint(self.glsl, (code, sorted(self.constants.items())), self.tables(), self.twin)

    def levels_of(self, component: int) -> int:
        """Return how many values a number of its code has; 0 for an ordinary number, 2 for a sign bit."""
        if component >= self.components:
            return 2
        return self.levels[component] if self.levels else 0

    @property
    def has_tables(self) -> bool:
        """Whether it reads look-up tables."""
        return self.tables is not dict

    @property
    def reach_deg(self) -> float:
        """The largest angle, in degrees, between a normal and the line of sight, if its domain is "view"."""
        return self.published.get("cap", 90.0)

    @property
    def can_turn(self) -> bool:
        """Whether it may have another axis or sign: it holds every direction, and no part of it is in a depth."""
        return self.domain == "sphere" and not self.sign_bits

    @property
    def is_turned(self) -> bool:
        """Whether it has another axis or sign than its files."""
        return (self.axis, self.sign) != ("z", 1)

    @property
    def is_exact(self) -> bool:
        """Whether its maps are on real numbers, which only the storage rounds."""
        return not self.is_half and self.before is None

    @property
    def published(self) -> dict[str, float]:
        """The values of its parameters by their names, as published."""
        return {p.name: float(self.constants[p.constant]) for p in self.parameters}  # type: ignore[arg-type]

    def with_parameters(self, values: Mapping[str, float]) -> Encoding:
        """Return the encoding with other values of some parameters, in both languages; its name states the values."""
        macros = {p.constant: values[p.name] for p in self.parameters if p.name in values}
        suffix = "".join(f":{name}={value:.9g}" for name, value in values.items())
        encoding = replace(self, constants={**self.constants, **macros})
        return encoding._variant(suffix, **values)

    def turned(self, axis: str, sign: int, suffix: str = "") -> Encoding:
        """Return the encoding of directions in other axes, in both languages, with `suffix` appended to its name.

        Args:
            axis: which axis of a normal becomes its z, a key of AXES.
            sign: -1 to encode the opposite direction.
        """
        order, back = AXES[axis]
        encode, decode = self.encode, self.decode

        def turned_encode(n: Vec3, view: Vec3) -> Any:
            return encode(_reordered_axes(n, order) * sign, _reordered_axes(view, order) * sign)

        def turned_decode(e: Any, view: Vec3) -> Vec3:
            return _reordered_axes(decode(e, _reordered_axes(view, order) * sign), back) * sign

        encoding = replace(self, encode=turned_encode, decode=turned_decode, axis=axis, sign=sign)
        return encoding._variant(suffix)

    def in_half(self, suffix: str) -> Encoding:
        """Return the encoding computed in 16-bit floats by the same functions, with `suffix` appended to its name."""
        encode, decode = self.encode, self.decode

        def half_encode(n: Vec3, view: Vec3) -> Any:
            code = encode(_as_dtype(n, jnp.float16), _as_dtype(view, jnp.float16))
            return _as_dtype(code, jnp.float16)

        def half_decode(e: Any, view: Vec3) -> Vec3:
            return _as_dtype(decode(_as_dtype(e, jnp.float16), _as_dtype(view, jnp.float16)), view.z.dtype)

        return replace(self, encode=half_encode, decode=half_decode, is_half=True)._variant(suffix)

    def behind(self, before: Any) -> Encoding:
        """Return the encoding of another codec's normals: of a G-buffer that is decoded, renormalised and encoded
        again.

        Args:
            before: the `Codec` that normals have passed through.
        """
        encode = self.encode

        def encode_again(n: Vec3, view: Vec3) -> Any:
            return encode(unit(before.round_trip(n, view)), view)

        domain = before.encoding.domain if self.domain == "sphere" else self.domain
        title = f"{self.title}, of normals from {before.name}"
        named = {"name": f"{before.name}+{self.name}", "title": title, "functions": self.prefix, "domain": domain}
        return replace(self, encode=encode_again, before=before, **named)

    def with_table(self, table: Float[Array | np.ndarray, "height width channels"], table_name: str) -> Encoding:
        """Return the encoding with another lookup table, named `table_name`, float32 of the published table's shape."""
        assert self.look_up
        tables = {**self.tables(), self.look_up.sampler: table}
        encoding = replace(self, tables=lambda: tables)._variant(f":table={table_name}")
        encode: Callable[..., Any] = self.encode
        return replace(encoding, encode=partial(encode, table=table))

    def _variant(self, suffix: str, **values: float) -> Encoding:
        encode, decode = (partial(function, **values) for function in (self.encode, self.decode))
        name = self.name + suffix
        title = f"{self.title}, {suffix.removeprefix(':').replace(':', ', ')}" if suffix else self.title
        return replace(self, name=name, title=title, encode=encode, decode=decode, functions=self.prefix)


def _as_dtype(v: Any, dtype: Any) -> Any:
    return type(v)(*(jnp.asarray(c, dtype) for c in v))


def _reordered_axes(v: Vec3, order: str) -> Vec3:
    return Vec3(*(getattr(v, axis) for axis in order))
