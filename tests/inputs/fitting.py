"""A check of which encodings fit a target together, independent of the program that packs them."""

import math

from normalbench.bench.tables.budget.bins import SHARED, Bin


def _holds(one: Bin, codes) -> bool:
    """Whether encodings fit a target together: in its bits, or in its channels and bytes, shared bit by bit."""
    needs = [one.need(code) for code in codes]
    if None in needs:
        return False
    if one.fields:
        return sum(code.total_bits for code in codes) <= one.fields
    taken: dict = {}
    for need in needs:
        for channel, count in need.items():
            taken[channel] = taken.get(channel, 0) + count
    taken["unorm", one.part] = taken.get(("unorm", one.part), 0) + math.ceil(taken.pop(SHARED, 0))
    return all(count <= one.channels.get(channel, 0) for channel, count in taken.items())


def fit(codes, homes) -> bool:
    """Whether encodings fit their targets, one target for each."""
    placed = list(zip(codes, homes, strict=True))
    return all(_holds(home, [code for code, place in placed if place is home]) for home in set(homes))
