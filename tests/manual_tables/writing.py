"""How figures of the manual are written, and texts that are no plain table."""

from .table import Measured, Table

WIDTH = 120


def two_digits(value: float) -> str:
    """Two digits that count, without an exponent above 1."""
    return f"{float(f'{value:.2g}'):g}"


def or_zero(value: float) -> str:
    """Three decimals, and 0 where it is exactly 0."""
    return f"{value:.3f}" if value else "0"


def percent(value: float) -> str:
    """Two decimals; where they would be 0, the first digit, which of exactly 0 is 0."""
    return f"{value:.2f}" if value >= 0.005 else f"{value:.1g}"


def answer(_: Table, kept: Measured) -> str:
    """The lines of the first storage as they are printed."""
    first, _ = kept.lines[0]
    return "\n".join(["```text", *(line for storage, line in kept.lines if storage == first), "```"])


def published(table: Table, kept: Measured) -> str:
    """A table for each source."""
    from published.rows import text

    names = [column.name for column in table.columns]
    return text([dict(zip(names, line, strict=True)) for line in kept.lines], WIDTH).rstrip("\n")


def simulation(table: Table, kept: Measured) -> str:
    """As the simulation writes it."""
    from normalbench.reports.tables import to_markdown

    titles = [column.title for column in table.columns]
    return to_markdown([dict(zip(titles, line, strict=True)) for line in kept.lines]).rstrip("\n")
