"""Values in Python with NumPy: a vector is the last axis of an array."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType

from .builtins import BITS, FETCH, LIKE_GIVEN, OF_VECTORS
from .numpy_helpers import HELPERS
from .parser import COMPARES, SHIFTS
from .texels import Texels
from .tree import (
    MATRICES,
    Binary,
    Call,
    Choice,
    Construct,
    Elements,
    Expression,
    Index,
    Literal,
    Swizzle,
    TranslationError,
    Unary,
    scalar_of,
    size_of,
    vector,
)
from .writer import FIELDS, MIXING, PRIMARY, PUBLIC, UNARY, Writer, least_of, shortest

TYPES: Mapping[str, str] = MappingProxyType(
    {"float": "np.float32", "int": "np.int32", "uint": "np.uint32", "bool": "np.bool_"}
)
# Python's own operators, and how tightly they bind: comparisons least.
OPERATORS: Mapping[str, str] = MappingProxyType({"&&": "&", "||": "|", "^^": "^"})
BINDING: Mapping[str, int] = MappingProxyType(
    {
        **dict.fromkeys(COMPARES, 1),
        "|": 2,
        "^": 3,
        "&": 4,
        "<<": 5,
        ">>": 5,
        "+": 6,
        "-": 6,
        "*": 7,
        "/": 7,
        "//": 7,
        "%": 7,
    }
)
FUNCTIONS: Mapping[str, str] = MappingProxyType(
    {
        **{name: f"np.{name}" for name in ("abs", "sign", "floor", "ceil", "trunc", "sqrt", "exp", "exp2", "log")},
        **{name: f"np.{name}" for name in ("log2", "sin", "cos", "tan")},
        **{name: f"_{name}" for name in ("mix", "step", "smoothstep", "fract", "fma", "dot", "length", "distance")},
        "normalize": "_normalize",
        "cross": "_cross",
        "reflect": "_reflect",
        "min": "np.fmin",
        "max": "np.fmax",
        "clamp": "_clamp",
        "asin": "np.arcsin",
        "acos": "np.arccos",
        "atan": "np.arctan",
        "atan2": "np.arctan2",
        "pow": "np.power",
        "round": "np.rint",
        "roundEven": "np.rint",
    }
)
# Those of vectors that take scalars.
OF_ONE = OF_VECTORS | {"normalize", "reflect"}


class NumpyValues(Writer):
    """What NumpyWriter says of values. Names that nobody else uses begin with an underscore."""

    functions = FUNCTIONS

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        super().__init__(prefix, texels, stem)
        self._helpers: set[str] = set()
        self._public = {f"{prefix}_{name}" for name in PUBLIC}
        # The functions that are told for which normals they are called, and the conditions within the statement that is
        # written under which a value is wanted.
        self._laned: set[str] = set()
        self._under: list[str] = []
        # Structures of which one is taken for some normals and another for the rest.
        self._chosen: set[str] = set()

    def _around(self) -> list[str]:
        """The variables that say for which normals a statement is done."""
        return []

    @contextmanager
    def _where(self, condition: str) -> Iterator[None]:
        """What is written meanwhile is wanted where a condition holds; everywhere if that is empty."""
        before, self._under = self._under, [*self._under, *([condition] if condition else [])]
        yield
        self._under = before

    def _own(self, name: str) -> str:
        """A name of the program's own; what is not for others begins with an underscore."""
        return name if name in self._public else f"_{name}"

    def _helper_name(self, name: str) -> str:
        self._helpers.add(name)
        return name

    def _typed(self, value: Expression, least: int = 0) -> str:
        """A value that has its type: a number that is written out has Python's."""
        if _is_written_out(value):
            return f"{TYPES[value.kind]}({self._text(value)})"
        return self._text(value, least)

    def _wide(self, value: Expression, like: str, least: int = 0) -> str:
        """An operand of vectors or matrices: of a scalar, for each of their components."""
        more = len(inner_shape(like)) - len(inner_shape(value.kind))
        if more <= 0 or _is_written_out(value):
            return self._text(value, least)
        return f"{self._text(value, PRIMARY)}[{', '.join(['...', *['None'] * more])}]"

    def _typed_wide(self, value: Expression, like: str, least: int = 0) -> str:
        """An operand of vectors or matrices that has its type."""
        return self._typed(value) if _is_written_out(value) else self._wide(value, like, least)

    def _text_and_level(self, value: Expression) -> tuple[str, int]:
        match value:
            case Unary(_, mark, inner):
                text = self._text(inner) if _is_written_out(value) else self._typed(inner, UNARY)
                # -2^31 is written as the literal 2^31 of an int already.
                is_least = mark == "-" and text.startswith("-") and _is_written_out(value)
                return text if is_least else f"{'~' if mark == '!' else mark}{text}", UNARY
            case Swizzle(_, inner, names):
                return f"{self._text(inner, PRIMARY)}[..., {_places(names)}]", PRIMARY
            case Index():
                return self._indexed(value), PRIMARY
        return super()._text_and_level(value)

    def _literal(self, value: Literal) -> str:
        if value.kind == "bool":
            return value.text.capitalize()
        if value.kind == "float":
            return shortest(value.text)
        is_octal = value.text[:1] == "0" and value.text.isdigit()
        whole = int(value.text, 8 if is_octal else 0)
        if value.kind == "int" and whole >= 2**31:
            return str(whole - 2**32)
        return str(whole) if is_octal else value.text

    def _indexed(self, value: Index) -> str:
        inner, axes = value.value, inner_shape(value.kind)
        if isinstance(value.at, Literal):
            return f"{self._text(inner, PRIMARY)}[{', '.join(['...', self._text(value.at), *[':'] * len(axes)])}]"
        more = f", {len(axes)}" if axes else ""
        return f"{self._helper_name('_at')}({self._text(inner)}, {self._text(value.at)}{more})"

    def _binary_and_level(self, value: Binary) -> tuple[str, int]:
        left, right, mark = value.left, value.right, value.operator
        if mark == "*" and "mat" in left.kind + right.kind and "float" not in (left.kind, right.kind):
            return self._product(left, right), PRIMARY
        if scalar_of(left.kind) in ("int", "uint") and mark in ("/", "%"):
            return self._division(value)
        if mark in SHIFTS:
            return self._shift(value), BINDING[mark]
        wider = left.kind if len(inner_shape(left.kind)) >= len(inner_shape(right.kind)) else right.kind
        mark = OPERATORS.get(mark, mark)
        level = BINDING[mark]
        # Python chains comparisons: each stands alone.
        first = self._wide(left, wider, least_of(value, left, level + (level == 1)))
        if _is_written_out(left) and _is_written_out(right):
            first = self._typed(left)
        with self._where(self._undecided(value)):
            second = self._wide(right, wider, least_of(value, right, level + 1))
        text = f"{first} {mark} {second}"
        if mark in COMPARES and value.kind == "bool" and (axes := len(inner_shape(wider))):
            last = "-1" if axes == 1 else "(-2, -1)"
            return f"np.{'all' if mark == '==' else 'any'}({text}, axis={last})", PRIMARY
        return text, level

    def _undecided(self, value: Binary) -> str:
        """Where the left one of two truths leaves it to the right one; empty for other operations."""
        negation = {"&&": "", "||": "~"}.get(value.operator)
        return "" if negation is None else negation + self._typed(value.left, PRIMARY)

    def _product(self, left: Expression, right: Expression) -> str:
        if "mat" in left.kind and "mat" in right.kind:
            return f"{self._helper_name('_product')}({self._text(left)}, {self._text(right)})"
        if "mat" in left.kind:
            return f"{self._helper_name('_times')}({self._text(left)}, {self._text(right)})"
        return f"{self._helper_name('_times')}(np.swapaxes({self._text(right)}, -1, -2), {self._text(left)})"

    def _division(self, value: Binary) -> tuple[str, int]:
        """A quotient or a remainder of whole numbers, and how tightly it binds."""
        left, right, mark = value.left, value.right, value.operator
        if scalar_of(left.kind) == "uint" and isinstance(right, Literal) and int(right.text, 0):
            level = BINDING[mark]
            return f"{self._typed(left, level)} {'//' if mark == '/' else '%'} {self._text(right, level + 1)}", level
        name = self._helper_name("_quotient" if mark == "/" else "_remainder")
        return f"{name}({self._typed_wide(left, value.kind)}, {self._typed_wide(right, value.kind)})", PRIMARY

    def _shift(self, value: Binary) -> str:
        """By as many bits as fit: what is more is taken modulo 32."""
        level, right = BINDING[value.operator], value.right
        left = self._typed_wide(value.left, value.kind, level)
        if _is_written_out(right):
            return f"{left} {value.operator} {int(self._text(right), 0) % 32}"
        by = f"({self._wide(right, value.kind, BINDING['&'])} & 31)"
        if scalar_of(right.kind) != scalar_of(value.left.kind):
            by += f".astype({TYPES[scalar_of(value.left.kind)]})"
        return f"{left} {value.operator} {by}"

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        condition = value.condition
        is_broad = size_of(condition.kind) == 1 and inner_shape(value.kind)
        holds = self._typed(condition, PRIMARY)
        text = broad(holds, value.kind) if is_broad else self._typed(condition)
        is_one = size_of(condition.kind) == 1
        with self._where(holds if is_one else ""):
            chosen = self._typed(value.chosen)
        with self._where(f"~{holds}" if is_one else ""):
            other = self._typed(value.other)
        return self._where_text(holds if value.kind in self._structs else text, value.kind, chosen, other), PRIMARY

    def _where_text(self, holds: str, kind: str, chosen: str, other: str) -> str:
        """One value where something holds, for each of its numbers, and another one elsewhere."""
        if kind not in self._structs:
            return f"np.where({holds}, {chosen}, {other})"
        self._chosen.add(kind)
        return f"_chosen_{kind}({holds}, {chosen}, {other})"

    def _call(self, value: Call) -> str:
        name, given = value.name, value.arguments
        if value.is_own:
            texts = [*map(self._typed, given)]
            if name in self._laned and (conditions := [*self._around(), *self._under]):
                texts.append(" & ".join(conditions))
            return f"{self._own(name)}({', '.join(texts)})"
        match name:
            case _ if name == FETCH:
                return f"{self._helper_name('_fetched')}({self._text(given[0])}, {self._text(given[1])})"
            case _ if name in BITS:
                return f"{self._typed(given[0], PRIMARY)}.view({TYPES[BITS[name]]})"
            case "inversesqrt":
                return f"(1.0 / np.sqrt({self._typed(given[0])}))"
            case "transpose":
                return f"np.swapaxes({self._text(given[0])}, -1, -2)"
            case "all" | "any":
                return f"np.{name}({self._text(given[0])}, axis=-1)"
        if name not in FUNCTIONS:
            raise TranslationError(f"{name} is not written in Python")
        called = self.functions[name]
        if name in OF_ONE and size_of(given[0].kind) == 1:
            # A scalar is a vector of one component.
            texts = ", ".join(f"{self._typed(one, PRIMARY)}[..., None]" for one in given)
            return f"{self._helper_name(called)}({texts})" + "[..., 0]" * (name in LIKE_GIVEN)
        like = value.kind if name in MIXING or name in ("pow", "atan2", "fma") else given[0].kind
        # NumPy's own functions take the type from another argument, if one has any.
        is_plain = called in HELPERS or all(map(_is_written_out, given))
        if called in HELPERS:
            self._helper_name(called)
        return f"{called}({', '.join((self._typed_wide if is_plain else self._wide)(one, like) for one in given)})"

    def _construct(self, value: Construct) -> str:
        given, kind = value.arguments, value.kind
        scalar, size = scalar_of(kind), size_of(kind)
        if kind in self._structs:
            return f"{kind}({', '.join(self._typed(one) for one in given)})"
        if kind in MATRICES:
            return f"{self._helper_name('_matrix')}({kind[3]}, {', '.join(self._components(given, scalar))})"
        if size == 1:
            first = given[0] if size_of(given[0].kind) == 1 else Swizzle(scalar_of(given[0].kind), given[0], "x")
            return self._converted(first, scalar)
        if all(map(_is_written_out, given)):
            numbers = [self._text(one) for one in given] * (size if len(given) == 1 else 1)
            return f"np.array([{', '.join(numbers)}], {TYPES[scalar]})"
        if len(given) == 1 and size_of(given[0].kind) == 1:
            return f"{self._helper_name('_splat')}({self._converted(given[0], scalar)}, {size})"
        if len(given) == 1:
            part = given[0]
            if size_of(part.kind) > size:
                part = Swizzle(vector(scalar_of(part.kind), size), part, FIELDS[:size])
            return self._converted(part, scalar)
        return f"{self._helper_name('_vector')}({', '.join(self._components(given, scalar))})"

    def _components(self, given: list[Expression], scalar: str) -> Iterator[str]:
        for one in given:
            text = self._converted(one, scalar)
            yield text if size_of(one.kind) == 1 else f"*{self._helper_name('_parts')}({text})"

    def _converted(self, value: Expression, scalar: str) -> str:
        """A value as numbers of another type."""
        mine = scalar_of(value.kind)
        if mine == scalar:
            return self._typed(value)
        if _is_written_out(value) and mine != "float" and scalar != "bool":
            return f"{TYPES[scalar]}({self._text(value)})"
        if scalar == "bool":
            return f"({self._typed(value, BINDING['|'])} != 0)"
        if mine == "float":
            return f"{self._helper_name(f'_to_{scalar}')}({self._typed(value)})"
        return f"{self._typed(value, PRIMARY)}.astype({TYPES[scalar]})"

    def _elements(self, value: Elements) -> str:
        kind = value.kind.partition("[")[0]
        scalar = TYPES[scalar_of(kind)]
        if all(_numbers(one) for one in value.values):
            rows = [_row_text([self._text(n) for n in _numbers(one)], size_of(kind)) for one in value.values]
            return f"np.array([{self._rows_text(rows)}], {scalar})"
        axes, values = len(inner_shape(kind)), ", ".join(self._typed(one) for one in value.values)
        return (
            f"{self._helper_name('_array')}({axes}, {values})" if axes else f"{self._helper_name('_vector')}({values})"
        )

    def _zero_text(self, kind: str) -> str:
        """What is read before it is assigned to."""
        if kind in self._structs:
            return f"{kind}({', '.join(map(self._zero_text, self._structs[kind].kinds.values()))})"
        scalar = TYPES[scalar_of(kind.partition("[")[0])]
        return f"np.zeros({inner_shape(kind)}, {scalar})" if inner_shape(kind) else f"{scalar}(0)"


