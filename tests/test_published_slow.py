"""Published figures, measured again: every figure has a verdict, and a wrong figure is noticed."""

import pytest
from published import rows


@pytest.mark.usefixtures("rows_are_shared")
def test_counted_figures_match_the_published_figures():
    """The sources take no samples: layouts, light, depth, points on rings."""
    words = "smith,drobot,jo kyeong,ols,shared_exponent,kemen,golubev,normal_pack"
    verdicts = {row["figure"]: row["verdict"] for row in rows.rows(words)}
    assert len(verdicts) == 36
    others = [figure for figure, verdict in verdicts.items() if verdict not in ("reproduced", "holds")]
    # Of Kemen's sixteen steps those where his code is another one than ours.
    kemen = [f"step at {km:g} km, C = 1" for km in (0.001, 0.01, 0.1)]
    kemen += [f"step at {km:g} km, C = 0.001" for km in (0.001, 0.01, 0.1, 10)]
    assert others == [*kemen, "distance where a step exceeds 1 m"]
    assert sum("km, C =" in figure for figure in verdicts) == 16
