"""The names and loops of code that is to be pasted, which engine programmers notice first."""

import re

# Letters.
LONGEST = 24


def names_in(body: str) -> set[str]:
    """Return the names in a text without its comments and file names."""
    return set(re.findall(r"\b[A-Za-z_]\w*", re.sub(r'// .*|"[^"\n]*"', "", body)))


def loops_without_unrolling(body: str) -> list[str]:
    """Return the loops of HLSL that index an array of constants by their counter and are not unrolled."""
    arrays = "|".join(re.findall(r"const \w+ (\w+)\[\d+\]", body)) or "^"
    loops = re.findall(r"(.*)\n( *)for \(int (\w+) = .*\n((?:\2 .*\n)*)", body)
    reads = ((above, text) for above, _, name, text in loops if re.search(rf"\b(?:{arrays})\[[^\]]*\b{name}\b", text))
    return [text for above, text in reads if above.strip() != "[unroll]"]
