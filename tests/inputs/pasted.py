"""What an engine programmer sees first in code that is to be pasted: its names and its loops."""

import re

# Letters.
LONGEST = 24


def names_in(body: str) -> set[str]:
    """The names in a text without its comments and the names of files."""
    return set(re.findall(r"\b[A-Za-z_]\w*", re.sub(r'// .*|"[^"\n]*"', "", body)))


def loops_without_unrolling(body: str) -> list[str]:
    """The loops of HLSL that read an array of constants by their counter, and that nothing unrolls."""
    arrays = "|".join(re.findall(r"const \w+ (\w+)\[\d+\]", body)) or "^"
    found = re.findall(r"(.*)\n( *)for \(int (\w+) = .*\n((?:\2 .*\n)*)", body)
    reads = ((above, text) for above, _, name, text in found if re.search(rf"\b(?:{arrays})\[[^\]]*\b{name}\b", text))
    return [text for above, text in reads if above.strip() != "[unroll]"]
