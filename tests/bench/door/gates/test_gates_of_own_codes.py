"""Gates, tests and Python accept users' encodings of every kind, in the same form as commands."""

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


def test_tables_of_all_kinds_accept_files_and_options_for_reading_them():
    """An option that may name files is fingerprinted, sent to workers, and resolved from the folder of a gate."""
    taken = {"vectors": "encoding", "depth": "depth", "frames": "encoding", "lights": "light_buffer"}
    for table, name in taken.items():
        options = TABLES[table].options
        assert fields_of(options)[name].option.files, table
        assert issubclass(options, Sources), table
