"""The command for captures of RenderDoc."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...ground.output.writing import write_text
from ...tables.table import Group

SCRIPT = Path(__file__).parents[1] / "in_renderdoc" / "save_gbuffer.py"


def add_renderdoc(app: typer.Typer) -> None:
    """The command."""
    app.command("renderdoc", rich_help_panel=Group.OWN, epilog="Example: normalbench renderdoc --script save.py")(
        renderdoc
    )


def renderdoc(
    script: Annotated[
        Path | None, typer.Option("--script", help="Write the script to this file. Default: print it.")
    ] = None,
) -> int:
    """Print a script that saves a capture's G-buffer in RenderDoc.

    The script writes EXR files and prints the commands that measure them.

    In RenderDoc, open the capture and run the script in Window > Python Shell. Or run: python3 SCRIPT frame.rdc
    """
    write_text(lambda: SCRIPT.read_text(encoding="utf-8"), script)
    return 0
