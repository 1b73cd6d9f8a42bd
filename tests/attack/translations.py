"""Programs from seeds, read in four languages and written in eight: what they mean must stay."""

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
    """The languages that this machine runs, and a line with the reason for each other one."""
    found, left_out = [], []
    for name in RUN:
        try:
            runner(name).how()
            found.append(name)
        except (MissingError, NoDeviceError) as error:
            left_out.append(f"left out: programs written in {LANGUAGES[name].title}: {error}")
    return found, left_out


def translated_here(file: UserFile, by: str, kind: kinds.Kind) -> dict[str, object]:
    """A translation in this process: the attack limits itself."""
    found = answer(file, file.path.parent, by, kind)
    if "error" in found:
        raise UsageError(str(found["error"]))
    return found


def translations(folder: Path) -> Attack:
    """A program that is measured as it is meant, and written in another language, or refused in one line."""
    translated._by_child = translated_here
    written, _ = written_here()

    def case(seed: int) -> str:
        language = GIVEN[seed % len(GIVEN)]
        path = folder / f"mine.{language}"
        path.write_text(Program(language, seed).text())
        found = first_look(path)
        said = found.get("error", found.get("broken", ""))
        assert "disagree" not in said, f"{said}\n{path.read_text()}"
        if said:
            assert said.isprintable() and len(said) < 2000, said
            return REFUSED
        encoding = read_encoding(path, "no twin", found.get("biased", False), found.get("by", ""))
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
