"""docs/ci.md: the steps of its workflows run, and end in the files that they promise."""

import pytest
import test_ci_page_slow

checkout = test_ci_page_slow.checkout


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize(
    "system",
    ["gitlab", "jenkins"],
)
def test_a_workflow_ends_in_what_it_promises_elsewhere(system, checkout):
    test_ci_page_slow.test_a_workflow_ends_in_what_it_promises(system, checkout)
