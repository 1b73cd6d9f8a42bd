"""The definition of an encoding: a pair of maps between unit normals and a few numbers, in JAX and in GLSL."""

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
    """A tunable parameter of an encoding, which `encode` and `decode` both take as a keyword argument.

    Attributes:
        name: the keyword, and the name on the command line.
        constant: its GLSL macro, whose value in `constants` is the published value.
        least, most: its minimum and maximum.
    """

    name: str
    constant: str
    least: float
    most: float


@dataclass(frozen=True)
class LookUp:
    """A replaceable lookup table of an encoding, which `encode` takes as the keyword argument `table`.

    Attributes:
        sampler: its key in `tables`.
        levels: numbers of values, evenly spaced and the same for all components of the code, for which the table can
            be fitted to a storage.
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
    """A pair of maps between normals and codes, in JAX and, in the file next to it, in GLSL.

    The GLSL file defines `<name>_encode(vec3 n, vec3 view)` and `<name>_decode(code, vec3 view)`; the code is a
    vec2 or vec3 of `components + sign_bits` numbers.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (n, view) -> code, unit normal to numbers in [-1, 1] on its domain. `view` is the view-space
            position.
        decode: (code, view) -> normal, not renormalised unless the method does so.
        components: number of components that are stored with the storage's precision.
        domain: the normals that it can represent: "sphere", "hemisphere" (z >= 0) or "view" (facing the viewer).
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed differences between the two languages before storage, of encode and decode, in 2^-23 (a unit in
            the last place of 1), times the change of the map's result per unit of its input if that is more than 1.
        ulps_reason: reason for these numbers.
        sign_bits: number of additional components that are 1 or -1 and take one bit, stored in the sign of the depth.
        constants: numbers that both languages need, by GLSL name.
        derived: function that returns additional constants computed from `constants`.
        levels: number of values that each component may have, evenly spaced from -1 to 1; 0 for an ordinary number.
            Empty if all components are ordinary numbers.
        is_precise: whether each component is rounded down or up so that the code decodes nearest to the normal.
        searches: whether the encoder takes the best of several codes; if two are equally good, the languages may
            choose differently.
        tables: function that returns the lookup tables by GLSL sampler name, float32 arrays of shape (height, width,
            channels).
        functions: prefix of the GLSL functions, for a variant that shares another encoding's file.
        parameters: the constants that can be changed.
        look_up: the table that can be changed.
        axis: the axis of a normal that serves as z, a key of AXES.
        sign: 1, or -1 if the opposite direction is encoded.
        is_half: whether every step of encode and decode is rounded to a 16-bit float; codes are of that type.
        source: the user's file from which its GLSL was translated; None if the GLSL was not translated.
        before: the codec that normals pass through before they are encoded; None if there is no such codec.
        is_unit: whether its author's functions take and return numbers u in [0, 1], with c = 2 u - 1; every storage
            then holds u.
        packed_bits: number of bits used in a code that its author's functions pack into one 32-bit integer, which is
            stored unchanged; the code's two numbers are the halves of this integer. 0 for any other code.
        declares_half: whether its author's functions use 16-bit numbers.
        own: the same encoding in its author's axes, if it encodes a hemisphere other than z >= 0 and is therefore
            rotated for tables; otherwise None.
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
        """Whether the code is a single 32-bit integer, which is stored unchanged."""
        return self.packed_bits > 0

    @property
    def is_also_half(self) -> bool:
        """Whether the encoding is also measured in half arithmetic if the user selects no arithmetic."""
        return self.declares_half and not self.is_packed and not self.is_half

    @property
    def twin(self) -> Path:
        """The path of the Python file that accompanies a user's encoding."""
        return (self.source or self.glsl).with_suffix(".py")

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions."""
        return self.functions or self.name

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of the encoder and the decoder, without semicolons."""
        code = f"vec{self.components + self.sign_bits}"
        return (
            f"{code} {self.prefix}_encode(vec3 n, vec3 view)",
            f"vec3 {self.prefix}_decode({code} e, vec3 view)",
        )

    @cached_property
    def fingerprint(self) -> str:
        """A hash of 16 hex digits over the files, constants and tables. Raises OSError if a file cannot be read."""
        code = (self.prefix, self.components, self.sign_bits, self.levels, self.is_precise)
        code = (*code, self.axis, self.sign, self.is_half)
        if self.before:
            code = (*code, self.before.name, self.before.encoding.fingerprint)
        return fingerprint(self.glsl, (code, sorted(self.constants.items())), self.tables(), self.twin)

    def levels_of(self, component: int) -> int:
        """Return how many values a component of the code can have; 0 for an ordinary number, 2 for a sign bit."""
        if component >= self.components:
            return 2
        return self.levels[component] if self.levels else 0

    @property
    def has_tables(self) -> bool:
        """Whether it reads look-up tables."""
        return self.tables is not dict

    @property
    def reach_deg(self) -> float:
        """The largest angle, in degrees, between a normal and the line of sight, for the domain "view"."""
        return self.published.get("cap", 90.0)

    @property
    def can_turn(self) -> bool:
        """Whether the axis and sign can be changed: the domain is the sphere, and no bit is stored in the depth."""
        return self.domain == "sphere" and not self.sign_bits

    @property
    def is_turned(self) -> bool:
        """Whether the axis or the sign differs from that of the encoding's files."""
        return (self.axis, self.sign) != ("z", 1)

    @property
    def is_exact(self) -> bool:
        """Whether the maps are defined on real numbers, so that only the storage rounds."""
        return not self.is_half and self.before is None

    @property
    def published(self) -> dict[str, float]:
        """The published values of the parameters, by name."""
        return {p.name: float(self.constants[p.constant]) for p in self.parameters}  # type: ignore[arg-type]

    def with_parameters(self, values: Mapping[str, float]) -> Encoding:
        """Return the encoding with new values for some parameters, in both languages; its name contains them."""
        macros = {p.constant: values[p.name] for p in self.parameters if p.name in values}
        suffix = "".join(f":{name}={value:.9g}" for name, value in values.items())
        encoding = replace(self, constants={**self.constants, **macros})
        return encoding._variant(suffix, **values)

    def turned(self, axis: str, sign: int, suffix: str = "") -> Encoding:
        """Return the encoding of directions in different axes, in both languages, with `suffix` appended to its name.

        Args:
            axis: the axis of a normal that becomes its z, a key of AXES.
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
        """Return the encoding of normals that have passed through another codec, as when a G-buffer is decoded,
        renormalised and encoded again.

        Args:
            before: the `Codec` that normals pass through first.
        """
        encode = self.encode

        def encode_again(n: Vec3, view: Vec3) -> Any:
            return encode(unit(before.round_trip(n, view)), view)

        domain = before.encoding.domain if self.domain == "sphere" else self.domain
        title = f"{self.title}, of normals from {before.name}"
        named = {"name": f"{before.name}+{self.name}", "title": title, "functions": self.prefix, "domain": domain}
        return replace(self, encode=encode_again, before=before, **named)

    def with_table(self, table: Float[Array | np.ndarray, "height width channels"], table_name: str) -> Encoding:
        """Return the encoding with a different lookup table, named `table_name`; float32, of the published table's
        shape."""
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
