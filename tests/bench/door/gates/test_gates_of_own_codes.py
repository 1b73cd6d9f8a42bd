"""Gates, tests and Python take users' codes of every kind by the words of the commands."""

import pytest
from manual import ROOT

import normalbench
from normalbench.bench.ground.options.option import Sources, fields_of
from normalbench.bench.tables.registry import TABLES

pytestmark = pytest.mark.usefixtures("gl", "slang")


INPUTS = ROOT / "tests" / "inputs" / "own_codes"


def test_python_takes_a_path():
    table = normalbench.vectors(
        encoding=str(INPUTS / "velocity.slang"), storage="rg16", speed="1", backend="glsl", count=64
    )
    assert list(table["encoding"]) == ["velocity.slang"] and table["error_mean_px"][0] > 0


def test_every_table_of_another_kind_takes_files_and_how_they_are_read():
    """An option whose words may be files is fingerprinted, travels to workers, and is found from a gate's folder."""
    taken = {"vectors": "encoding", "depth": "depth", "frames": "encoding", "lights": "light_buffer"}
    for table, name in taken.items():
        options = TABLES[table].options
        assert fields_of(options)[name].option.files, table
        assert issubclass(options, Sources), table
