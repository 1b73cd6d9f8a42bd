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
RunFolder = Annotated[Path | None, typer.Option("-o", "--output", help="The run's folder.", metavar="RUN")]
Folders = Annotated[
    list[Path],
    typer.Argument(
        help="A run's folder, folders of device files, or both; folders in these count.", metavar="FOLDER..."
    ),
]
SiteFolder = Annotated[Path, typer.Option("-o", "--output", help="The folder of the site.")]


def add_devices(app: typer.Typer) -> None:
    """Both commands."""
    app.command("import", rich_help_panel=Group.KEEP)(import_command)
    app.command("site", rich_help_panel=Group.KEEP)(site_command)


def import_command(files: Files, output: RunFolder = None) -> int:
    """Add readers' devices to a run, for its page to show: what differs on which GPU, times, facts.

    Of one GPU in one browser the newest file stays. All files are checked before any is added.
    """
    from ...show.import_command import import_command as add

    return add(files, output)


def site_command(folders: Folders, output: SiteFolder = Path("site")) -> int:
    """A static site of a run: the laboratory, the answer, and a page for each encoding. Of readers' devices: a list to
    search, and a page for each with the codec to take on it.
    """
    from ...show.site_command import site_command as make

    check_is_folder(output, "site writes into")
    return make(folders, output)
