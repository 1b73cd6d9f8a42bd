"""Programs from seeds, read in four languages and written in eight: their meaning must not change."""

from __future__ import annotations

from pathlib import Path

from languages import RUN
from typed import answer, first_look, read_encoding

from normalbench.bench.ground.output.errors import MissingError, UsageError
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.run import runner
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.shaders.languages import translated
from normalbench.encodings import kinds
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.gl.device import NoDeviceError

from .kind import MEASURED, REFUSED, Attack, Kind, one_line
from .programs import Program

TRANSLATION = "translation"
GIVEN = ("glsl", "hlsl", "slang", "wgsl")
# How many normals may lie next to a seam.
SEAMS = 1e-3


def written_here() -> tuple[list[str], list[str]]:
    """Return the languages that this machine can run, and a line with the reason for every other language."""
    languages, left_out = [], []
    for name in RUN:
        try:
            runner(name).how()
            languages.append(name)
        except (MissingError, NoDeviceError) as error:
            left_out.append(f"left out: programs written in {LANGUAGES[name].title}: {error}")
    return languages, left_out


def translated_here(file: UserFile, by: str, kind: kinds.Kind) -> dict[str, object]:
    """Translate a file in this process, because the attack sets its own limits."""
    translation = answer(file, file.path.parent, by, kind)
    if "error" in translation:
        raise UsageError(str(translation["error"]))
    return translation


def translations(folder: Path) -> Attack:
    """Return an attack: a program is measured correctly and written in another language, or refused in one line."""
    translated._by_child = translated_here
    written, _ = written_here()

    def case(seed: int) -> str:
        language = GIVEN[seed % len(GIVEN)]
        path = folder / f"mine.{language}"
        path.write_text(Program(language, seed).text())
        look = first_look(path)
        message = look.get("error", look.get("broken", ""))
        assert "disagree" not in message, f"{message}\n{path.read_text()}"
        if message:
            assert message.isprintable() and len(message) < 2000, message
            return REFUSED
        encoding = read_encoding(path, "no twin", look.get("biased", False), look.get("by", ""))
        codec, to = Codec(encoding, STORAGES["rg16"], "nearest"), written[seed // len(GIVEN) % len(written)]
        try:
            code = code_of(codec, to, "p")
        except UsageError as error:
            # It is measured, but has what is not written, such as a structure.
            one_line(error)
            return MEASURED
        (folder / code.name).write_text(code.body)
        same = agreement(codec, to, folder / code.name, code.interface)
        # The two sides of a seam, as quotients are rounded.
        is_same = same.holds or (same.differing <= SEAMS * same.count and not same.unpacked)
        assert is_same, f"in {to}: {same.says}\n{path.read_text()}\n{code.body}"
        return MEASURED

    return case


KINDS = (Kind(TRANSLATION, translations, 600, 0, seconds=30.0, chunk=20),)
