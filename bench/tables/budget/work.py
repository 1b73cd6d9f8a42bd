"""How the budget table is measured and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.storages.storage import TARGET_FORMATS
from ....gbuffer.scenes.setting import Setting
from ...ground.choose import choose, choose_one
from ...ground.machine.devices import require_device, require_jax
from ...ground.options.counts import MOST_INSTRUCTIONS, checked_numbers, in_range
from ...ground.options.scene_names import scene_makers_named
from ...ground.options.targets import checked_target
from ...ground.output.errors import UsageError, tell
from ...ground.output.writing import check_folder, write_text
from ...measures.metrics.images import require_flip
from ...subjects.codecs.layout_names import layouts_named
from ...subjects.environments.scenes_under import scenes_under
from ..table import Measured, Row, Sheet, Step, Tick, Work
from .attributes import EMISSION, UP_TO_PIXELS
from .bins import BINS, WEBGPU, WEBGPU_BYTES, Bin
from .charts import charts
from .contract import MOTION, PACKED, attributes_held, names_held
from .cost import check_compilers, families_counted
from .measure import IMPROVED, MINE, PROPOSAL, Question, in_order, measure
from .rates import CLASSES, Stage
from .readers import MOST, check_held, read_readers
from .sentences import told
from .solve import Rules
from .table import TABLE, BudgetOptions, BudgetOutputs
from .written import file_of

# A light buffer comes on top of the targets, and devices have eight.
MOST_BYTES, MOST_TARGETS = 64, 7
# Bytes between which the fewest for a threshold are looked for.
LEAST_LIMIT, MOST_LIMIT = 4, 40
TILES = (16, 32, 64)
WEB, TILE = "webgpu", "tile"
# The rows whose layouts are this table's own.
WRITTEN = (PROPOSAL, IMPROVED)
# What belongs together because it is read together.
ONE_BYTE = frozenset({"id", "flags"})
SHOWN = (
    "layout",
    "bytes_per_pixel",
    "contract_bytes",
    "worst_db",
    "worst_class",
    "psnr_db",
    "flip_p99",
    "slots",
    "next_bytes",
    "next_db",
)


def question(options: BudgetOptions) -> Question:
    """What is asked for. Raises UsageError for what cannot be asked."""
    device = require_device()
    sizes = checked_numbers("--bytes", options.bytes, int, 1, MOST_BYTES)
    in_range("--targets", options.targets, 1, MOST_TARGETS)
    in_range("--overdraw", options.overdraw, 0.0, MOST)
    readers = read_readers(options.readers)
    in_range("--speed", options.speed, 0.0, max(UP_TO_PIXELS.values()))
    held = attributes_held(options.hold, options.speed)
    names = [one.name for one in held]
    check_held(readers, names)
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
    is_packed = PACKED in [word.strip() for word in options.hold.split(",")]
    apart = frozenset() if is_packed else frozenset({MOTION} & {*names})
    left = webgpu_left if webgpu else None
    alone = _read_alone(options.read_alone, names)
    rules = [Rules(limit, options.targets, blended, sets, left, apart, read=alone) for limit in sorted(sizes)]
    judging = tuple(choose("class", options.classes, {name: name for name in CLASSES}))
    families = families_counted(options.family)
    if options.most_instructions is not None:
        in_range("--most-instructions", options.most_instructions, 0, MOST_INSTRUCTIONS)
        check_compilers(families)
    if options.threshold is not None:
        in_range("--threshold", options.threshold, 0.001, 1.0)
        require_flip("--threshold")
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


def _read_alone(said: str, names: Sequence[str]) -> frozenset[str]:
    """What a pass reads by itself. Raises UsageError for what is not held."""
    return frozenset() if said.strip() == "none" else frozenset(names_held("--read-alone", said, names))


def _webgpu_cost(light: str) -> int:
    """Raises UsageError for a light buffer that WebGPU does not render to."""
    name = LIGHT_BUFFERS[light].storage.target.name
    if name not in WEBGPU:
        raise UsageError(f"--light {light}: WebGPU does not render to it; it does to r11g11b10f and rgba16f")
    return WEBGPU[name][0]


def _limits(options: BudgetOptions) -> tuple[bool, int | None]:
    """Whether WebGPU's limit holds, and the bytes of a tile's pixel. Raises UsageError for a limit that is none."""
    webgpu, tile = False, None
    for word in filter(None, map(str.strip, (options.limit or "").split(","))):
        name, _, size = word.partition(":")
        if word == WEB:
            webgpu = True
        elif name == TILE and size.isdigit() and int(size) in TILES:
            tile = int(size)
        else:
            raise UsageError(f"--limit {word}: {WEB}, {', '.join(f'{TILE}:{one}' for one in TILES)}")
    return webgpu, tile


def _stages(options: BudgetOptions, size: tuple[int, int]) -> list[Stage]:
    made = [
        Stage(maker, Setting(), size) for maker in scenes_under(options.environment, scene_makers_named(options.scene))
    ]
    for stage in made:
        if not stage.maker.is_metal_rough:
            raise UsageError(f"{stage.maker.name} has no metal/rough materials, which a budget is of; studio has")
    return made


def _bins(options: BudgetOptions, webgpu: bool) -> list[Bin]:
    known = {one.format: one.format for one in BINS.values()}
    chosen = set(choose("format", options.formats, known))
    is_said = options.formats.strip() != "all"
    found = [one for one in BINS.values() if one.format in chosen and (one.is_usual or is_said)]
    found = [one for one in found if not webgpu or one.format in WEBGPU]
    if not options.fields or not options.integers:
        found = [one for one in found if not one.fields]
    if not options.fields:
        found = [replace(one, shares=False) for one in found]
    if not found:
        raise UsageError(f"--formats {options.formats}: no target is left of what --limit and --no-integers allow")
    return found


def _steps(options: BudgetOptions, outputs: BudgetOutputs) -> list[Step]:
    require_jax()
    asked = question(options)
    if outputs.layouts:
        check_folder(outputs.layouts)
    count = sum(code.trip is not None for one in asked.attributes for code in one.codes) * len(asked.stages)
    return [Step(_key(options), asked, asked.scenes, count + len(asked.rules) + len(asked.against))]


def _write(done: Measured, _: Tick) -> None:
    folder = done.outputs.layouts
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
    for row in done.rows if folder else ():
        if row["kind"] in WRITTEN and not row["skipped"]:
            path = folder / f"{row['layout']}.toml"
            write_text(lambda row=row: file_of(row), path)
            tell(f"{path}: {row['bytes_per_pixel']} bytes a pixel")


def _key(options: BudgetOptions) -> Row:
    return {name: getattr(options, name) for name in options.__dataclass_fields__}


def _measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    for step in steps:
        yield measure(require_device(), step.case, tick)


def _sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """For each limit what to take, in sentences and target by target, and what somebody's layout could be; then all
    layouts."""
    for row in rows:
        if row["kind"] == MINE and row["changes"]:
            yield Sheet("", [], said=(f"{row['layout']}: {row['changes']}",))
        if row["kind"] in WRITTEN:
            words = row["targets"].split("; ") if row["targets"] else []
            targets = [_target_row(at, text) for at, text in enumerate(words)]
            name = f"{row['limit']} bytes" if row["kind"] == PROPOSAL else row["layout"]
            yield Sheet(f"{name}, target by target" if targets else "", targets, said=tuple(told(row)))
    shown = [{name: row[name] for name in SHOWN} for row in rows if row["worst_db"] is not None]
    if shown:
        yield Sheet("layouts, by bytes", shown, TABLE.drops(shown))


def _target_row(at: int, text: str) -> Row:
    name, holds = text.split(": ", 1)
    size = TARGET_FORMATS[name].texel_bytes
    return {"target": f"{at}: {name}, {size} byte{'s' * (size > 1)}", "holds": holds}


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    proposals = [row for row in rows if row["kind"] == PROPOSAL]
    if proposals and all(row["skipped"] for row in proposals):
        yield str(proposals[0]["skipped"])


WORK = Work(
    steps=_steps,
    measure=_measure,
    finish=in_order,
    shown=lambda done: _sheets(done.rows),
    summary=_sheets,
    failures=_failures,
    write=_write,
    charts=charts,
)
