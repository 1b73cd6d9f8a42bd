"""Device objects that outlive the code that requested them."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from contextlib import ExitStack
from typing import Generic, TypeVar

T = TypeVar("T")


class Lasting(Generic[T]):
    """Objects by key, each created once. Above a maximum number, objects without users are released, starting with
    the object that was requested longest ago."""

    def __init__(self, most: int, release: Callable[[T], None]):
        self._most, self._release = most, release
        self._held: dict[Hashable, T] = {}
        self._users: dict[Hashable, int] = {}

    def used(self, stack: ExitStack, key: Hashable, make: Callable[[], T]) -> T:
        """Return the object for a key, from `make` unless it is kept; it is in use until the stack closes. Raises
        what `make` raises."""
        instance = self._held.pop(key) if key in self._held else make()
        self._held[key] = instance
        self._users[key] = self._users.get(key, 0) + 1
        stack.callback(self._leave, key)
        for old in [other for other in self._held if not self._users.get(other)][: len(self._held) - self._most]:
            self._release(self._held.pop(old))
        return instance

    def _leave(self, key: Hashable) -> None:
        self._users[key] -= 1
