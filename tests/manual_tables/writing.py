"""Formats of figures in the manual, and texts that are not plain tables."""

from .table import Measured, Table

WIDTH = 120


def two_digits(value: float) -> str:
    """Return two significant digits, without an exponent for values above 1."""
    return f"{float(f'{value:.2g}'):g}"


def or_zero(value: float) -> str:
    """Return three decimals, or 0 for exactly 0."""
    return f"{value:.3f}" if value else "0"


def percent(value: float) -> str:
    """Return two decimals; if they are 0, return the first significant digit, or 0 for exactly 0."""
    return f"{value:.2f}" if value >= 0.005 else f"{value:.1g}"


def answer(_: Table, kept: Measured) -> str:
    """Return the lines of the first storage as they are printed."""
    first, _ = kept.lines[0]
    return "\n".join(["```text", *(line for storage, line in kept.lines if storage == first), "```"])


def published(table: Table, kept: Measured) -> str:
    """Return a table for each source."""
    from published.rows import text

    names = [column.name for column in table.columns]
    return text([dict(zip(names, line, strict=True)) for line in kept.lines], WIDTH).rstrip("\n")


def simulation(table: Table, kept: Measured) -> str:
    """Return the table in the form that the simulation writes."""
    from normalbench.reports.tables import to_markdown

    titles = [column.title for column in table.columns]
    return to_markdown([dict(zip(titles, line, strict=True)) for line in kept.lines]).rstrip("\n")
