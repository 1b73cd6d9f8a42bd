"""Published figures, measured again: every figure has a verdict, and a wrong figure is noticed."""

from dataclasses import dataclass, replace

import pytest
from published import rows, sources
from published.figure import Figure, Source
from published.sources import SOURCES

FIGURES = [(source, figure) for source in SOURCES for figure in source.figures]


@dataclass(frozen=True)
class Known:
    """A measure that returns the given value."""

    value: float | None
    scatter: float = 0.0
    command: str = "python -m tests.published"

    def figure(self) -> float | None:
        return self.value


PRINTED = Figure("a mean", "a table", 0.337, 3, "degrees", Known(None))


@pytest.mark.parametrize(
    "ours, more, expected",
    [
        # Half a unit of the last digit.
        (0.3365, {}, "reproduced"),
        (0.3375, {}, "reproduced"),
        (0.3376, {}, "unexplained"),
        (0.3376, {"why": "because"}, "different"),
        (0.34, {"within": 0.003}, "reproduced"),
        # A maximum of samples is below the supremum, by 2 % at most.
        (0.343, {"is_maximum": True}, "short by sampling"),
        (0.345, {"is_maximum": True}, "unexplained"),
        (0.336, {"is_maximum": True}, "unexplained"),
        (0.1, {"bound": "below"}, "holds"),
        (0.4, {"bound": "below"}, "unexplained"),
        (0.4, {"bound": "above"}, "holds"),
        # Slots and instructions are never the same thing.
        (0.337, {"why": "another thing", "is_comparable": False}, "different"),
        (None, {}, "not measured"),
    ],
)
def test_a_verdict_follows_from_the_figures(ours, more, expected):
    assert replace(PRINTED, **more).verdict(ours) == expected


def test_a_verdict_allows_for_the_scatter_of_samples():
    figure = replace(PRINTED, ours=Known(None, scatter=0.01))
    assert figure.verdict(0.337 * 1.011) == "reproduced" and figure.verdict(0.337 * 1.013) == "unexplained"


def test_more_than_130_figures_have_unique_names():
    names = [(source.name, figure.what) for source, figure in FIGURES]
    assert len(names) > 130 and len(set(names)) == len(names)
    for source, figure in FIGURES:
        assert float(figure.printed) == pytest.approx(figure.value), figure.what
        assert (
            figure.place
            and source.name
            and figure.ours.command.startswith(("normalbench ", "python -m tests.published "))
        )


def test_a_wrong_constant_is_found_and_its_figure_is_reported(monkeypatch):
    """The constant is off by 1%."""
    right = next(figure for _, figure in FIGURES if figure.what == "mean of oct16, 8:8")
    wrong = Source("Z. Cigolle", (right, replace(right, what="a slip", value=right.value * 1.01)))
    monkeypatch.setattr(sources, "SOURCES", (wrong,))
    measured = rows.rows("Cigolle")
    assert [row["verdict"] for row in measured] == ["reproduced", "unexplained"]
    (line,) = rows.unexplained(measured)
    assert "Z. Cigolle: a slip: 0.34046 degrees is published and 0.33689 measured" in line


@pytest.mark.usefixtures("rows_are_shared")
def test_sources_are_chosen_by_words():
    assert [source.name[:6] for source in rows.chosen("XEOKIT, smith")] == ["J. Smi", "xeokit"]
    assert rows.chosen("all") == list(SOURCES) and rows.chosen("knuth") == []
