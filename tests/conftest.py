"""Strict JAX, and the GL device. Where CI is set, a missing GL driver fails the tests that need it."""

import os
import sys

import jax
import pytest

from normalbench.bench import cli
from normalbench.gbuffer.device import NoDeviceError, device

jax.config.update("jax_numpy_rank_promotion", "raise")
jax.config.update("jax_numpy_dtype_promotion", "strict")


@pytest.fixture(scope="session")
def gl():
    try:
        return device()
    except NoDeviceError as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))


@pytest.fixture
def run(monkeypatch, capsys):
    """The command line in this process: arguments to its status, output and errors."""

    def command(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["normalbench", *arguments])
        status = cli.main()
        return status, *capsys.readouterr()

    return command
