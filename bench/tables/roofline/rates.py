"""Rates of computation and memory traffic for GPUs. This module imports nothing heavy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType

from ...ground.choose import unknown_name
from ...ground.options.gpu_families import FAMILIES
from ...ground.options.words import Names
from ...ground.output.errors import UsageError
from ...ground.spelling import spelled


@dataclass(frozen=True)
class Rates:
    """The throughput of a GPU.

    Attributes:
        title: common name.
        family: GPU family whose compiler counts the instructions.
        lanes: number of lanes whose instructions the GPU issues per clock.
        clock: boost clock in GHz.
        memory: memory bandwidth in GB/s.
        cache: size of the last-level cache in MB; 0 if the cache's bandwidth is not published.
        cached: bandwidth of that cache in GB/s.
    """

    title: str
    family: str
    lanes: float
    clock: float
    memory: float
    cache: float = 0.0
    cached: float = 0.0

    @property
    def instructions(self) -> float:
        """Instructions per second, summed over all lanes."""
        return self.lanes * self.clock * 1e9

    def ridge(self, bandwidth: float) -> float:
        """Return the number of instructions that take as long as moving a byte, at a bandwidth in GB/s."""
        return self.instructions / (bandwidth * 1e9)


# Shading units, boost clock, memory bandwidth by product pages of AMD, Intel, NVIDIA, Microsoft and Valve.
# RDNA 3 issues two instructions a lane and clock where its compiler pairs them; this counts one. Cached: AMD's
# "effective memory bandwidth" with Infinity Cache. Intel's execution units compute 8 lanes.
GPUS: Mapping[str, Rates] = MappingProxyType(
    {
        "rx480": Rates("Radeon RX 480", "polaris10", 2304, 1.266, 256),
        "vega64": Rates("Radeon RX Vega 64", "vega10", 4096, 1.546, 484),
        "rx5700xt": Rates("Radeon RX 5700 XT", "navi10", 2560, 1.905, 448),
        "rx6800xt": Rates("Radeon RX 6800 XT", "navi21", 4608, 2.250, 512, 128, 1664),
        "rx7900xtx": Rates("Radeon RX 7900 XTX", "navi31", 6144, 2.500, 960, 96, 3500),
        "series_x": Rates("Xbox Series X", "navi21", 3328, 1.825, 560),
        "steam_deck": Rates("Steam Deck", "navi21", 512, 1.600, 88),
        "hd530": Rates("HD Graphics 530, two channels of DDR4-2133", "skl", 24 * 8, 1.150, 34.1),
        "iris_xe": Rates("Iris Xe of a Core i7-1185G7, LPDDR4x-4266", "tgl", 96 * 8, 1.350, 68.3),
        "a770": Rates("Arc A770", "dg2", 4096, 2.100, 560),
        "rtx2080": Rates("GeForce RTX 2080", "sm_75", 2944, 1.710, 448),
        "rtx3080": Rates("GeForce RTX 3080", "sm_86", 8704, 1.710, 760),
        "rtx4090": Rates("GeForce RTX 4090", "sm_89", 16384, 2.520, 1008),
        "rtx5090": Rates("GeForce RTX 5090", "sm_120", 21760, 2.407, 1792),
    }
)
USUAL = ("rx480", "rx6800xt", "steam_deck", "iris_xe")
# Of a GPU that misses them in a message.
SUCH = MappingProxyType({"lanes": 2304, "clock": 2.2, "memory": 448})
# The least and the most that a setting may be.
RANGES = MappingProxyType(
    {"lanes": (1.0, 1e6), "clock": (0.01, 100.0), "memory": (0.1, 1e6), "cache": (0.0, 1e5), "cached": (0.0, 1e7)}
)


def gpus_named(words: Names) -> dict[str, Rates]:
    """Return the rates of GPUs by name: of known GPUs, or with `all` of every known GPU. NAME:memory=400:clock=2
    changes rates of a known GPU; the name of a family with lanes, clock and memory defines a GPU of that family.

    Raises:
        UsageError: an unknown name or setting, or a rate that no GPU has.
    """
    if not words:
        raise UsageError(f"no GPU named; known: all, {', '.join(GPUS)}")
    several = (GPUS.items() if name == "all" else [_named_rates(name)] for name in map(str, words))
    return {word: rates for named in several for word, rates in named}


def _named_rates(word: str) -> tuple[str, Rates]:
    """Return a GPU's name, in its known spelling and with its settings, and its rates. The GPU is known, or belongs
    to a family and has settings. Raises UsageError."""
    typed, *settings = word.split(":")
    name = spelled("family", typed, (*GPUS, *FAMILIES)) or typed
    word = ":".join([name, *settings])
    pairs = [_setting(word, setting) for setting in settings]
    changed = dict(pairs)
    if len(changed) < len(pairs):
        raise UsageError(f"--gpu {word}: a rate is given twice; give each rate once")
    if name in GPUS:
        rates = replace(GPUS[name], **changed)
    elif name in FAMILIES:
        if missing := [key for key in ("lanes", "clock", "memory") if key not in changed]:
            such = ":".join([word, *(f"{key}={SUCH[key]}" for key in missing)])
            raise UsageError(f"--gpu {word}: a family requires {', '.join(missing)}; write for example {such}")
        rates = Rates(FAMILIES[name].title, name, **changed)
    else:
        listed = f"all, {', '.join(GPUS)}, or a family with its rates"
        raise UsageError(f"--gpu {word}: {unknown_name('GPU', [name], GPUS, listed)}")
    if bool(rates.cache) != bool(rates.cached):
        raise UsageError(f"--gpu {word}: cache (MB) and cached (GB/s) require each other; give both or neither")
    return word, rates


def _setting(word: str, setting: str) -> tuple[str, float]:
    name, equals, value = setting.partition("=")
    known = [field.name for field in fields(Rates) if field.name in RANGES]
    if name not in known or not equals:
        raise UsageError(f"--gpu {word}: {unknown_name('setting', [setting], known)}")
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    low, high = RANGES[name]
    if not low <= number <= high:
        raise UsageError(f"--gpu {word}: {name} is {value!r}; use {low:g} to {high:g}")
    return name, number
