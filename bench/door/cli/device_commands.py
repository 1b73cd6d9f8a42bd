"""The commands of readers' devices: into a run, and as a site."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...ground.output.writing import check_is_folder
from ...tables.table import Group

Files = Annotated[
    list[Path], typer.Argument(help='Device files, which a page saves by "Save this device".', metavar="FILE...")
]
Folders = Annotated[
    list[Path],
    typer.Argument(
        help="A run's folder, folders of device files, or both; folders in these count.", metavar="FOLDER..."
    ),
]


def add_devices(app: typer.Typer) -> None:
    """Both commands."""
    app.command("import", rich_help_panel=Group.KEEP, epilog="Example: normalbench import phone.json -o before")(
        import_command
    )
    app.command("site", rich_help_panel=Group.KEEP, epilog="Example: normalbench site before -o site")(site_command)


def import_command(files: Files, output: Path | None = None) -> int:
    """Add readers' devices to a run, for its page to show.

    Of one GPU in one browser the newest file stays. All files are checked before any is added.
    """
    from ...show.import_command import import_command as add

    return add(files, output)


def site_command(folders: Folders, output: Path = Path("site")) -> int:
    """Make a static website of a run, of readers' devices, or of both.

    It has the laboratory, the answer, and a page for each encoding. Devices are a list to search, with the codec to
    take on each.
    """
    from ...show.site_command import site_command as make

    check_is_folder(output, "site writes into")
    return make(folders, output)
