"""The languages that files are run in; with CI set, tests fail on a machine that cannot run one."""

import os

import pytest

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.run import NEVER_RUN, runner
from normalbench.gbuffer.gl.device import NoDeviceError

# Those that code is written in for a page: others are written in the same way, and take seconds to be run.
SHORT = {name: LANGUAGES[name] for name in ("c", "glsl")}
RUN = [name for name in LANGUAGES if name not in NEVER_RUN]


def require_runner(language: str) -> None:
    """Skip the test if something is missing, unless CI is set."""
    try:
        runner(language).how()
    except (MissingError, NoDeviceError) as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))
