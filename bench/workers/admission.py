"""Which workers may measure: those that give the rows that this process would give."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from ..output.errors import by_reason, leave_out
from .about import About

# What is short enough to be said whole.
SHORT = 60


class Admission:
    """The workers that answered, and which of them may measure.

    Versions, sources and the processor decide whether a worker is taken at all; devices and compilers, which steps it
    gets. All workers have one processor: the one that most of the first of them have, this process's where that is
    undecided.

    Attributes:
        processor: that processor; empty until it is known.
    """

    def __init__(self, own: About):
        self.own, self.processor = own, ""
        self._taken: dict[str, About] = {}
        self._told: set[str] = set()

    def __len__(self) -> int:
        return len(self._taken)

    def __contains__(self, address: str) -> bool:
        return address in self._taken

    def take(self, several: Mapping[str, About | str]) -> None:
        """Take workers that may measure, by their addresses, and name the others on standard error.

        Args:
            several: what each says of itself; or a text, why it says nothing.
        """
        known = {address: said for address, said in several.items() if isinstance(said, dict)}
        if known and not self.processor:
            self.processor = self._usual(known.values())
        refused: list[tuple[str, str]] = []
        for address, said in several.items():
            if why := said if isinstance(said, str) else self._misfit(said):
                refused.append((f"worker {address}", why))
            elif isinstance(said, dict):
                self._taken[address] = said
        for line in by_reason(refused):
            leave_out(line)
        for address in known.keys() & self._taken.keys():
            self._say_what_differs(self._taken[address])

    def _usual(self, several: Iterable[About]) -> str:
        own = self.own["processor"]
        found = Counter(one["processor"] for one in several)
        return max(found, key=lambda name: (found[name], name == own))

    def _misfit(self, said: About) -> str:
        """Why a worker is not taken; empty where it is."""
        own, its = self.own["versions"], said["versions"]
        differ = [f"{name} {its.get(name)} and not {own[name]}" for name in own if its.get(name) != own[name]]
        if differ:
            return f"it has {', '.join(differ)}"
        if said["sources"] != self.own["sources"]:
            return f"its normalbench has other sources ({said['sources']} and not {self.own['sources']})"
        if said["processor"] != self.processor:
            return f"its processor is {said['processor']} and not {self.processor}: figures could differ"
        return ""

    def _say_what_differs(self, said: About) -> None:
        """A line for each device that a worker has not, once for all workers that are alike."""
        for name, own in self.own["can"].items():
            its = said["can"].get(name, "none")
            line = f"steps that need the {name}, on workers with another one: {_short(its)} and not {_short(own)}"
            if its != own and line not in self._told:
                self._told.add(line)
                leave_out(line)

    def fits(self, address: str, needs: Iterable[str]) -> bool:
        """Whether a worker measures with what this process would measure with."""
        its = self._taken[address]["can"]
        return all(its.get(name) == self.own["can"][name] for name in needs)

    def host(self, address: str) -> str:
        """The machine that a worker runs on."""
        return self._taken[address]["host"]

    def lose(self, address: str) -> None:
        """A worker is gone."""
        self._taken.pop(address, None)

    def lose_all(self) -> None:
        """The scheduler is gone, and with it what it called its workers."""
        self._taken.clear()


def _short(text: str) -> str:
    return text if len(text) <= SHORT else f"{text[:SHORT]}..."
