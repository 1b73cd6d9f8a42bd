"""Code of every codec as an engine programmer would paste it: short names and lines, and loops over tables unrolled."""

import pytest
from test_readable import EVERY, check
from test_readable_slow import in_other_storages

from normalbench.bench.shaders.code.emit import LANGUAGES


@pytest.mark.parametrize("kind, name", EVERY, ids=[f"{kind.word}-{name}" for kind, name in EVERY])
def test_code_in_every_other_storage_has_short_names_and_lines(kind, name):
    check(in_other_storages(kind, name), LANGUAGES)
