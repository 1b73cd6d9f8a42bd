"""The readers of names and of users' files, applied to texts as people type them."""

from collections.abc import Callable
from functools import wraps
from typing import Any

from normalbench.bench.ground import choose as choosing
from normalbench.bench.ground.options import counts
from normalbench.bench.ground.user_files import UserFile, file_names, with_settings
from normalbench.bench.shaders.languages import child, source
from normalbench.bench.shaders.languages import translated as translating
from normalbench.bench.subjects.codecs import encoding_names, layout_names, names, user_encodings
from normalbench.bench.subjects.codecs import first_look as looking
from normalbench.bench.subjects.codecs.kinds import codecs as kinds
from normalbench.bench.subjects.codecs.kinds import named
from normalbench.bench.subjects.names import effects, light_buffers, listing, storages
from normalbench.bench.subjects.normals import normal_names
from normalbench.bench.subjects.scenes import scene_names
from normalbench.bench.tables import families_named as families
from normalbench.bench.tables.budget import contract
from normalbench.bench.tables.cost import work as cost
from normalbench.bench.tables.roofline import rates


def _typed(reader: Callable[..., Any], at: int = 0, several: int = 1) -> Callable[..., Any]:
    """Return a reader whose arguments from `at` on are texts of names."""

    @wraps(reader)
    def read(*given: Any, **more: Any) -> Any:
        last = at + several
        texts = [file_names(text) if isinstance(text, str) else text for text in given[at:last]]
        return reader(*given[:at], *texts, *given[last:], **more)

    return read


def _of_file(reader: Callable[..., Any], at: int = 0) -> Callable[..., Any]:
    """Return a reader of a user's file that takes a text or a path."""

    def read(*given: Any, **more: Any) -> Any:
        return reader(*given[:at], UserFile(str(given[at])), *given[at + 1 :], **more)

    return read


Source = _of_file(source.Source)
answer = _of_file(child.answer)
examined = _of_file(user_encodings.examined)
first_look = _of_file(looking.first_look)
own_code = _of_file(named.own_code, 1)
read_encoding = _of_file(user_encodings.read_encoding)
translated = _of_file(translating.translated)

as_known = _typed(contract.as_known)
attributes_held = _typed(contract.attributes_held)
choose = _typed(choosing.choose, 1)
chosen_families = _typed(cost.chosen_families)
checked_numbers = _typed(counts.checked_numbers, 1)
codecs_of_kind = _typed(kinds.codecs_of_kind, 1, 2)
codecs_named = _typed(names.codecs_named, several=4)
effects_named = _typed(effects.effects_named)
encodings_named = _typed(encoding_names.encodings_named)
families_named = _typed(families.families_named)
kinds_named = _typed(kinds.kinds_named)
gpus_named = _typed(rates.gpus_named)
layouts_named = _typed(layout_names.layouts_named)
light_buffers_named = _typed(light_buffers.light_buffers_named)
light_codecs_named = _typed(named.light_codecs_named)
listed = _typed(listing.listing)
normal_sets_named = _typed(normal_names.normal_sets_named)
own_codes_named = _typed(named.own_codes_named, 1)
roundings_named = _typed(storages.roundings_named)
scene_makers_named = _typed(scene_names.scene_makers_named)
storages_named = _typed(storages.storages_named)
with_arithmetics = _typed(names.with_arithmetics, 1)


def word_with(word: str, **settings: str) -> str:
    """Return a user's file and one of SETTINGS, which says how to read it, as one word."""
    return with_settings((word,), **{name: file_names(text) for name, text in settings.items()})[0]
