"""Builds Mesa's drivers for GPUs of phones and small boards, from Debian's source package or from a tarball.

    python -m tests.build_mesa DIR [--source TARBALL] [--yes]

`normalbench cost --isa --family mobile` then counts with them. Nothing is installed: all of it stays in DIR. What is
there already is not done again. Exit status: 2 where it does not build, 3 where something to build with is missing.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tarfile
import urllib.request
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from normalbench.bench.ground.options.gpu_families import MOBILE, TITLES
from normalbench.bench.ground.output.errors import MissingError, UsageError
from normalbench.bench.shaders.isa.mobile import driver

# What it takes, as measured on two cores with Mesa 22.3.
COST = "about 40 MB to download, 330 MB on disk and 5 to 10 minutes on two cores"
# Programs, and what pkg-config knows of libraries, by Debian's packages.
PROGRAMS: Mapping[str, str] = MappingProxyType(
    {"meson": "meson", "ninja": "ninja-build", "flex": "flex", "bison": "bison", "pkg-config": "pkg-config"}
    | {"cc": "gcc", "c++": "g++"}
)
LIBRARIES: Mapping[str, str] = MappingProxyType(
    {"libdrm": "libdrm-dev", "zlib": "zlib1g-dev", "expat": "libexpat1-dev"}
)
DEBIAN_PROGRAMS: Mapping[str, str] = MappingProxyType({"apt-get": "apt", "dpkg-source": "dpkg-dev"})
MAKO = "python3-mako"
# The two Vulkan drivers alone, without windows, OpenGL and LLVM.
OPTIONS = (
    *("--buildtype=release", "-Dvulkan-drivers=freedreno,broadcom", "-Dgallium-drivers=", "-Dplatforms="),
    *("-Dllvm=disabled", "-Dglx=disabled", "-Degl=disabled", "-Dgbm=disabled", "-Dopengl=false", "-Dgles1=disabled"),
    *("-Dgles2=disabled", "-Dvulkan-layers=", "-Dvideo-codecs=", "-Dzstd=disabled", "-Dvalgrind=disabled"),
    "-Dlibunwind=disabled",
)
SOURCE, LOG, BUILT = "source", "build.log", "build.ninja"
DEBIAN = """Types: deb-src
URIs: http://deb.debian.org/debian
Suites: {codename}
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
"""

Say = Callable[[str], None]


def build(where: Path, source: str | None, say: Say) -> None:
    """Builds the drivers in a folder and remembers it.

    Args:
        source: a tarball of Mesa, as a file or a URL; None for Debian's source package.
        say: is told what is begun.

    Raises:
        MissingError: something to build with is missing; one line that names the packages.
        UsageError: there is no such source, or it does not build; the line names the log.
    """
    python, where = check(source), where.resolve()
    try:
        where.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{where}: {error.strerror or error}") from error
    if _tree(where) is None:
        say(f"fetching Mesa's source into {where / SOURCE}")
        _fetch(where, source)
    tree = _tree(where)
    if tree is None:
        raise UsageError(f"{where / SOURCE} holds no source of Mesa: no folder there has a meson.build")
    # The first of a name on the path is what meson takes: the Python that has what Mesa's scripts need.
    environment = os.environ | {"PATH": os.pathsep.join([str(python.parent), os.environ.get("PATH", os.defpath)])}
    if not (where / driver.BUILD / BUILT).exists():
        say("configuring")
        _run(["meson", "setup", str(where / driver.BUILD), str(tree), *OPTIONS], where, environment)
    say(f"building; {where / LOG} has what the compiler says")
    _run(["ninja", "-C", str(where / driver.BUILD)], where, environment)
    _remember(where)


def _remember(where: Path) -> None:
    """Raises UsageError where a driver was not built after all."""
    built = " ".join(path.parent.parent.name for path in driver.descriptions_in(where))
    missing = [TITLES[library] for library in MOBILE if library.split("_")[-1] not in built]
    if missing:
        raise UsageError(f"{where} holds no {' and no '.join(missing)} after the build; see {where / LOG}")
    try:
        driver.record(where)
    except OSError as error:
        said = f"built, but the cache folder cannot remember it: {error.strerror or error}"
        raise UsageError(f"{said}; set {driver.VARIABLE}={where}") from error


def check(source: str | None) -> Path:
    """A Python that has what Mesa's scripts need. Raises MissingError for what is missing, all at once, and UsageError
    for a tarball that is not there."""
    if source is not None and not _is_url(source) and not Path(source).is_file():
        raise UsageError(f"--source {source}: no such file")
    python = _python()
    programs = {**PROGRAMS, **({} if source else DEBIAN_PROGRAMS)}
    missing = {name: package for name, package in programs.items() if not shutil.which(name)}
    if "pkg-config" not in missing:
        missing |= {name: package for name, package in LIBRARIES.items() if not _has_library(name)}
    if python is None:
        missing["mako (Python)"] = MAKO
    if missing or python is None:
        said = f"to build Mesa these are missing: {', '.join(missing)}"
        raise MissingError(f"{said}; install them (Debian: apt-get install {' '.join(missing.values())})")
    return python


def _has_library(name: str) -> bool:
    return subprocess.run(["pkg-config", "--exists", name], capture_output=True).returncode == 0


def _python() -> Path | None:
    """The first python3 of the path that has mako."""
    folders = [*os.environ.get("PATH", os.defpath).split(os.pathsep), "/usr/bin"]
    found = (Path(folder) / "python3" for folder in dict.fromkeys(filter(None, folders)))
    return next((path for path in found if path.exists() and _has_mako(path)), None)


def _has_mako(python: Path) -> bool:
    return subprocess.run([str(python), "-c", "import mako"], capture_output=True).returncode == 0


def _tree(where: Path) -> Path | None:
    """Mesa's source in a folder; None where it is not, or not wholly, there."""
    return next((path.parent for path in sorted((where / SOURCE).glob("*/meson.build"))), None)


