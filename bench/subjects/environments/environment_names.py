"""Environments by name: from the catalogue, and from users' files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from ....gbuffer.environment.catalogue import ENVIRONMENTS
from ....gbuffer.environment.environment import Environment
from ....gbuffer.environment.sun import without_sun
from ...ground.choose import choose_one, names_a_file, names_a_folder
from ...ground.output.errors import UsageError
from .environment_files import ENDINGS, environment_of

READ = f"only {' and '.join(ENDINGS)} files are supported"
LOW = "it stores no light brighter than white; save the environment as .hdr or .exr"
# By its ending, why a picture of another kind is not read.
OTHERS: Mapping[str, str] = MappingProxyType(
    dict.fromkeys((".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga", ".gif"), LOW)
)


def environment_named(word: str) -> Environment:
    """Return the environment for a word: an entry in the catalogue, or a file. A sun in a file's environment becomes
    a light; a lamp in the catalogue does not.

    Raises:
        UsageError: a name is unknown, or a file is not an environment; the message is one line.
    """
    ending = Path(word).suffix.lower()
    if ending in ENDINGS:
        return without_sun(environment_of(Path(word)))
    if names_a_folder(word) and word not in ENVIRONMENTS:
        raise UsageError(f"{word}: it is a folder; name a file")
    if ending in OTHERS or names_a_file(word):
        raise UsageError(f"{word}: {OTHERS.get(ending, READ)}")
    try:
        maker = ENVIRONMENTS[choose_one("environment", word, ENVIRONMENTS)]
    except UsageError as error:
        raise UsageError(f"{error}; or a file ending in {', '.join(ENDINGS)}") from None
    return without_sun(maker.make()) if maker.has_sun else maker.make()
