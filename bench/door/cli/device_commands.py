"""The commands of readers' devices: into a run, and as a site."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...ground.output.writing import check_is_folder
from ...tables.table import Group

Files = Annotated[
    list[Path], typer.Argument(help='Device files, saved with "Save this device" on a page.', metavar="FILE...")
]
Folders = Annotated[
    list[Path],
    typer.Argument(
        help="Results folder, folders of device files, or both; subfolders are searched.", metavar="FOLDER..."
    ),
]


def add_devices(app: typer.Typer) -> None:
    """Both commands."""
    app.command("import", rich_help_panel=Group.KEEP, epilog="Example: normalbench import phone.json -o before")(
        import_command
    )
    app.command("site", rich_help_panel=Group.KEEP, epilog="Example: normalbench site before -o site")(site_command)


def import_command(files: Files, output: Path | None = None) -> int:
    """Add readers' device files to a run, so that its page shows them.

    Only the newest file for each GPU and browser is kept. All files are checked before any is added.
    """
    from ...show.import_command import import_command as add

    return add(files, output)


def site_command(folders: Folders, output: Path = Path("site")) -> int:
    """Make a static website from a run, device files or both.

    The site has the laboratory, the recommendation and a page for each encoding. A searchable list of devices shows
    which codec to use on each device.
    """
    from ...show.site_command import site_command as make

    check_is_folder(output, "site writes into")
    return make(folders, output)
