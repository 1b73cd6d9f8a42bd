"""The patch of `doctor FOLDER --diff`: replaces worse code with the catalogue's best, in the file's language."""

from __future__ import annotations

import difflib
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ..ground.compilers.lines import without_comments
from ..ground.output.errors import MissingError, UsageError, tell
from ..ground.user_files import UserFile
from ..shaders.code.files import code_of
from ..shaders.languages.embedded import shader_text
from ..shaders.languages.items import Item, items
from ..shaders.languages.language import name_of
from ..shaders.languages.pairs import name_speaks_of_normals
from ..subjects.codecs.user_encodings import examined
from .examine import row_of
from .folder import PATCH, Pair

# How far the patched file may be off from the best code, as a share of its mean error.
NEARLY = 0.02
# What a patch says of a last line that does not end.
NO_END = "\\ No newline at end of file"
# What follows the functions that a patch has.
_PACKING = "\n// The texel as an integer of 32 bits"
_PARAMETER = re.compile(r"\(\s*(?:(\w+)\s*:|[^,():]*?(\w+)\s*(?:[,):\[]))")


def patch_of(folder: Path, pairs: Sequence[Pair]) -> str:
    """Return a patch for `git apply` or `patch -p1` in the folder, with the measured errors above the changes.

    Pairs that cannot be changed are named on standard error.
    """
    by_file: dict[str, list[Pair]] = {}
    for pair in pairs:
        if pair.row.get("best_mean_deg") and _is_of_normals(pair):
            by_file.setdefault(pair.file, []).append(pair)
    return "".join([f"{PATCH}\n", *(_part_of(folder, file, several) for file, several in by_file.items())])


def _is_of_normals(pair: Pair) -> bool:
    """Whether a pair is clearly for normals: its functions' names say so, or its encoding is in the catalogue. If
    not, report on standard error that the pair is not in the patch."""
    is_sure = bool(pair.looked.like) or name_speaks_of_normals(pair.functions)
    if not is_sure:
        tell(f"{pair.file} {pair.functions} is not in the patch: the names of its functions do not mention normals")
    return is_sure


def _part_of(folder: Path, file: str, pairs: Sequence[Pair]) -> str:
    """Return one file's part of a patch: a line about each changed pair, then the changes; empty if the file cannot
    be read. Report pairs that cannot be changed on standard error."""
    try:
        text = was = "" if "," in file else (folder / file).read_bytes().decode("utf-8")
    except (OSError, ValueError) as error:
        tell(f"{file} is not in the patch: {error}")
        return ""
    summaries: list[str] = []
    for pair in pairs:
        try:
            patched = patched_text(text, pair)
            mean, before, best = _mean_of(patched, folder / file, pair), pair.row["mean_deg"], pair.row["best"]
        except (UsageError, MissingError) as error:
            tell(f"{file} {pair.functions} is not in the patch: {error}")
            continue
        summaries.append(f"{file} {pair.functions}: {best}, mean error {mean:.4g} degrees instead of {before:.4g}\n")
        text = patched
    before, after = (version.splitlines(keepends=True) for version in (was, text))
    lines = difflib.unified_diff(before, after, f"a/{file}", f"b/{file}")
    return "".join([*summaries, *(line if line.endswith("\n") else f"{line}\n{NO_END}\n" for line in lines)])


def _mean_of(patched: str, path: Path, pair: Pair) -> float:
    """Return a pair's mean error in a patched file. Raises UsageError if the error is not close to the best
    encoding's."""
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / path.name
        copy.write_bytes(patched.encode())
        file = UserFile(pair.word)
        settings = file.word.removeprefix(file.plain)
        word = f"{copy}:{pair.functions}{settings}:include={path.parent.absolute()}"
        mean = row_of(Codec(examined(UserFile(word)).encoding, pair.storage))["angle_mean_deg"]
    wanted = pair.row["best_mean_deg"]
    if mean is None or abs(mean - wanted) > NEARLY * wanted:
        raise UsageError(f"its mean error with {pair.row['best']} would be {mean} degrees, not {wanted:.4g}")
    return mean


def patched_text(text: str, pair: Pair) -> str:
    """Return a file's text in which both functions of a pair call the best encoding's code, which is added.

    Raises:
        UsageError: the pair cannot be changed in this way; the message is a sentence.
    """
    if "," in pair.file:
        raise UsageError("its functions are in two files")
    looked, best = pair.looked, ENCODINGS.get(pair.row["best"])
    if best is None or (best.components, best.sign_bits) != (looked.encoding.components, 0):
        raise UsageError(f"{pair.row['best']} has a different number of components")
    if shader_text(text, Path(pair.file).suffix.lower()) != text or "PROGRAM" in text:
        raise UsageError("its functions are embedded in a file of another format")
    language = {"GLSL": "glsl", "WGSL": "wgsl"}.get(name_of(UserFile(pair.word)), "hlsl")
    prefix = f"nb_{best.name}"
    code = code_of(Codec(best, pair.storage), language, prefix).body.partition(_PACKING)[0].rstrip()
    # By other names than an encoder's and a decoder's, so that the file's own stay its pair.
    to, back_from = f"{prefix}_write", f"{prefix}_read"
    code = code.replace(f"{prefix}_encode(", f"{to}(").replace(f"{prefix}_decode(", f"{back_from}(")
    bare = without_comments(text)
    places = {item.name: item for item in items(bare) if item.function}
    names = [name.rpartition("::")[2] for name in pair.functions.split(":") if name]
    if len(names) != 2 or not {*names} <= {*places}:
        raise UsageError("its functions are not in this file, or take parameters besides the normal or the code")
    out, back = (" * 0.5 + 0.5", " * 2.0 - 1.0") if looked.encoding.is_unit else ("", "")
    encode, decode = (places[name] for name in names)
    calls = {
        encode: f"{{ return {to}({_parameter(bare, encode)}){out}; }}",
        decode: f"{{ return {back_from}({_parameter(bare, decode)}{back}); }}",
    }
    first = min(calls, key=lambda item: item.start)
    # Behind a mark of the order of bytes.
    start = max(_line_start(bare, first), int(text.startswith("\ufeff")))
    is_there = f"{to}(" in text
    changes = [(item.body, item.end, call) for item, call in calls.items()]
    changes += [] if is_there else [(start, start, f"{code}\n\n")]
    ending = "\r\n" if "\r\n" in text else "\n"
    for begin, end, words in sorted(changes, reverse=True):
        text = text[:begin] + words.replace("\n", ending) + text[end:]
    return text


def _parameter(bare: str, item: Item) -> str:
    """Return the name of a function's first parameter, from text without comments. Raises UsageError if it has no
    name."""
    match = _PARAMETER.search(bare[item.start : item.body])
    if not match:
        raise UsageError(f"the first parameter of {item.name} has no name")
    return match[1] or match[2]


def _line_start(bare: str, item: Item) -> int:
    """Return the offset of the start of the line that contains a function's name, in text without comments."""
    name = re.compile(rf"\b{item.name}\s*\(").search(bare, item.start)
    return bare.rfind("\n", 0, name.start() if name else item.start) + 1
