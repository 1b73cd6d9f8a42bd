"""Small programs in four shading languages, made from seeds: scopes, shadows, arrays, structures, loops, integers.

Each program has `mine_encode` and `mine_decode`, uses only features that its language defines, and computes bounded
numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

# Types by the names that programs here know them by: F, I, B, V (of two floats) and W (of three).
GLSL_TYPES = {"F": "float", "I": "int", "B": "bool", "V": "vec2", "W": "vec3"}
HLSL_TYPES = {"F": "float", "I": "int", "B": "bool", "V": "float2", "W": "float3"}
WGSL_TYPES = {"F": "f32", "I": "i32", "B": "bool", "V": "vec2f", "W": "vec3f"}
USUAL = ("a", "b", "k", "s", "w", "x1", "sum", "t1", "t2", "parts", "is_first", "r_", "K0", "helper")
# Words of the other languages, and of writers.
ODD = {
    "glsl": ("lerp", "frac", "float2", "select", "fn", "rsqrt", "saturate", "mul", "y0", "near", "var", "register"),
    "hlsl": ("mix", "fract", "vec2", "mod", "inversesqrt", "let", "fn", "near", "y1", "gl", "input", "buffer_"),
    "wgsl": ("out", "image", "buffer", "input", "sample", "texture", "double", "int", "float", "lerp", "vec", "main"),
}
ODD["slang"] = ODD["hlsl"]
CONSTANTS = 2


@dataclass
class Scope:
    """The variables of a block by name: the type, and whether the variable can be assigned to."""

    names: dict[str, tuple[str, bool]] = field(default_factory=dict)


class Program:
    """A program in one language.

    Args:
        language: glsl, hlsl, slang or wgsl.
        seed: determines everything else.
    """

    def __init__(self, language: str, seed: int):
        self.language, self.rng = language, np.random.default_rng(seed)
        self.types = {"glsl": GLSL_TYPES, "wgsl": WGSL_TYPES}.get(language, HLSL_TYPES)
        self.names = (*USUAL, *ODD[language])
        self.scopes = [Scope()]
        self.functions: list[tuple[str, list[str], str]] = []
        self.depth = 0
        self.loops = 0
        self.has_normal = False
        self.has_struct = self.chance(0.3)
        self.tables: list[tuple[str, int]] = []

    # Choices.

    def one(self, *of: str) -> str:
        return of[self.rng.integers(len(of))]

    def chance(self, share: float) -> bool:
        return self.rng.random() < share

    def number(self) -> str:
        return str(self.rng.integers(-16, 17) / 8)

    def known(self, kind: str, is_changed: bool = False) -> list[str]:
        """Return the visible variables of a type."""
        variables: dict[str, tuple[str, bool]] = {}
        for scope in self.scopes:
            variables |= scope.names
        return [name for name, (sort, changes) in variables.items() if sort == kind and (changes or not is_changed)]

    # Expressions.

    def value(self, kind: str, depth: int = 0) -> str:
        """Return an expression of a type."""
        ways: list[Callable[[int], str]] = getattr(self, f"_{kind}")()
        if depth > 3:
            return self._leaf(kind)
        return ways[self.rng.integers(len(ways))](depth + 1)

    def _leaf(self, kind: str) -> str:
        names = self.known(kind)
        if names and self.chance(0.7):
            return self.one(*names)
        return {
            "F": lambda: f"({self.number()})",
            "I": lambda: f"({self.rng.integers(-5, 9)})",
            "B": lambda: self.one("true", "false"),
            "V": lambda: f"{self.types['V']}({self.number()}, {self.number()})",
        }[kind]()

    def _F(self) -> list[Callable[[int], str]]:  # noqa: N802 (of a type)
        v = self.value
        choices = [
            lambda _: self._leaf("F"),
            lambda d: f"({v('F', d)} {self.one('+', '-', '*')} {v('F', d)})",
            lambda d: f"{self.one('abs', 'floor', 'ceil')}({v('F', d)})",
            lambda d: f"sqrt(abs({v('F', d)}))",
            lambda d: f"{self.one('min', 'max')}({v('F', d)}, {v('F', d)})",
            lambda d: f"clamp({v('F', d)}, -2.0, 2.0)",
            lambda d: f"{self.types['F']}({v('I', d)})",
            lambda d: f"{v('V', d) if self.language != 'hlsl' else self._leaf('V')}.{self.one('x', 'y')}",
            lambda d: f"dot({v('V', d)}, {v('V', d)})",
            lambda d: self.chosen("F", d),
            self.remainder,
        ]
        if self.tables:
            choices.append(self.element)
        if self.known("S"):
            choices.append(lambda _: f"{self.one(*self.known('S'))}.{self.one('a', 'b.x', 'b.y')}")
        if self.functions:
            choices.append(lambda d: self.called("F", d))
        return choices

    def _I(self) -> list[Callable[[int], str]]:  # noqa: N802 (of a type)
        v = self.value
        choices = [
            lambda _: self._leaf("I"),
            lambda d: f"({v('I', d)} {self.one('+', '-')} {v('I', d)})",
            lambda d: f"({v('I', d)} & {self.rng.integers(1, 15)})",
            lambda d: f"{self.types['I']}(floor(clamp({v('F', d)}, -9.0, 9.0) * 4.0))",
            lambda d: self.chosen("I", d),
            lambda d: f"{self.one('min', 'max')}({v('I', d)}, {v('I', d)})",
            self.shifted,
        ]
        # WGSL alone defines the remainders of negative numbers whose signs differ.
        inner = "({})" if self.language == "wgsl" else "abs({})"
        choices.append(lambda d: f"({inner.format(v('I', d))} {self.one('%', '/')} {self.rng.integers(2, 7)})")
        return choices

    def shifted(self, depth: int) -> str:
        by = self.rng.integers(1, 4)
        return f"(({self.value('I', depth)} & 31) {self.one('<<', '>>')} {by}{'u' * (self.language == 'wgsl')})"

    def _B(self) -> list[Callable[[int], str]]:  # noqa: N802 (of a type)
        v = self.value
        choices = [
            lambda d: f"({v('F', d)} {self.one('<', '>', '<=', '>=')} {v('F', d)})",
            lambda d: f"({v('I', d)} {self.one('==', '!=', '<')} {v('I', d)})",
            lambda d: f"!{v('B', d)}",
            lambda d: f"({v('B', d)} {self.one('&&', '||')} {v('B', d)})",
            lambda d: f"{self.one('any', 'all')}({self.truths(d)})",
        ]
        if self.language == "glsl":
            choices.append(lambda d: f"(floor({v('V', d)}) {self.one('==', '!=')} floor({v('V', d)}))")
        if self.language == "wgsl":
            choices.append(lambda d: f"({v('B', d)} {self.one('&', '|')} {v('B', d)})")
        return choices

    def truths(self, depth: int) -> str:
        """Return an expression with one truth value for each component."""
        a, b = self.value("V", depth), self.value("V", depth)
        return f"lessThan({a}, {b})" if self.language == "glsl" else f"({a} < {b})"

    def _V(self) -> list[Callable[[int], str]]:  # noqa: N802 (of a type)
        v = self.value
        choices = [
            lambda _: self._leaf("V"),
            lambda d: f"{self.types['V']}({v('F', d)}, {v('F', d)})",
            lambda d: f"({v('V', d)} {self.one('+', '-', '*')} {v('V', d)})",
            lambda d: f"({v('V', d)} * {v('F', d)})",
            lambda d: f"({v('V', d)}).yx",
            lambda d: f"{self.one('abs', 'floor')}({v('V', d)})",
            lambda d: f"{self.one('min', 'max')}({v('V', d)}, {v('V', d)})",
            lambda _: f"n.{self.one('xy', 'yz', 'zx', 'xx')}" if self.has_normal else self._leaf("V"),
            self.chosen_by_parts,
        ]
        if self.known("S"):
            choices.append(lambda _: f"{self.one(*self.known('S'))}.{self.one('b', 'b.yx')}")
        if self.functions:
            choices.append(lambda d: self.called("V", d))
        return choices

    def chosen(self, kind: str, depth: int) -> str:
        condition, a, b = self.value("B", depth), self.value(kind, depth), self.value(kind, depth)
        return f"select({b}, {a}, {condition})" if self.language == "wgsl" else f"({condition} ? {a} : {b})"

    def chosen_by_parts(self, depth: int) -> str:
        a, b, condition = self.value("V", depth), self.value("V", depth), self.truths(depth)
        if self.language == "glsl":
            return f"mix({a}, {b}, {condition})"
        return f"select({a}, {b}, {condition})" if self.language in ("wgsl", "slang") else f"({condition} ? {b} : {a})"

    def remainder(self, depth: int) -> str:
        a, by = self.value("F", depth), self.one("0.75", "1.5", "2.0")
        return {"glsl": f"mod({a}, {by})", "wgsl": f"({a} % {by})"}.get(self.language, f"fmod({a}, {by})")

    def element(self, depth: int) -> str:
        name, count = self.tables[self.rng.integers(len(self.tables))]
        return f"{name}[{self.value('I', depth)} & {count - 1}]"

    def called(self, kind: str, depth: int) -> str:
        of_kind = [sig for sig in self.functions if sig[2] == kind and not any(sig[0] in s.names for s in self.scopes)]
        if not of_kind or depth > 2:
            return self._leaf(kind)
        name, given, _ = of_kind[self.rng.integers(len(of_kind))]
        return f"{name}({', '.join(self.value(parameter, depth + 1) for parameter in given)})"

    # Statements.

    def bounded(self, kind: str) -> str:
        """Return an expression whose value stays small."""
        value = self.value(kind)
        if kind == "F":
            return f"clamp({value}, -3.0, 3.0)"
        if kind == "I":
            return f"clamp({value}, -99, 99)"
        if kind == "V":
            low, high = (f"{self.types['V']}({end}, {end})" for end in ("-3.0", "3.0"))
            return f"clamp({value}, {low}, {high})"
        return value

    def declare(self, kind: str, value: str | None = None, is_changed: bool = True) -> str:
        """Return the declaration of a variable, with a new name or a name that hides another."""
        value = value or self.bounded(kind)
        here = self.scopes[-1].names
        free = [name for name in self.names if name not in here]
        if not free:
            return ""
        name = self.one(*free)
        here[name] = (kind, is_changed)
        if self.language == "wgsl":
            return f"{'var' if is_changed else 'let'} {name} = {value};"
        return f"{'' if is_changed else 'const '}{self.types[kind]} {name} = {value};"

    def block(self, count: int) -> str:
        self.scopes.append(Scope())
        self.depth += 1
        text = " ".join(self.statement() for _ in range(count))
        self.depth -= 1
        self.scopes.pop()
        return f"{{ {text} }}"

    def statement(self) -> str:
        deep = self.depth > 3
        ways = [
            lambda: self.declare(self.one("F", "I", "V", "B")),
            lambda: self.declare(self.one("F", "V"), is_changed=self.language != "wgsl"),
            self.assign,
            self.assign,
            self.assign_part,
        ]
        if not deep:
            ways += [self.choice, self.loop, self.halving, lambda: self.block(2), self.array]
        if self.has_struct:
            ways += [self.structure, self.assign_field]
        return ways[self.rng.integers(len(ways))]()

    def structure(self) -> str:
        """Return the declaration of a structure variable, which may hide another in an outer block."""
        self.loops += 1
        name = self.one(f"q{self.loops}", "q0")
        if name in self.scopes[-1].names:
            return ""
        given = f"{self.bounded('F')}, {self.bounded('V')}"
        self.scopes[-1].names[name] = ("S", True)
        if self.language == "wgsl":
            return f"var {name} = Pair({given});"
        return f"Pair {name} = {f'Pair({given})' if self.language == 'glsl' else f'{{ {given} }}'};"

    def assign_field(self) -> str:
        names = self.known("S", is_changed=True)
        if not names:
            return self.structure()
        name = self.one(*names)
        field, kind = self.rng.choice([("a", "F"), ("b", "V"), ("b.x", "F")])
        return f"{name}.{field} = {self.bounded(str(kind))};"

    def assign(self) -> str:
        kind = self.one("F", "I", "V")
        names = self.known(kind, is_changed=True)
        if not names:
            return self.declare(kind)
        return f"{self.one(*names)} = {self.bounded(kind)};"

    def assign_part(self) -> str:
        names = self.known("V", is_changed=True)
        if not names:
            return self.declare("V")
        name = self.one(*names)
        if self.language == "wgsl" or self.chance(0.5):
            return f"{name}.{self.one('x', 'y')} = {self.bounded('F')};"
        return f"{name}.{self.one('xy', 'yx')} {self.one('=', '=', '*=')} {self.bounded('V')} * 0.5;"

    def choice(self) -> str:
        text = f"if ({self.value('B')}) {self.block(2)}"
        return f"{text} else {self.block(1)}" if self.chance(0.5) else text

    def loop(self) -> str:
        """Return a loop of a few turns, with a counter that nothing else changes."""
        self.loops += 1
        i, turns = f"i{self.loops}", self.rng.integers(1, 4)
        ended = f" if ({self.value('B')}) {{ {self.one('break', 'continue')}; }}" if self.chance(0.3) else ""
        body = self.block(2)
        inner = f"{{{ended} {body[1:]}"
        if self.language == "wgsl":
            return f"for (var {i} = 0; {i} < {turns}; {i}++) {inner}"
        return f"for (int {i} = 0; {i} < {turns}; {i}++) {inner}"

    def halving(self) -> str:
        """Return a loop of at most four turns, whose condition depends on a vector that changes in the loop."""
        self.loops += 1
        v, count, inner = f"h{self.loops}", f"c{self.loops}", self.block(1)
        kinds = ("var", "var") if self.language == "wgsl" else (self.types["V"], "int")
        begin = f"{kinds[0]} {v} = {self.bounded('V')}; {kinds[1]} {count} = 0;"
        condition = f"{count} < 4 && dot({v} * 0.5, {v}) > 0.2"
        loop = f"while ({condition}) {{ {count}++; {v} = {v} * 0.5; {inner[1:]}"
        return f"{begin} {loop} {self.declare('F', f'{v}.x + {v}.y')}"

    def array(self) -> str:
        """Return the code of a local array that is written and read."""
        self.loops += 1
        name, values = f"l{self.loops}", [self.bounded("F"), self.bounded("F")]
        index = f"[{self.value('I')} & 1]"
        if self.language == "wgsl":
            declared = f"var {name} = array({', '.join(values)});"
        elif self.language == "glsl":
            declared = f"float {name}[2] = float[2]({', '.join(values)});"
        else:
            declared = f"float {name}[2] = {{ {', '.join(values)} }};"
        return f"{declared} {name}{index} = {self.bounded('F')}; {self.declare('F', f'{name}[0] + {name}[1] * 0.5')}"

    # The whole.

    def text(self) -> str:
        """Return the program text."""
        kinds = self.types["F"], self.types["V"]
        struct = f"a: {kinds[0]}, b: {kinds[1]}" if self.language == "wgsl" else f"{kinds[0]} a; {kinds[1]} b;"
        end = "" if self.language == "wgsl" else ";"
        parts = [f"struct Pair {{ {struct} }}{end}"] if self.has_struct else []
        parts += [self.table(number) for number in range(self.rng.integers(0, 3))]
        parts += [self.constant(number) for number in range(CONSTANTS)]
        parts += [self.function(number) for number in range(self.rng.integers(0, 3))]
        return "\n".join([*parts, self.encode(), self.decode(), ""])

    def table(self, at: int) -> str:
        name, numbers = f"T{at}", [self.number() for _ in range(4)]
        self.tables.append((name, 4))
        listed = ", ".join(numbers)
        return {
            "glsl": f"const float {name}[4] = float[4]({listed});",
            "wgsl": f"const {name} = array({listed});",
        }.get(self.language, f"static const float {name}[4] = {{ {listed} }};")

    def constant(self, at: int) -> str:
        name = f"K{at}" if self.chance(0.5) else self.one(*(n for n in USUAL if n not in self.scopes[0].names))
        self.scopes[0].names[name] = ("F", False)
        value = f"{self.number()} * 0.5"
        return {"glsl": f"const float {name} = {value};", "wgsl": f"const {name} = {value};"}.get(
            self.language, f"static const float {name} = {value};"
        )

    def function(self, at: int) -> str:
        kind, given = self.one("F", "V"), [self.one("F", "V", "I") for _ in range(self.rng.integers(1, 3))]
        names = [str(name) for name in self.rng.choice(self.names, len(given), replace=False)]
        changes = self.language != "wgsl"
        self.scopes.append(Scope({name: (parameter, changes) for name, parameter in zip(names, given, strict=True)}))
        body = " ".join(self.statement() for _ in range(2))
        returned = f"return {self.bounded(kind)};"
        self.scopes.pop()
        name = f"f{at}"
        self.functions.append((name, given, kind))
        return f"{self.head(name, names, given, kind)} {{ {body} {returned} }}"

    def head(self, name: str, names: list[str], given: list[str], kind: str) -> str:
        if self.language == "wgsl":
            listed = ", ".join(f"{n}: {self.types[k]}" for n, k in zip(names, given, strict=True))
            return f"fn {name}({listed}) -> {self.types[kind]}"
        return (
            f"{self.types[kind]} {name}({', '.join(f'{self.types[k]} {n}' for n, k in zip(names, given, strict=True))})"
        )

    def encode(self) -> str:
        self.scopes.append(Scope({"p": ("V", True)}))
        self.depth, self.has_normal = 1, True
        body = " ".join(self.statement() for _ in range(self.rng.integers(2, 6)))
        last = f"p = p + 0.1 * {self.bounded('V')};"
        self.depth, self.has_normal = 0, False
        self.scopes.pop()
        first = "n.xy / (abs(n.x) + abs(n.y) + abs(n.z))"
        begin = f"var p = {first};" if self.language == "wgsl" else f"{self.types['V']} p = {first};"
        low, high = (f"{self.types['V']}({end}, {end})" for end in ("-1.0", "1.0"))
        end = f"return clamp(p, {low}, {high});"
        given = ["n", "view"] if self.language == "glsl" else ["n"]
        return f"{self.head('mine_encode', given, ['W'] * len(given), 'V')} {{ {begin} {body} {last} {end} }}"

    def decode(self) -> str:
        w = self.types["W"]
        given, kinds = (["e", "view"], ["V", "W"]) if self.language == "glsl" else (["e"], ["V"])
        returned = f"return normalize({w}(e, 1.0 - abs(e.x) - abs(e.y)));"
        return f"{self.head('mine_decode', given, kinds, 'W')} {{ {returned} }}"
