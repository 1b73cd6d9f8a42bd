"""The manual's table of the extras and their sizes.

`python -m tests.install_page` downloads all packages (650 MB) and writes the table.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Mapping
from importlib.metadata import Distribution, PathDistribution
from pathlib import Path
from zipfile import Path as ZipPath
from zipfile import ZipFile

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "install.md"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
EXTRAS: Mapping[str, str] = {
    "rays": "exact ambient occlusion, by Intel's ray caster",
    "maps": "BC5, BC7, EAC and ASTC textures",
    "compressed": "glTF meshes packed by Draco and meshopt; the latter is compiled",
    "half": "half arithmetic on a Vulkan device",
    "wgsl": "the backend `wgsl`",
    "slang": "Slang's compiler for encoders in Slang and HLSL",
    "workers": "workers of a scheduler on other machines",
    "nvidia": "instructions of NVIDIA's GPUs",
    "dev": "the tests",
}
ROW = re.compile(r"^\| (`\w+`|normalbench) +\| +(\d+) MB \| +(\d+) MB \|", re.M)
PART = re.compile(r"(<!-- sizes -->\n)(.*?)(<!-- end -->)", re.S)


def required(extra: str = "") -> list[str]:
    """Return the requirements in pyproject.toml: of an extra, or of the package itself."""
    return PROJECT["optional-dependencies"][extra] if extra else PROJECT["dependencies"]


def closure(asked: list[str], there: Mapping[str, Distribution], extras: frozenset[str] = frozenset()) -> set[str]:
    """Return the names of all packages that requirements need. Raises KeyError for a missing package."""
    names: set[str] = set()
    for text in asked:
        need = Requirement(text)
        is_asked = need.marker is None or any(need.marker.evaluate({"extra": extra}) for extra in (extras or {""}))
        name = canonicalize_name(need.name)
        if is_asked and name not in names:
            names |= {name} | closure(there[name].requires or [], there, frozenset(need.extras))
    return names


def added(extra: str, there: Mapping[str, Distribution]) -> set[str]:
    """Return the packages that an extra adds to an install without extras."""
    core = closure(required(), there)
    return closure(required(extra), there) - core if extra else core


def wheels(folder: Path) -> dict[str, Path]:
    """Download all packages that the extras need, and return their paths by name."""
    every = f"{ROOT}[{','.join(EXTRAS)}]"
    words = ("download", "--quiet", "--constraint", str(ROOT / ".ci" / "constraints.txt"), "--dest", str(folder), every)
    subprocess.run([sys.executable, "-m", "pip", *words], check=True)
    paths = {canonicalize_name(path.name.split("-")[0]): path for path in folder.iterdir()}
    return {name: path for name, path in paths.items() if name != "normalbench"}


def unpacked(path: Path) -> PathDistribution:
    """Return a wheel's metadata without installing the wheel."""
    (folder,) = {name.split("/")[0] for name in ZipFile(path).namelist() if name.split("/")[0].endswith(".dist-info")}
    return PathDistribution(ZipPath(path, f"{folder}/"))  # pyright: ignore[reportArgumentType] # reads like a folder


def size_on_disk(path: Path) -> float:
    """Return the size of a package in megabytes: unpacked for a wheel, packed for a source archive."""
    if path.suffix != ".whl":
        return path.stat().st_size / 1e6
    return sum(member.file_size for member in ZipFile(path).infolist()) / 1e6


def text(found: Mapping[str, Path]) -> str:
    """Return the table as text."""
    there = {name: unpacked(path) for name, path in found.items() if path.suffix == ".whl"}
    there |= {name: _Bare() for name, path in found.items() if path.suffix != ".whl"}
    lines = ["| extra        | to download | on disk | purpose |", "|--------------|------------:|--------:|---|"]
    for extra in ("", *EXTRAS):
        names = added(extra, there)
        download = max(1, sum(found[name].stat().st_size for name in names) / 1e6)
        disk = max(1, sum(size_on_disk(found[name]) for name in names))
        shown = f"`{extra}`" if extra else "normalbench"
        says = EXTRAS[extra] if extra else "everything else, without extras"
        lines.append(f"| {shown:12} | {download:8.0f} MB | {disk:4.0f} MB | {says} |")
    return "\n".join(lines) + "\n"


class _Bare(Distribution):
    """A package without metadata; it is assumed to need no other packages."""

    requires = None

    def read_text(self, filename: str) -> None: ...
    def locate_file(self, path: object) -> Path:
        raise FileNotFoundError(path)


def shown() -> dict[str, tuple[int, int]]:
    """Return the page's download and disk sizes in MB by extra; "" is the install without extras."""
    part = PART.search(PAGE.read_text())
    assert part
    rows = ROW.findall(part[2])
    return {name.strip("`").replace("normalbench", ""): (int(down), int(disk)) for name, down, disk in rows}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        made = text(wheels(Path(folder)))
    PAGE.write_text(PART.sub(lambda part: part[1] + made + part[3], PAGE.read_text()), encoding="utf-8")
