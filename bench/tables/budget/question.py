"""The question that a budget answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.scenes.setting import Setting
from ...ground.choose import choose, choose_one
from ...ground.machine.devices import require_device
from ...ground.options.counts import MOST_INSTRUCTIONS, checked_numbers, in_range
from ...ground.options.targets import checked_target
from ...ground.options.words import Names, text_of
from ...ground.output.errors import UsageError
from ...ground.spelling import spelled
from ...subjects.codecs.layout_names import layouts_named
from ...subjects.environments.scenes_under import scenes_under
from ...subjects.scenes.scene_names import scene_makers_named
from ..families_named import families_named
from .attributes import EMISSION, UP_TO_PIXELS, Attribute
from .bins import BINS, WEBGPU, WEBGPU_BYTES, Bin
from .contract import MOTION, PACKED, as_known, attributes_held, held_in_stencil, names_held
from .cost import check_compilers
from .rates import CLASSES, Stage
from .readers import MOST, Readers, check_held, read_readers
from .solve import Rules
from .table import BudgetOptions

# A light buffer comes on top of the targets, and devices have eight.
MOST_BYTES, MOST_TARGETS = 64, 7
# Bytes between which the fewest for a threshold are looked for.
LEAST_LIMIT, MOST_LIMIT = 4, 40
TILES = (16, 32, 64)
WEB, TILE = "webgpu", "tile"
# Options that name attributes.
OF_ATTRIBUTES = ("hold", "blend", "read_alone", "readers")
# What belongs together because it is read together.
ONE_BYTE = frozenset({"shading_model", "flags"})


@dataclass(frozen=True)
class Question:
    """The scenes, attributes, targets and limits of a budget.

    Attributes:
        stages: scenes whose images are compared.
        attributes: attributes to store.
        bins: targets that may be used.
        rules: the rules that a layout must keep to, once for each byte limit.
        overdraw: number of times that a pixel is written.
        readers: passes that read the G-buffer.
        against: layouts to compare with.
        engines: whether engine layouts of the same kind are measured as well.
        tile: bytes per pixel that a GPU tile has at full rate; None if not requested.
        light_bytes: bytes of the light buffer that is drawn with the G-buffer; 0 if the G-buffer holds emission.
        threshold: 99th percentile of FLIP for which to find the fewest bytes; None to use the rules.
        search: smallest and largest number of bytes to search.
        judging: classes of surfaces whose worst error counts.
        families: GPU families to count issue slots for.
        most_instructions: maximum number of issue slots to pack and unpack once; None if not requested.
    """

    stages: Sequence[Stage]
    attributes: Sequence[Attribute]
    bins: Sequence[Bin]
    rules: Sequence[Rules]
    overdraw: float
    readers: Readers
    against: Sequence[Layout]
    engines: bool
    tile: int | None
    light_bytes: int
    threshold: float | None
    search: tuple[int, int]
    judging: Sequence[str]
    families: Sequence[str]
    most_instructions: int | None

    @property
    def scenes(self) -> str:
        return ",".join(stage.maker.name for stage in self.stages)


def question(options: BudgetOptions) -> Question:
    """Return the question that the options describe. Raises UsageError for options that cannot be used."""
    device = require_device()
    named = {name: as_known(getattr(options, name)) for name in OF_ATTRIBUTES if getattr(options, name)}
    options = _of_held(replace(options, **named))
    sizes = checked_numbers("--bytes", options.bytes, int, 1, MOST_BYTES)
    in_range("--targets", options.targets, 1, MOST_TARGETS)
    in_range("--overdraw", options.overdraw, 0.0, MOST)
    readers = read_readers(options.readers)
    in_range("--speed", options.speed, 0.0, max(UP_TO_PIXELS.values()))
    held = attributes_held(options.hold, options.speed)
    names = [attribute.name for attribute in held]
    check_held(readers, names, held_in_stencil(options.hold))
    blended = frozenset(names_held("--blend", options.blend, names))
    together = ONE_BYTE & {*names}
    size, _ = checked_target(options.size, 1, 1, device)
    webgpu, tile = _limits(options)
    light = choose_one("light buffer", options.light, LIGHT_BUFFERS)
    if EMISSION.name in names:
        light_bytes, webgpu_left = 0, WEBGPU_BYTES
    else:
        light_bytes = LIGHT_BUFFERS[light].bytes_per_pixel
        webgpu_left = WEBGPU_BYTES - _webgpu_cost(light) if webgpu else 0
    sets = (together,) if len(together) > 1 else ()
    is_packed = PACKED in options.hold
    apart = frozenset() if is_packed else frozenset({MOTION} & {*names})
    left = webgpu_left if webgpu else None
    alone = _read_alone(options.read_alone, names)
    rules = [Rules(limit, options.targets, blended, sets, left, apart, read=alone) for limit in sorted(sizes)]
    judging = tuple(choose("class", options.classes, {name: name for name in CLASSES}))
    families = families_named(options.family)
    if options.most_instructions is not None:
        in_range("--most-instructions", options.most_instructions, 0, MOST_INSTRUCTIONS)
        check_compilers(families)
    if options.threshold is not None:
        in_range("--threshold", options.threshold, 0.001, 1.0)
    return Question(
        stages=_stages(options, size),
        attributes=held,
        bins=_bins(options, webgpu),
        rules=rules,
        overdraw=options.overdraw,
        readers=readers,
        against=layouts_named(options.against) if options.against else [],
        engines=options.engines,
        tile=tile,
        light_bytes=light_bytes,
        threshold=options.threshold,
        search=(LEAST_LIMIT, MOST_LIMIT),
        judging=judging,
        families=families,
        most_instructions=options.most_instructions,
    )


def _of_held(options: BudgetOptions) -> BudgetOptions:
    """Return the options; --read-alone and --readers lose attributes that are not held, if they are the defaults."""
    usual, held = BudgetOptions(), {str(word).partition(":")[0] for word in options.hold}
    if options.read_alone == usual.read_alone:
        options = replace(options, read_alone=tuple(name for name in usual.read_alone if name in held) or ("none",))
    if options.readers == usual.readers and not {*usual.read_alone} <= held:
        options = replace(options, readers=usual.readers[:1])
    return options


def _read_alone(attributes: Names, names: Sequence[str]) -> frozenset[str]:
    """Return the attributes of --read-alone, which a pass reads without the rest; empty for `none`. Raises UsageError
    for attributes that are not held."""
    return frozenset() if attributes == ("none",) else frozenset(names_held("--read-alone", attributes, names))


def _webgpu_cost(light: str) -> int:
    """Return a light buffer's bytes per sample in WebGPU. Raises UsageError if WebGPU cannot render to it."""
    name = LIGHT_BUFFERS[light].storage.target.name
    if name not in WEBGPU:
        raise UsageError(f"--light {light}: WebGPU does not render to this format; use r11g11b10f or rgba16f")
    return WEBGPU[name][0]


