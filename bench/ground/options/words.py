"""Names as people give them: comma-separated in a text, or several from Python, some of which stand for values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeAlias

# In the name of a file.
MOST_COMMAS = 4


class Given(NamedTuple):
    """A value of a Python caller's own, under a name."""

    name: str
    value: Any

    def __str__(self) -> str:
        return self.name


Word: TypeAlias = str | Given
Names: TypeAlias = tuple[Word, ...]


def names(text: str, is_whole: Callable[[str], bool] = lambda _: False, repeats: bool = False) -> tuple[str, ...]:
    """Split a text into a tuple of comma-separated names without blanks around them: the only place where such a
    text is split.

    Args:
        is_whole: whether a text with commas is one name, such as a file's.
        repeats: whether a name that occurs twice counts twice.
    """
    parts, words = text.split(","), list[str]()
    while parts:
        several = (size for size in range(min(len(parts), MOST_COMMAS + 1), 1, -1))
        size = next((size for size in several if is_whole(",".join(parts[:size]).strip())), 1)
        words.append(",".join(parts[:size]).strip())
        parts = parts[size:]
    words = [word for word in words if word]
    return tuple(words if repeats else dict.fromkeys(words))


def text_of(words: Iterable[Word]) -> str:
    """Return names as they are typed: one text, comma-separated."""
    return ",".join(map(str, words))


def typed(value: Any) -> Any:
    """Return an option's value as the user types it: a tuple of names as one comma-separated text, else unchanged."""
    return text_of(value) if isinstance(value, tuple) else value


def words_in(value: str | Names | None) -> Names:
    """Return an option's value as a tuple of words: a text is one word, several names stay, and None has no words."""
    return (value,) if isinstance(value, str) else value or ()
