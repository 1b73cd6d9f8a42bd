"""A run with two processes: charts that cannot be written, and compiled programs that JAX must not keep."""

import shutil

import pytest
import test_second_process
from test_second_process_slow import CODE, SMALL, measured, programs

cores = test_second_process.cores


@pytest.mark.usefixtures("gl")
def test_charts_that_cannot_be_written_are_a_one_line_error(run, tmp_path, cores):
    """A file has the name of the chart folder."""
    cores(2)
    folder = tmp_path / "run"
    assert run("run", "--tables", "mix", *CODE, "-o", str(folder))[0] == 0
    shutil.rmtree(folder / "charts")
    (folder / "charts").touch()
    status, _, err = run(*SMALL, "-o", str(folder))
    lines = err.splitlines()
    assert status == 2 and len(lines) == 2 and "resuming" in lines[0] and "charts" in lines[1], err


def test_compiled_programs_are_not_kept_if_jax_caching_is_disabled(tmp_path):
    measured(tmp_path, JAX_ENABLE_COMPILATION_CACHE="0")
    assert not programs(tmp_path)
