"""The measured tables of the manual match the kept figures; a nightly run measures half of them again."""

import pytest
from manual_tables.measuring import measure
from manual_tables.tables import TABLES
from slowly import half


@pytest.mark.parametrize("marker", half(TABLES))
def test_a_table_has_the_same_figures_when_measured_again(marker, request):
    """A compiler's counts are compared only if its version is the same."""
    table = TABLES[marker]
    for fixture in table.needs:
        request.getfixturevalue(fixture)
    kept, measured = table.read(), measure(table, is_again=True)
    assert not table.differences(kept, measured)
    if measured.drivers != kept.drivers:
        pytest.skip(f"counts are by {' and '.join(kept.drivers)}, and here by {' and '.join(measured.drivers)}")
    table.holds(measured.lines)
