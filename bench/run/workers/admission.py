"""Which workers may measure: those that give the rows that this process would give."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...ground.output.errors import leave_out
from .about import About

# Letters of what is said of a device.
SHORT = 60


class Admission:
    """The workers that may measure, by their addresses.

    Versions, sources and the processor decide whether a worker is taken at all; devices and compilers, which steps it
    gets.

    Args:
        own: what this process says of itself.
    """

    def __init__(self, own: About):
        self._own = own
        self._taken: dict[str, About] = {}
        self._told: set[str] = set()

    def __len__(self) -> int:
        return len(self._taken)

    def __iter__(self) -> Iterator[str]:
        return iter(list(self._taken))

    def __contains__(self, address: str) -> bool:
        return address in self._taken

    def take(self, address: str, said: About) -> bool:
        """Whether a worker may measure; why it may not is said on standard error."""
        if why := self._misfit(said):
            leave_out(f"worker {said['name']}: {why}")
            return False
        self._taken[address] = said
        for name, own in self._own["can"].items():
            if (its := said["can"].get(name, "none")) != own:
                self._say_once(f"steps that need the {name}, for workers with {_short(its)} and not {_short(own)}")
        return True

    def _misfit(self, said: About) -> str:
        """Why a worker is not taken; empty where it is."""
        own, its = self._own["versions"], said["versions"]
        if differ := [f"{name} {its.get(name)} and not {own[name]}" for name in own if its.get(name) != own[name]]:
            return f"it has {', '.join(differ)}"
        for name, what in (("sources", "other sources of normalbench"), ("processor", "another processor")):
            if said[name] != self._own[name]:
                return f"it has {what}: {said[name]} and not {self._own[name]}"
        return ""

    def _say_once(self, line: str) -> None:
        """Workers that are alike are said once."""
        if line not in self._told:
            self._told.add(line)
            leave_out(line)

    def fits(self, address: str, needs: Iterable[str]) -> bool:
        """Whether a worker measures with what this process would measure with."""
        its = self._taken[address]["can"]
        return all(its.get(name) == self._own["can"][name] for name in needs)

    def host(self, address: str) -> str:
        """The machine that a worker runs on."""
        return self._taken[address]["host"]

    def lose(self, address: str) -> None:
        """Forget a worker that is gone."""
        self._taken.pop(address, None)


def _short(text: str) -> str:
    return text if len(text) <= SHORT else f"{text[:SHORT]}..."
