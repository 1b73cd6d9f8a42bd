"""The fastest encodings on each GPU, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..table import Row

# A size and a number of reads.
Place = tuple[str, int]


def answers(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return a sentence for each GPU, or for GPUs with the same answer together; several sentences have a heading.

    Args:
        rows: the ranked rows of the table.
    """
    sentences = list(_answers_by_gpu(rows))
    return tuple(["The fastest encodings on each GPU:", *sentences] if len(sentences) > 1 else sentences)


def _answers_by_gpu(rows: Sequence[Row]) -> Iterator[str]:
    known = [row for row in rows if row["rank"] is not None]
    places = list(dict.fromkeys((row["size"], row["reads"]) for row in known))
    groups: dict[str, list[str]] = {}
    for gpu in dict.fromkeys(row["gpu"] for row in known):
        groups.setdefault(_answer_text([row for row in known if row["gpu"] == gpu], places), []).append(gpu)
    yield from (f"{_listed_text(gpus)}: {answer}." for answer, gpus in groups.items())


def _answer_text(rows: Sequence[Row], places: Sequence[Place]) -> str:
    """Return text on the fastest codecs for each combination of size and reads; combinations with the same codecs are
    named together."""
    groups: dict[str, list[Place]] = {}
    for size, reads in places:
        best = [row for row in rows if (row["size"], row["reads"], row["rank"]) == (size, reads, 1)]
        groups.setdefault(_codes_text(best), []).append((size, reads))
    if len(groups) == 1:
        return f"{next(iter(groups))}{' in every case' if len(places) > 1 else ''}"
    return "; ".join(f"{codes} {_places_text(group, places)}" for codes, group in groups.items())


def _codes_text(rows: Sequence[Row]) -> str:
    """Return text on the fastest codecs, such as "spheremap and octahedral in rg8 are equally fast"."""
    by_storage: dict[str, list[str]] = {}
    for row in rows:
        by_storage.setdefault(row["storage"], []).append(row["encoding"])
    many = "are equally fast" if len(rows) > 1 else "is the fastest"
    return f"{_listed_text([f'{_listed_text(names)} in {storage}' for storage, names in by_storage.items()])} {many}"


def _places_text(some: Sequence[Place], every: Sequence[Place]) -> str:
    """Return text on some combinations of size and reads: only sizes, or only reads, if these distinguish them from
    the other combinations."""
    sizes, reads = (list(dict.fromkeys(column)) for column in zip(*some, strict=True))
    if sum(size in sizes for size, _ in every) == len(some):
        return f"at {_listed_text(sizes)}"
    if sum(count in reads for _, count in every) == len(some):
        return f"with {_reads_text(reads)}"
    return f"at {_listed_text([f'{size} with {_reads_text([count])}' for size, count in some])}"


def _reads_text(counts: Sequence[int]) -> str:
    return f"{_listed_text([str(count) for count in counts])} {'read' if list(counts) == [1] else 'reads'}"


def _listed_text(names: Sequence[str]) -> str:
    """Return names joined into one text, with commas, and with "and" before the last name."""
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
