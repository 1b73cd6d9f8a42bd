"""The `site` command: makes a static site from a run and folders of device files."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path

from ...reports.page import page
from ...reports.page.codec_pages import INDEX as CODECS
from ...reports.page.codec_pages import codec_pages
from ...reports.page.found import Found
from ...reports.page.site import Site, ViewPage, view_html
from ...reports.sheets import View
from ..ground.output.errors import UsageError, tell
from ..ground.output.writing import say
from ..keep.runs import RUN, Done, read_to_show
from ..tables.devices.agreement import many
from ..tables.devices.device_file import Read, read_device_file
from ..tables.devices.reading import SAVED, Device, checked_number, devices, reads_of_rows
from ..tables.devices.site.pages import FOLDER, INDEX, pages
from ..tables.devices.table import TABLE
from .report import drawn_page, gathered, library_of
from .site_files import write_site

CHOOSE, LAYOUTS = "choose.html", "layouts.html"
# What the links to its other pages are called.
LABORATORY, ENCODINGS, DEVICES = "Laboratory", "Every encoding", "Devices"
TITLE = "Normal encodings for G-buffers"
DESCRIPTION = (
    "See on your own GPU how an encoding of normals affects reflections, and find the best encoding for your bit count."
)


def site_command(folders: Sequence[Path], output: Path) -> int:
    """Write a site for a run with the devices imported into it, for the device files in folders and their subfolders,
    or for both.

    Returns:
        the exit status: 1 if a file was skipped because it is not a valid device file.

    Raises:
        UsageError: several folders are runs, folders contain no device file, or the site cannot be written.
    """
    runs, others = (
        [folder for folder in folders if _is_run(folder)],
        [folder for folder in folders if not _is_run(folder)],
    )
    if len(runs) > 1:
        raise UsageError(f"{runs[0]} and {runs[1]} are both runs; name only one")
    run = read_to_show(runs[0]) if runs else None
    site_devices, wrong = _devices_in(others, reads_of_rows(run.tables.get(TABLE.name, []), runs[0]) if run else [])
    html_pages = _pages_of_run(runs[0], run, site_devices) if run else pages(site_devices)
    write_site(output, html_pages)
    say(f"{output / INDEX}: {_counted(html_pages, site_devices, bool(runs))}\n")
    return int(wrong > 0)


def _is_run(folder: Path) -> bool:
    return (folder / RUN).is_file()


def _counted(html_pages: dict[str, str], all_devices: Sequence[Device], is_run: bool) -> str:
    devices_there = many(len(all_devices), "device")
    return f"{many(len(html_pages), 'page')}, {devices_there}" if is_run else devices_there


def _devices_in(folders: Sequence[Path], imported: Sequence[Read]) -> tuple[list[Device], int]:
    """Return the devices from folders together with the imported devices, and the number of files that were skipped.
    Raises UsageError if folders are given but contain no device file."""
    read, wrong = _device_files(checked_number([path for folder in folders for path in _files_in(folder)]))
    if folders and not read:
        raise UsageError(f"{folders[0]} contains no device file; {SAVED}")
    return devices([*imported, *read]), wrong


def _files_in(folder: Path) -> list[Path]:
    """Return the sorted paths of all visible .json files in a folder and its subfolders. Raises UsageError."""
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such folder" if not folder.exists() else f"{folder} is not a folder")
    paths = [Path(root) / name for root, _, names in os.walk(folder) for name in names if name.endswith(".json")]
    # A site may lie among them, with its marker.
    return sorted(path for path in paths if not path.name.startswith("."))


def _device_files(paths: list[Path]) -> tuple[list[Read], int]:
    """Read device files. Return the valid files' contents and the number of invalid files, which are reported."""
    reads, wrong = [], 0
    for path in paths:
        try:
            reads.append(read_device_file(path))
        except UsageError as error:
            wrong += 1
            tell(f"{error}; file skipped")
    return reads, wrong


def _pages_of_run(folder: Path, done: Done, all_devices: Sequence[Device]) -> dict[str, str]:
    """Return the HTML pages of a run's site by path: the run's page, which begins with the laboratory, and the pages
    that work without scripts."""
    run, gallery, specs = drawn_page(gathered(folder, done))
    names = page.codecs(run)
    views, devices_there = _views(run), f"{FOLDER}/{INDEX}"
    titles = (
        {view.path: view.title for view in views} | ({CODECS: ENCODINGS} if names else {}) | {devices_there: DEVICES}
    )
    home = page.Home(TITLE, DESCRIPTION, list(titles.items()))
    site = Site({INDEX: LABORATORY} | titles, devices_there, f"{INDEX}#live" if run.live else "")
    html_pages = {INDEX: page.html(run, gallery, specs, library_of(specs), home=home)}
    html_pages |= {view.path: view_html(view, site) for view in views}
    return html_pages | codec_pages(run, names, site, INDEX) | pages(all_devices, site)


def _views(run: Found) -> list[ViewPage]:
    """Return the pages for readers without scripts: the recommendation and the layouts, each only if the run has rows
    for it."""
    choose, layouts = _parts(run, View.CHOOSE), _parts(run, View.LAYOUTS)
    views = []
    if choose:
        about = "The encoding of normals to use for each storage, its error in degrees and its cost in issue slots."
        link = (f"{INDEX}#v1/{View.CHOOSE}", "Ask a different question, and see charts and images")
        question = "Which encoding of normals should I use?"
        views.append(ViewPage(CHOOSE, "Recommendation", about, question, _answer(choose), link, choose))
    if layouts:
        about = "How image quality changes when normals and the rest of the G-buffer are stored in fewer bits."
        link = (f"{INDEX}#v1/{View.LAYOUTS}", "See the charts")
        question = "How does the G-buffer layout affect image quality?"
        views.append(ViewPage(LAYOUTS, "Layouts", about, question, _answer(layouts), link, layouts))
    return views


def _answer(parts: Sequence[page.PageSection]) -> str:
    """Return the first sentence of the first table in these sections that has any; empty if no table has."""
    return next((table.said[0] for part in parts for table in part.tables if table.said), "")


def _parts(run: Found, view: View) -> list[page.PageSection]:
    sections = [section for section in run.sections if section.about.view == view and section.rows]
    return [
        page.part_of(run, section, {}, math.inf) for section in sorted(sections, key=lambda part: not part.about.leads)
    ]
