"""Mistakes that people make in an encoder or a decoder, as edits of correct GLSL."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

# What is said of an encoder that cuts its codes off.
CUT_OFF = "codes are truncated instead of rounded: rounding would halve the error"
# The octahedral map as it is written everywhere; mistakes of numbers are put where CODE is returned.
PLAIN = """vec2 mine_encode(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    vec2 c = n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * s;
    return CODE;
}
vec3 mine_decode(vec2 e) {
    BEFORE
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.xy -= vec2(n.x >= 0.0 ? t : -t, n.y >= 0.0 ? t : -t);
    return normalize(n);
}
"""
# The same with the normal itself divided.
IN_PLACE = PLAIN.replace("vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));", "n /= abs(n.x) + abs(n.y) + abs(n.z);")
IN_PLACE = IN_PLACE.replace("vec2 s = vec2(p.x", "vec2 p = n.xy;\n    vec2 s = vec2(p.x")
# The fold by mix and step.
STEPS = """vec2 mine_encode(vec3 n) {
    vec3 a = abs(n);
    vec2 p = n.xy / (a.x + a.y + a.z);
    vec2 s = step(0.0, p) * 2.0 - 1.0;
    vec2 c = mix((1.0 - abs(p.yx)) * s, p, step(0.0, n.z));
    return CODE;
}
vec3 mine_decode(vec2 e) {
    BEFORE
    float z = 1.0 - dot(abs(e), vec2(1.0));
    vec2 s = step(0.0, e) * 2.0 - 1.0;
    vec2 p = mix((1.0 - abs(e.yx)) * s, e, step(0.0, z));
    return normalize(vec3(p, z));
}
"""
# Turned by 45 degrees about its pole.
TURNED = PLAIN.replace(
    "mine_encode(vec3 n) {", "mine_encode(vec3 m) {\n    vec3 n = vec3(m.x + m.y, m.x - m.y, m.z * 1.41421356);"
)
TURNED = TURNED.replace(
    "return normalize(n);", "n.z *= 1.41421356; return normalize(vec3(n.x + n.y, n.x - n.y, n.z));"
).replace(
    "n.z *= 1.41421356; return normalize(vec3(n.x + n.y, n.x - n.y, n.z))",
    "return normalize(vec3(n.x + n.y, n.x - n.y, n.z * 1.41421356))",
)
SPHEREMAP = """vec2 mine_encode(vec3 n) {
    vec2 c = n.z > -1.0 ? n.xy * (2.0 / sqrt(8.0 * n.z + 8.0)) : vec2(1.0, 0.0);
    return CODE;
}
vec3 mine_decode(vec2 e) {
    BEFORE
    vec2 g = e * 2.0;
    float f = min(dot(g, g), 4.0);
    return vec3(g * sqrt(1.0 - f / 4.0), 1.0 - f / 2.0);
}
"""
CUBE = """vec3 mine_encode(vec3 n) {
    vec3 a = abs(n);
    bool is_z = a.z >= a.x && a.z >= a.y, is_y = a.y >= a.x;
    vec3 t = is_z ? n : is_y ? n.zxy : n.yzx;
    float face = 2.0 * (is_z ? 2.0 : is_y ? 1.0 : 0.0) + (t.z < 0.0 ? 1.0 : 0.0);
    vec3 c = vec3(t.xy / abs(t.z), face / 5.0 * 2.0 - 1.0);
    return CODE;
}
vec3 mine_decode(vec3 e) {
    BEFORE
    float face = floor((e.z * 0.5 + 0.5) * 5.0 + 0.5);
    float axis = floor(0.5 * face);
    vec3 n = normalize(vec3(e.xy, 1.0 - 2.0 * (face - 2.0 * axis)));
    return axis == 2.0 ? n : axis == 1.0 ? n.yzx : n.zxy;
}
"""
# Each text: it, what is returned, and what stands before the decoder's first line.
TEXTS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "octahedral": (PLAIN, "c", ""),
        "divided in place": (IN_PLACE, "c", ""),
        "by mix and step": (STEPS, "c", ""),
        "in [0, 1]": (PLAIN, "c * 0.5 + 0.5", "e = e * 2.0 - 1.0;"),
        "turned by 45 degrees": (TURNED, "c", ""),
        "spheremap": (SPHEREMAP, "c", ""),
        "cube": (CUBE, "c", ""),
    }
)
OCTAHEDRAL = tuple(TEXTS)[:5]


class Mistake(NamedTuple):
    """A mistake: the text of its finding, and the edits that make it; each edit must change the text.

    Attributes:
        said: regular expression for the finding; empty if the mistake changes no result. STEPS stands for the largest
            integer of the given bits, BITS for their number.
        edits: replaced texts with their replacements; of several spellings, the first that the text contains applies.
        code: the changed code; {} stands for the old code, in [0, 1] if the text uses that range, else in [-1, 1].
        unit: whether the code is in [0, 1]; other codes are mapped to this range.
    """

    said: str
    edits: tuple[tuple[tuple[str, str], ...], ...] = ()
    code: str = ""
    unit: bool = False


def _edit(*spellings: tuple[str, str]) -> tuple[tuple[tuple[str, str], ...], ...]:
    return (spellings,)


MISTAKES: Mapping[str, Mistake] = MappingProxyType(
    {
        "no fold": Mistake(
            "encode is octahedral, but its fold is missing",
            _edit(("n.z >= 0.0 ? p", "true ? p"), ("p, step(0.0, n.z))", "p, 1.0)")),
        ),
        "no unfold": Mistake(
            "decode is octahedral, but its unfold is missing",
            _edit(("max(-n.z, 0.0)", "0.0"), ("e, step(0.0, z))", "e, 1.0)")),
        ),
        "sign(0)": Mistake(
            r"sign\(\) returns 0|check comparisons and sign\(\)",
            _edit(
                ("vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0)", "vec2 s = sign(p)"),
                ("vec2 s = step(0.0, p) * 2.0 - 1.0", "vec2 s = sign(p)"),
            ),
        ),
        "> for >=": Mistake(
            "",
            _edit(
                (">= 0.0", "> 0.0"),
                ("step(0.0, p) * 2.0 - 1.0", "1.0 - 2.0 * step(p, vec2(0.0))"),
                (">= a.", "> a."),
            ),
        ),
        ".xy for .yx": Mistake("its fold uses .xy instead of .yx", _edit(("abs(p.yx)", "abs(p.xy)"))),
        ".xy for .yx in decode": Mistake("its unfold uses .xy instead of .yx", _edit(("abs(e.yx)", "abs(e.xy)"))),
        "abs missing in the fold": Mistake(r"abs\(\) is missing in its fold", _edit(("abs(p.yx)", "p.yx"))),
        "abs missing in the sum": Mistake(
            r"abs\(\) is missing in \|x\| \+ \|y\| \+ \|z\|",
            _edit(
                ("abs(n.x) + abs(n.y) + abs(n.z)", "abs(n.x) + n.y + abs(n.z)"),
                ("a.x + a.y + a.z", "a.x + n.y + a.z"),
                ("vec3 a = abs(n);\n    bool", "vec3 a = n;\n    bool"),
            ),
        ),
        "abs missing in decode": Mistake(
            r"abs\(\) is missing in 1 - \|x\| - \|y\|",
            _edit(("abs(e.x) -", "e.x -"), ("dot(abs(e), ", "dot(vec2(e.x, abs(e.y)), ")),
        ),
        "normalise missing": Mistake(r"normalize\(\) is missing", _edit(("normalize(", "("))),
        "254 for 255": Mistake("LESS/STEPS times", code="{} * (LESS.0 / STEPS.0)", unit=True),
        "255 for 254": Mistake("STEPS/LESS times", code="{} * (STEPS.0 / LESS.0)", unit=True),
        "254 for 255, rounded": Mistake("LESS/STEPS times", code="floor({} * LESS.0 + 0.5) / STEPS.0", unit=True),
        "cut off": Mistake("rounded down to BITS bits", code="floor({} * STEPS.0) / STEPS.0", unit=True),
        "half-step bias": Mistake("half a step of BITS bits too large", code="{} + 0.5 / STEPS.0", unit=True),
        "half-step bias, rounded": Mistake(
            "half a step of BITS bits too large", code="floor({} * STEPS.0 + 1.0) / STEPS.0", unit=True
        ),
        "swapped channels": Mistake("swapped", code="({}).SWAPPED"),
        "wrong range": Mistake(r"c \* 2 - 1 between the two|c \* 0.5 \+ 0.5 between the two", code="({}) * 0.5 + 0.5"),
    }
)


def program(text: str, mistake: str, bits: int) -> str | None:
    """Return a text with a mistake, or None if the mistake does not apply to the text."""
    body, code, before = TEXTS[text]
    fault = MISTAKES[mistake] if mistake else Mistake("")
    for spellings in fault.edits:
        fitting = next((spelling for spelling in spellings if spelling[0] in body), None)
        if fitting is None:
            return None
        body = body.replace(*fitting)
    if fault.code and "0.5 + 0.5" in code:
        code = fault.code.format(f"({code})") if mistake != "wrong range" else "c"
    elif fault.code and fault.unit:
        code = f"({fault.code.format(f'({code} * 0.5 + 0.5)')}) * 2.0 - 1.0"
    elif fault.code:
        code = fault.code.format(code)
    swapped = "yxz" if "vec3 mine_encode" in body else "yx"
    return in_bits(body.replace("CODE", code).replace("BEFORE", before).replace("SWAPPED", swapped), bits)


def said(mistake: str, bits: int) -> str:
    """Return the regular expression for the finding of a mistake."""
    return in_bits(MISTAKES[mistake].said, bits)


def in_bits(text: str, bits: int) -> str:
    """Return a text with the integers of this many bits filled in."""
    steps = 2**bits - 1
    return text.replace("STEPS", str(steps)).replace("LESS", str(steps - 1)).replace("BITS", str(bits))