def _limits(options: BudgetOptions) -> tuple[bool, int | None]:
    """Return whether WebGPU's limit applies, and the tile's bytes per pixel, None without a tile limit. Raises
    UsageError for unknown limits."""
    webgpu, tile = False, None
    for word in map(str, options.limit or ()):
        prefix, _, size = word.partition(":")
        name = spelled("limit", prefix, (WEB, TILE))
        if name == WEB and not size:
            webgpu = True
        elif name == TILE and size.isdigit() and int(size) in TILES:
            tile = int(size)
        else:
            raise UsageError(
                f"--limit {word}: unknown; use {WEB}, {', '.join(f'{TILE}:{tile_size}' for tile_size in TILES)}"
            )
    return webgpu, tile


def _stages(options: BudgetOptions, size: tuple[int, int]) -> list[Stage]:
    stages = [
        Stage(maker, Setting(), maker.within(size))
        for maker in scenes_under(options.environment, scene_makers_named(options.scene))
    ]
    for stage in stages:
        if not stage.maker.is_metal_rough:
            raise UsageError(
                f"{stage.maker.name}: no metallic-roughness materials, which budget requires; use for example studio"
            )
    return stages


def _bins(options: BudgetOptions, webgpu: bool) -> list[Bin]:
    known = {target_bin.format: target_bin.format for target_bin in BINS.values()}
    chosen = set(choose("format", options.formats, known))
    is_said = "all" not in options.formats
    bins = [
        target_bin for target_bin in BINS.values() if target_bin.format in chosen and (target_bin.is_usual or is_said)
    ]
    bins = [target_bin for target_bin in bins if not webgpu or target_bin.format in WEBGPU]
    if not options.fields or not options.integers:
        bins = [target_bin for target_bin in bins if not target_bin.fields]
    if not options.fields:
        bins = [replace(target_bin, shares=False) for target_bin in bins]
    if not bins:
        raise UsageError(
            f"--formats {text_of(options.formats)}: --limit and --no-integers allow none of these; use other formats"
        )
    return bins
