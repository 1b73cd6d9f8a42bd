"""docs/ci.md: the steps of its workflows run, and end in the files that they promise."""

import pytest
import test_ci_page_slow
from test_ci_page_slow import SYSTEMS, run_all

checkout = test_ci_page_slow.checkout


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("system", SYSTEMS)
def test_a_workflow_keeps_what_was_pushed(system, checkout):
    """Everything is well: the run is kept, and its gates pass."""
    steps = SYSTEMS[system]()
    assert run_all([step for step in steps if step.is_of_pushes], checkout, system) == 0
    kept = {path.name for path in (checkout / "history/0123abcd").iterdir()}
    assert kept == {"run.json", "rows.jsonl"}
    assert (checkout / "history.md").read_text().startswith("1 run, from ")
    assert "pass" in (checkout / "gates.md").read_text()


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("system", [system for system in SYSTEMS if system != "github"])
def test_a_workflow_ends_in_what_it_promises_elsewhere(system, checkout):
    test_ci_page_slow.test_a_workflow_ends_in_what_it_promises(system, checkout)
