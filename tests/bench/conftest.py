"""Compilers of the languages; if CI is set, tests that need them fail on a machine without them."""

import os

import pytest

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.languages.language import require_language


def _there(name):
    try:
        require_language(name)
    except MissingError as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def hlsl():
    _there("HLSL")


@pytest.fixture(scope="session")
def slang():
    _there("Slang")


@pytest.fixture(params=["hlsl", "slang"])
def ending(request):
    """The file extension of each language."""
    request.getfixturevalue(request.param)
    return request.param
