"""Effects: passes that read a pipeline's resources, with settings that can be given as one word of text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ..frame.contract import Pass
from ..frame.resource import Resource
from ..scenes.scene import Scene

Value = int | float | str


class EffectError(ValueError):
    """The error for an unknown effect or an invalid setting; its message is one line that says what is valid."""


@dataclass(frozen=True)
class Number:
    """A setting that is a number.

    Attributes:
        usual, least, most: its default, minimum and maximum; whole numbers if `usual` is an int.
        says: its meaning, with its unit.
    """

    usual: int | float
    least: int | float
    most: int | float
    says: str

    def read(self, text: str) -> Value:
        """Return the number in a text. Raises ValueError, with the valid range as its message, if the text is not a
        number from `least` to `most` with the type of `usual`."""
        kind = type(self.usual)
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not self.least <= value <= self.most:
            raise ValueError(f"{'a whole number' if kind is int else 'a number'} from {self.least:g} to {self.most:g}")
        return value


@dataclass(frozen=True)
class Choice:
    """A setting whose value is one of several words; the first is the default."""

    words: tuple[str, ...]
    says: str

    @property
    def usual(self) -> str:
        return self.words[0]

    def read(self, text: str) -> Value:
        """Return the text if it is one of `words`. Raises ValueError, with `words` as its message, if not."""
        if text not in self.words:
            raise ValueError(" or ".join(self.words))
        return text


@dataclass(frozen=True, eq=False)
class Effect:
    """An effect.

    Attributes:
        name, title, source: its name, its description and the publication of its method.
        result: the image that tables compare: a resource that one of its passes writes.
        passes: function that returns its passes; takes a value for each of `settings` by keyword.
        settings: the available settings, by name.
        lacks: function that returns what a scene lacks for the effect, such as "it has no skin", or None.
        scene: default scene.
        hits: the resource of the points that the pixels' rays hit: x and y in pixels, and w 1 for a hit or 0 for a
            miss; None for an effect without rays.
    """

    name: str
    title: str
    source: str
    result: Resource
    passes: Callable[..., tuple[Pass, ...]]
    settings: Mapping[str, Number | Choice] = field(default_factory=dict)
    lacks: Callable[[Scene], str | None] = lambda _: None
    scene: str = "room"
    hits: Resource | None = None


@dataclass(frozen=True)
class ChosenEffect:
    """An effect with a value for each of its settings, in the effect's order."""

    effect: Effect
    values: tuple[tuple[str, Value], ...]

    @property
    def name(self) -> str:
        """The effect as text, such as `gtao:slices=4`; settings with default values are left out."""
        settings = self.effect.settings
        own = (f"{n}={v:g}" if isinstance(v, float) else f"{n}={v}" for n, v in self.values if v != settings[n].usual)
        return ":".join([self.effect.name, *own])

    def passes(self) -> tuple[Pass, ...]:
        """Return the effect's passes."""
        return self.effect.passes(**dict(self.values))


def chosen(effect: Effect, given: Mapping[str, str]) -> ChosenEffect:
    """Return an effect with settings given as text by name; settings that are not given have their default values.

    Raises:
        EffectError: the effect has no such setting, or a value is out of range.
    """
    settings = effect.settings
    for name, text in given.items():
        if name not in settings:
            known = f"; known: {', '.join(settings)}" if settings else "; it has no settings"
            raise EffectError(f"effect {effect.name} has no setting {name!r}{known}")
        try:
            settings[name].read(text)
        except ValueError as error:
            raise EffectError(f"effect {effect.name}: {name}={text} is not {error}") from None
    values = ((n, s.read(given[n]) if n in given else s.usual) for n, s in settings.items())
    return ChosenEffect(effect, tuple(values))
