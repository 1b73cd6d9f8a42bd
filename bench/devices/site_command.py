"""What `site` does."""

from pathlib import Path


def site_command(folder: Path, output: Path) -> int:
    raise NotImplementedError