def _fetch(where: Path, source: str | None) -> None:
    """The source as a folder of its own, which is there once it is whole."""
    made = where / f"{SOURCE}.part"
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir()
    if source is None:
        _by_apt(where, made)
    else:
        _unpack(_downloaded(source, made) if _is_url(source) else Path(source), made)
    made.rename(where / SOURCE)


def _is_url(source: str) -> bool:
    return source.startswith(("https://", "http://"))


def _downloaded(url: str, folder: Path) -> Path:
    path = folder / "mesa.tar"
    try:
        with urllib.request.urlopen(url, timeout=60) as answer, path.open("wb") as file:
            shutil.copyfileobj(answer, file)
    except (OSError, ValueError) as error:
        raise UsageError(f"--source {url}: {error}") from error
    return path


def _unpack(tarball: Path, folder: Path) -> None:
    try:
        with tarfile.open(tarball) as archive:
            archive.extractall(folder, filter="data")
    except (OSError, tarfile.TarError) as error:
        raise UsageError(f"--source {tarball}: {error}") from error


def _by_apt(where: Path, folder: Path) -> None:
    """Debian's source package, with lists of sources in the user's own folder: the system's stay as they are."""
    own = where / "apt"
    for name in ("lists/partial", "cache/archives/partial", "parts"):
        (own / name).mkdir(parents=True, exist_ok=True)
    (own / "parts" / "mesa.sources").write_text(DEBIAN.format(codename=_codename()), encoding="utf-8")
    places = {"SourceList": "/dev/null", "SourceParts": own / "parts"}
    told = [f"-oDir::Etc::{name}={path}" for name, path in places.items()]
    told += [f"-oDir::State::lists={own / 'lists'}", f"-oDir::Cache={own / 'cache'}"]
    _run(["apt-get", *told, "update"], where, os.environ)
    _run(["apt-get", *told, "source", "mesa"], where, os.environ, folder)


def _codename() -> str:
    """The release of this Debian. Raises UsageError on another system."""
    said = dict(line.split("=", 1) for line in _release() if "=" in line)
    codename = said.get("VERSION_CODENAME", "").strip('"')
    if said.get("ID") != "debian" or not codename:
        raise UsageError("this is not Debian: give a tarball of Mesa's source with --source FILE or URL")
    return codename


def _release() -> Iterator[str]:
    path = Path("/etc/os-release")
    yield from path.read_text(encoding="utf-8").splitlines() if path.exists() else ()


def _run(command: Sequence[str], where: Path, environment: Mapping[str, str], folder: Path | None = None) -> None:
    """A command whose words go to the log. Raises UsageError, with the last of them, where it fails."""
    with (where / LOG).open("a", encoding="utf-8") as log:
        done = subprocess.run(
            command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, env=environment, cwd=folder
        )
    if done.returncode:
        lines = (where / LOG).read_text(encoding="utf-8", errors="replace").splitlines()
        complaints = [line.strip() for line in lines if "rror" in line] or lines[-1:]
        last = complaints[-1][:200] if complaints else f"status {done.returncode}"
        raise UsageError(f"{command[0]} fails: {last}; see {where / LOG}")


def build_if_agreed(where: Path, source: str | None, is_agreed: bool) -> None:
    """Says what it takes, asks and builds. Raises as `build`, and UsageError where nobody agrees."""
    check(source)
    _said(f"building Mesa's turnip and v3dv in {where}: {COST}")
    if not is_agreed and not _agrees():
        raise UsageError("nothing was built; --yes builds without asking")
    build(where, source, _said)
    _said("built; `normalbench cost --isa --family mobile` counts with them")


def _said(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _agrees() -> bool:
    if not sys.stdin.isatty():
        return False
    _said("Go on? [y/N]")
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def main(words: Sequence[str] | None = None) -> int:
    """The exit status; what is wrong is one line on standard error."""
    formatter = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("python -m tests.build_mesa", description=__doc__, formatter_class=formatter)
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--source", metavar="TARBALL", help="Mesa's source, a file or a URL. Default: Debian's.")
    parser.add_argument("--yes", action="store_true", help="Do not ask.")
    asked = parser.parse_args(words)
    try:
        build_if_agreed(asked.folder, asked.source, asked.yes)
    except (UsageError, MissingError) as error:
        _said(f"build_mesa: {' '.join(str(error).split())}")
        return 3 if isinstance(error, MissingError) else 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
