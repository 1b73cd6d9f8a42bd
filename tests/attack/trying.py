"""Cases in a process of their own: how they ended, and which outcomes are not allowed."""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

HERE = Path(__file__).parent
if __name__ == "__main__":
    sys.path[:1] = [str(HERE.parent), str(HERE.parent / "inputs")]
    from compiled import COMPILED

    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(COMPILED / "jax"))

from attack import code, files, forms, interruptions, judge, texts, translations, words  # noqa: E402 # the folders above hold it
from attack.kind import Attack, Kind  # noqa: E402

KINDS = (
    *files.KINDS,
    *texts.KINDS,
    *words.KINDS,
    *code.KINDS,
    *translations.KINDS,
    *forms.KINDS,
    *judge.KINDS,
    *interruptions.KINDS,
)
BY_NAME = {kind.name: kind for kind in KINDS}
ODD = "else"
# More than any case may take for itself, in bytes.
MEMORY = 4 << 30
# After so many odd cases a chunk has said enough.
ENOUGH = 5


@dataclass(frozen=True)
class Chunk:
    """Cases of one kind with consecutive seeds."""

    kind: str
    first: int
    count: int

    @property
    def name(self) -> str:
        return f"{self.kind} {self.first}+{self.count}"

    def halves(self) -> list[Chunk]:
        """Return the two halves of the chunk; a single case stays whole."""
        if self.count == 1:
            return [self]
        half = self.count // 2
        return [Chunk(self.kind, self.first, half), Chunk(self.kind, self.first + half, self.count - half)]


def chunks_of(cases: int, seed: int) -> list[Chunk]:
    """Return the cases of every kind, about as many in total as requested; the slowest kinds come first."""
    share = cases / sum(kind.cases for kind in KINDS)
    chunks = [chunk for kind in KINDS for chunk in _chunks(kind, max(round(kind.cases * share), 1), seed)]
    return sorted(chunks, key=lambda chunk: -BY_NAME[chunk.kind].seconds)


def _chunks(kind: Kind, cases: int, seed: int) -> Iterator[Chunk]:
    for first in range(0, cases, kind.chunk):
        yield Chunk(kind.name, seed + first, min(kind.chunk, cases - first))


def limit_of(chunk: Chunk) -> float:
    """Return the seconds after which a chunk's process counts as hanging, not slow."""
    return 120 + chunk.count * BY_NAME[chunk.kind].seconds


class TooLongError(BaseException):
    """A case took longer than allowed; no `except Exception` of the product catches this error."""


def _too_long(*_: object) -> NoReturn:
    raise TooLongError


def tried(chunk: Chunk) -> tuple[Counter[str], list[str]]:
    """Return how the cases ended, and a line for each of the first few that ended in a way that is not allowed."""
    kind, counts, lines = BY_NAME[chunk.kind], Counter[str](), []
    here = Path.cwd()
    with tempfile.TemporaryDirectory(prefix="attack-", ignore_cleanup_errors=True) as folder:
        try:
            try:
                attack = kind.prepare(Path(folder))
            except Exception as error:
                return Counter({ODD: 1}), [f"not begun: {error}"]
            for seed in range(chunk.first, chunk.first + chunk.count):
                ended, why = one(attack, kind, seed)
                counts[ended] += 1
                lines += [f"seed {seed}: {why}"] * (ended == ODD and len(lines) < ENOUGH)
        finally:
            os.chdir(here)
    return counts, lines


def one(attack: Attack, kind: Kind, seed: int) -> tuple[str, str]:
    """Return how a case ended, and the reason if that is not allowed."""
    signal.signal(signal.SIGALRM, _too_long)
    # A case that waits for a pipe takes no processor time.
    signal.setitimer(signal.ITIMER_REAL, 5 * kind.seconds + 5)
    began = time.process_time()
    try:
        ended = attack(seed)
        taken = time.process_time() - began
        return (ended, "") if taken < kind.seconds else (ODD, f"{taken:.1f} s")
    except TooLongError:
        return ODD, f"not within {5 * kind.seconds + 5:g} s"
    except BaseException as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return ODD, f"{type(error).__name__}: {str(error)[:300]!r} at {Path(place.filename).name}:{place.lineno}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
    kind, first, count = sys.argv[1:]
    print(json.dumps(tried(Chunk(kind, int(first), int(count)))))