def _is_written_out(value: Expression) -> bool:
    """Whether a value is a number of Python's, which has no type of its own. Less than 0, no uint is one: it wraps."""
    if isinstance(value, Unary):
        return value.operator == "-" and value.kind != "uint" and isinstance(value.value, Literal)
    return isinstance(value, Literal)


def _numbers(value: Expression) -> list[Expression]:
    """The numbers that an element of an array is written out as; none where it is computed."""
    given = value.arguments if isinstance(value, Construct) else [value]
    return given if all(map(_is_written_out, given)) and len(given) == size_of(value.kind) else []


def _row_text(numbers: list[str], size: int) -> str:
    return numbers[0] if size == 1 else f"[{', '.join(numbers)}]"


def inner_shape(kind: str) -> tuple[int, ...]:
    """The axes that one value of a type has."""
    kind, _, count = kind.partition("[")
    inner = (int(kind[3]),) * 2 if kind in MATRICES else (size_of(kind),) if size_of(kind) > 1 else ()
    return (int(count.rstrip("]")), *inner) if count else inner


def shape_text(kind: str) -> str:
    """A type in words."""
    return f"{TYPES[scalar_of(kind)].removeprefix('np.')} {str(('...', *inner_shape(kind))).replace(chr(39), '')}"


def broad(mask: str, kind: str) -> str:
    """A condition for each component of a type."""
    axes = len(inner_shape(kind))
    return f"{mask}[{', '.join(['...', *['None'] * axes])}]" if axes else mask


def _places(names: str) -> str:
    """Components by their numbers: one, those from one to another, or a list."""
    places = [FIELDS.index(name) for name in names]
    if len(places) == 1:
        return str(places[0])
    if places == [*range(places[0], places[-1] + 1)]:
        return f"{places[0] or ''}:{places[-1] + 1}"
    return str(places)
