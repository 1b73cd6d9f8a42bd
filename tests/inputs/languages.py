"""Whether a machine can run files of a language; where CI is set, one that cannot fails the tests that need it."""

import os

import pytest

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.code.run import runner
from normalbench.gbuffer.gl.device import NoDeviceError


def require_runner(language: str) -> None:
    """Skips the test where something is missing."""
    try:
        runner(language).how()
    except (MissingError, NoDeviceError) as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))
