"""The `code --of layout` command: writes functions that pack and unpack a whole G-buffer, and verifies them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from ...encodings.catalogue import ENCODINGS
from ...gbuffer.layouts.layout import Layout
from ...gbuffer.layouts.presets import LAYOUTS
from ..ground.machine.systems.people import command_line
from ..ground.options.code import CodeOptions
from ..ground.output.errors import UsageError, tell
from ..shaders.code.whole.emit import GBufferCode, gbuffer_code
from ..shaders.code.whole.head import head
from ..shaders.code.whole.run import NOT_RUN as NEVER_RUN
from ..shaders.code.whole.verify import agreement
from ..shaders.translator.writer import identifier
from ..subjects.codecs.layout_names import layouts_named
from .code_rows import DIFFERS, NOT_RUN, VERIFIED, WITNESSES, Row, check_codes, check_place, compared, save, witness

LAYOUT, ENDING = "layout", ".toml"


def is_of_layouts(options: CodeOptions) -> bool:
    """Whether the options name layouts, by `--of layout` or as layout files."""
    return options.of == LAYOUT or (not options.of and all(str(word).endswith(ENDING) for word in options.codec))


def check_no_layout(options: CodeOptions) -> None:
    """Raise UsageError if `options` name a layout where an encoding is expected, without `--of`."""
    for word in map(str, options.codec):
        if not options.of and word in LAYOUTS and word not in ENCODINGS:
            raise UsageError(f"{word} is a layout; use: normalbench code {word} --of {LAYOUT}")


def gbuffer_command(options: CodeOptions, languages: Sequence[str], format: str, output: Path | None) -> int:
    """Write the code of layouts or, with `check`, a table of how the code was verified. Return the exit status: 1 if
    any code differs.

    Raises:
        UsageError: a name is unknown, a layout is not supported, or a file cannot be written.
    """
    if options.storage:
        raise UsageError("--storage cannot be used with layouts; a layout has its own formats")
    layouts = layouts_named(options.codec)
    if options.prefix and len(layouts) > 1 and not options.check:
        raise UsageError(f"--prefix {options.prefix}: names of {len(layouts)} layouts would collide; name one layout")
    # Layouts that lie in one folder may be used together.
    prefixes = {
        layout.name: options.prefix or (identifier(layout.name) if len(layouts) > 1 else "") for layout in layouts
    }
    codes = [gbuffer_code(layout, language, prefixes[layout.name]) for layout in layouts for language in languages]
    if options.check:
        return check_codes(codes, verified, ("layout", "bytes_per_pixel"), format, output)
    check_place(output, len(codes))
    return max(
        _write_layout(layout, codes, replace(options, prefix=prefixes[layout.name]), output) for layout in layouts
    )


def _write_layout(layout: Layout, codes: Sequence[GBufferCode], options: CodeOptions, output: Path | None) -> int:
    """Write a layout's files, and return 0. If the results of any file differ, return 1 and write no file, because
    all files are generated from one syntax tree."""
    rows = [(code, verified(code)) for code in codes if code.layout is layout]
    if not any(row["verdict"] == VERIFIED for _, row in rows):
        rows += witness((gbuffer_code(layout, name, options.prefix) for name in WITNESSES), verified)
    wrong = [row for _, row in rows if row["verdict"] == DIFFERS]
    for row in wrong:
        tell(f"{layout.name} in {row['language']}: {row['says']}; {layout.name} is not written")
    for code, row in rows if not wrong else ():
        if code.language in {other.language for other in codes}:
            save(code, head(code, _command(code, options), row["says"]), output)
    return int(bool(wrong))


def _command(code: GBufferCode, options: CodeOptions) -> str:
    words = map(str, options.codec)
    files = [word for word in words if word.endswith(ENDING) and Path(word).stem == code.layout.name]
    named = [Path(files[0]).name] if files else [code.layout.name, "--of", LAYOUT]
    prefix = ["--prefix", options.prefix] if options.prefix else []
    return command_line(["normalbench", "code", *named, "--to", code.language, *prefix])


def verified(code: GBufferCode) -> Row:
    """Run a file, and return a row: the layout, the language, and how its results compare with the renderer's; see
    `compared`."""
    row: Row = {"layout": code.layout.name, "bytes_per_pixel": code.layout.bytes_per_pixel, "language": code.language}
    if code.language in NEVER_RUN:
        return row | {"verdict": NOT_RUN, "says": f"not run here: layouts cannot be run in {code.language}"}
    return row | compared(partial(agreement, code), code.language)
