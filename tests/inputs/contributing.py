"""The examples of CONTRIBUTING.md, and a copy of the code that they are added to."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from manual import ROOT

PAGE = (ROOT / "CONTRIBUTING.md").read_text()
NEW = re.compile(r"<!-- new (\S+) -->\n```\w+\n(.*?)^```$", re.S | re.M)
LINE = re.compile(r"<!-- line (\S+), below (.*?) -->\n```\w+\n(.*?\n)```$", re.S | re.M)


@dataclass(frozen=True)
class Example:
    """An addition to the code.

    Attributes:
        files: texts of new files by their paths.
        lines: path, the line above, and the new line with its line break.
    """

    files: dict[str, str]
    lines: list[tuple[str, str, str]]

    def add_to(self, package: Path) -> None:
        """Add the example to a copy of the code."""
        for name, text in self.files.items():
            path = package / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        for name, above, line in self.lines:
            path = package / name
            lines = path.read_text().splitlines(keepends=True)
            (position,) = [number for number, source_line in enumerate(lines, 1) if source_line.strip() == above]
            path.write_text("".join([*lines[:position], line, *lines[position:]]))


EXAMPLES = {
    title.lower(): Example(dict(NEW.findall(text)), LINE.findall(text))
    for title, text in re.findall(r"^## (An? .*?)\n(.*?)(?=^## |\Z)", PAGE, re.S | re.M)
}


def a_copy_of_the_rooms(folder: Path) -> Path:
    """Copy the package to a plain folder that Python finds from `folder` before the installed package."""
    package = folder / "normalbench"
    for room in ("encodings", "gbuffer", "bench", "reports"):
        # With what Python compiled, which is as old as its source: of a copy it compiles what a test changes alone.
        # Another process may be writing some: those have names of their own until they are whole.
        shutil.copytree(ROOT / room, package / room, ignore=shutil.ignore_patterns("*.pyc.*"))
    return package


def normalbench_in(folder: Path, *arguments: str) -> subprocess.CompletedProcess:
    """Run the command of a copied package in its folder."""
    command = [sys.executable, "-m", "normalbench", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)
