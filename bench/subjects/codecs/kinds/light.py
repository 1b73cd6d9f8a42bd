"""Users' own codes of light."""

from __future__ import annotations

from typing import Any

import numpy as np

from .....encodings.codecs.light_encoding import LightEncoding
from .....encodings.kinds import LIGHT
from .....encodings.storages.storage import LIGHT_STORAGES
from .....gbuffer.codecs.own.own_passes import Tried
from .....gbuffer.gl.device import Device
from ....ground.choose import choose
from ....ground.output.errors import UsageError
from .own import COUNT, SEED, Own, OwnKind, Values, longest, numbers, rows

# Lights from 2^-10 to the largest half; how far one that is held comes back off.
DIMMEST, BRIGHTEST, LIGHT_NEARLY = 2.0**-10, 65504.0, 0.03
# Half a step of a format of 8 bits, which a code may lead beyond 1.
OF_8_BITS = 0.5 / 255
# How far two lights that are added as codes come back off, in shares of their sum.
ADDED = 1e-3
NO_FOURTH = "its fourth component does not round-trip: only the three colour channels are measured"
FORMATS = ("rgba8", "rgba16f")
NOT_BLACK = "a cleared texel ({0:g} in all channels) decodes to a light of {1:.3g}, not 0"


def _lights(own: Own) -> Values:
    """Return random four-component colours up to the limit, spread evenly over eight powers of two."""
    random = np.random.default_rng(SEED)
    largest = own.found.get("limit", 1.0)
    bright = largest * 2.0 ** random.uniform(-8, 0, (COUNT, 1)) * random.uniform(0, 1, (COUNT, 4))
    return Values(bright.astype(np.float32), rows(np.zeros(COUNT)))


def _light_errors(values: Values, trial: Tried) -> np.ndarray:
    """Return the errors in colours, relative to the brightest component or to 1/256, whichever is larger."""
    return _light_apart(values.given, trial.back[0])[:, :3].max(axis=1)


def _light_apart(given: np.ndarray, back: np.ndarray) -> np.ndarray:
    brightest = np.maximum(given.astype(np.float64).max(axis=1, keepdims=True), 2.0**-8)
    return np.abs(back.astype(np.float64) - given) / brightest


def _light_facts(own: Own, gl: Device) -> dict[str, Any]:
    """Return findings by name: `limit`, the brightest white that round-trips with codes in [0, 1]; `open_limit`, the
    brightest with any codes; `is_open`, whether the codes need a float format; and the findings of `_added`."""
    white = np.geomspace(DIMMEST, BRIGHTEST, COUNT)
    values = Values(np.repeat(rows(white)[:, :1], 4, axis=1), rows(np.zeros(COUNT)))
    trial = own.tried(gl, values.given, values.more)
    comes_back = _light_errors(values, trial) < LIGHT_NEARLY
    codes = trial.codes[:, : own.made.components]
    is_in = comes_back & np.all((codes >= -OF_8_BITS) & (codes <= 1 + OF_8_BITS), axis=1)
    (_, limit), (_, open_limit) = (longest(white, some) or (0.0, 0.0) for some in (is_in, comes_back))
    is_open = limit < 0.5 < open_limit
    facts: dict[str, Any] = {"limit": float(f"{limit:.3g}"), "open_limit": open_limit, "is_open": is_open}
    held = _lights(Own(own.file, own.made, {"limit": 0.25 * (open_limit if is_open else limit) or 1.0}))
    return facts | _added(own, gl, held)


def _added(own: Own, gl: Device, held: Values) -> dict[str, Any]:
    """Return findings by name: `blend`, how texels of light add up ("add" or "multiply" for codes, otherwise "read");
    `has_alpha`, whether the fourth component round-trips; `notes`; and `wrong` if a cleared target is not black."""
    trial = own.tried(gl, held.given, held.more)
    both = held.given + held.given[::-1]
    blend = "read"
    for name, codes in (("add", trial.codes + trial.codes[::-1]), ("multiply", trial.codes * trial.codes[::-1])):
        back = own.tried(gl, held.given, held.more, codes).back[0]
        if blend == "read" and bool((_light_apart(both, back)[:, :3] < ADDED).all()):
            blend = name
    wide = own.size("light") == (4, 4)
    has_alpha = wide and bool((_light_apart(held.given, trial.back[0])[:, 3] < LIGHT_NEARLY).all())
    cleared = 1.0 if blend == "multiply" else 0.0
    (black,) = own.tried(gl, held.given[:1], held.more[:1], np.full((1, 4), cleared, np.float32)).back[0]
    glows = not abs(black[:3]).max() < LIGHT_NEARLY
    findings = {"wrong": [NOT_BLACK.format(cleared, float(abs(black[:3]).max()))]} if glows else {}
    notes = [NO_FOURTH] if wide and not has_alpha and np.ptp(trial.back[0][:, 3]) > 0 else []
    return {"blend": blend, "has_alpha": has_alpha, "notes": notes} | findings


def _light_encoding(own: Own) -> LightEncoding:
    """Return the encoding in the format that the file's name gives, or else in a format that holds its codes. Raises
    UsageError for an unknown format, or a format with too few channels."""
    is_open = own.found.get("is_open", False)
    (kept,) = choose("format", [own.file.settings.format or FORMATS[is_open]], LIGHT_STORAGES)
    if kept.channels < own.made.components:
        message = f"its code has {own.made.components} components, but {kept.title} has {kept.channels} channels"
        raise UsageError(f"{own.file}: {message}")
    floats = kept.kind == "float"
    limit = own.found["open_limit" if floats else "limit"]
    if floats and limit >= BRIGHTEST:
        limit = kept.largest
    return LightEncoding(
        **own.described(),
        storages=(kept.name,),
        blend=own.found["blend"],
        has_alpha=own.found["has_alpha"],
        limit=limit,
    )


KIND = OwnKind(
    kind=LIGHT,
    values=_lights,
    errors=_light_errors,
    unit="of the brightest channel",
    nearly=LIGHT_NEARLY,
    exactly=lambda _: {},
    encoding=_light_encoding,
    facts=_light_facts,
    said=numbers,
    rounded=OF_8_BITS,
)
