"""The table of published figures: what a source prints, what is measured here, and why the two differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Option
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class PublishedOptions:
    """Which published figures are measured."""

    source: Annotated[
        str, Option("--source", "Words of the sources' names, comma-separated, such as cigolle,2010; or all.")
    ] = "all"


COLUMNS = (
    Column("source", "Who published the figure, where and when.", KEY),
    Column("figure", "What the figure is.", KEY),
    Column("place", "Where in the source it stands.", HOW, shown=False),
    Column("published", "The figure as it is printed.", HOW),
    Column("ours", "The same figure as it is measured here."),
    Column("unit", "Its unit.", HOW),
    Column("difference", "Ours less the published one.", shown=False),
    Column(
        "verdict",
        "reproduced: the same within the printed digits and the scatter of samples. short by sampling: a maximum of "
        "samples, at most 2 % below the supremum. holds: a bound that is kept. different: see `why`. not measured: "
        "this machine cannot. unexplained: the measurement or the source is wrong.",
        HOW,
    ),
    Column("why", "Why ours is another figure, or what the source leaves unsaid.", HOW, shown=False),
    Column("command", "The command that shows ours.", HOW, shown=False),
)

TABLE = Table(
    name="published",
    package=__package__ or "",
    help="Figures of articles and engines, measured anew: what is printed, what is measured here, and why they differ."
    "\n\nA figure that is neither reproduced nor explained makes the exit status 1.",
    example="normalbench published --source cigolle,tyler",
    options=PublishedOptions,
    columns=COLUMNS,
    in_all=False,
    usual=({"source": "pranckevicius,cigolle,smith"},),
    single={"source": "cigolle"},
    is_measured_beside=True,
    section=Section(
        title="Do published figures hold?",
        short="Published",
        view=View.CODECS,
        intro="What do articles and engines claim, and what is measured here?",
        method="Each figure is measured as its source describes it. It is reproduced if the two agree within the "
        "printed digits and the scatter of samples. A maximum that was found by sampling lies below the supremum, "
        "which is what normalbench gives. Every other difference has its reason.",
    ),
)
