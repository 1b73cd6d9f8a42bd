"""Specifications for charts that are no values of `chart.py`: those of how this program itself behaves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .chart import INK as INK_ROLE
from .chart import Row
from .vega import ACROSS, CONFIG, PICKED, ROLES, Spec, if_lit, rounded
from .vega import PALETTE as PALETTE

INK = ROLES[INK_ROLE]


def spec(rows: Sequence[Row], description: str, **parts: Any) -> Spec:
    """A specification of rows, with the parameters that all have."""
    common = {"description": description, "width": "container", "config": CONFIG}
    params = [PICKED, ACROSS, *parts.pop("params", ())]
    return common | {"data": {"values": list(rows)}, "params": params} | parts


def tips(**fields: str) -> list[Spec]:
    """What a pointer is told: fields, and what they are called."""
    return [{"field": name, "title": title} for name, title in fields.items()]


__all__ = ["INK", "PALETTE", "Spec", "if_lit", "rounded", "spec", "tips"]
