"""The claims of README.md and every page of docs/ are true: commands run, examples pass."""

import re
import runpy
import shlex
import shutil
import sys
import tomllib
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import NoReturn

import columns_page
import devices
import gpu_page
import manual_pictures
import numpy as np
import pytest
from manual import NAMED, PAGES, README, ROOT
from written import as_document, packed, planes_of, png_bytes, some_normals, write_exr

from normalbench.bench.door import code_command, examine, folder, gbuffer_command, run
from normalbench.bench.door.cli import app as cli
from normalbench.bench.keep import answers, history_command, machine
from normalbench.bench.run import measuring
from normalbench.bench.run.workers import places
from normalbench.bench.show import report, site_command
from normalbench.gbuffer.scenes.mesh import sphere

MOST_LINES = 120


FENCE = re.compile(r"^```.*?^```$", re.S | re.M)


EXAMPLES = [(path, *groups) for path, text in PAGES.items() for groups in NAMED.findall(text)]


FILES = {name: text for _, name, text in EXAMPLES}


# An indented line is a command, up to its comment.
INDENTED = re.compile(r"^    (\S[^#\n]*?) *(?:#.*)?$", re.M)


LINES = list(dict.fromkeys(line for text in PAGES.values() for line in INDENTED.findall(FENCE.sub("", text))))


COMMANDS = [line for line in LINES if line.startswith(("normalbench ", "python "))]


PYTEST = [line for line in LINES if line.startswith("pytest ")]


MAKE = [line for line in LINES if line.startswith("make ")]


# These install something or change the shell.
NOT_RUN = [line for line in LINES if line.startswith(("pip install ", "uv tool ", "pipx ", "docker "))]


def users_files(folder: Path) -> None:
    """Write a frame in every format, its mask, a matrix and a scene, with the names that the commands use."""
    n = some_normals()
    for name in ("frame.exr", "world.exr"):
        write_exr(folder / name, planes_of(n))
    for name in ("list.npy", "cube.npy"):
        np.save(folder / name, n)
    (folder / "frame.png").write_bytes(png_bytes(packed(n, np.uint16)))
    (folder / "mask.png").write_bytes(png_bytes(np.full((*n.shape[:2], 1), 255, np.uint8)))
    for name in ("albedo.png", "material.png"):
        (folder / name).write_bytes(png_bytes(packed(n, np.uint8)))
    np.savetxt(folder / "view.txt", np.eye(4))
    depths = np.linspace(1, 20, n.shape[0] * n.shape[1], dtype=np.float32).reshape(n.shape[:2])
    write_exr(folder / "frame-depth.exr", {"Z": depths})
    np.save(folder / "device-depth.npy", 1 - 0.1 / depths)
    (folder / "millimetres.png").write_bytes(png_bytes((depths[..., None] * 1000).astype(np.uint16)))
    as_document([sphere(1.0, 16, 8)]).write(folder / "scene.glb")
    shutil.copy(ROOT / "tests" / "inputs" / "normals" / "points.ply", folder)
    # What the command before it writes.
    (folder / "layouts").mkdir()
    (folder / "layouts" / "budget_16.toml").write_text(FILES["mine.toml"])


def readers_devices(folder: Path) -> None:
    """Write device files with the names that the commands use."""
    devices.write(folder / "phone.json", renderer=devices.MALI, truncated=("RGB10_A2",))
    devices.write(folder / "desktop.json", renderer=devices.GEFORCE)
    devices.write_ten(folder / "contributed")


def test_the_readme_is_short():
    assert len(PAGES[README].splitlines()) <= MOST_LINES


def test_every_indented_line_is_a_known_command():
    """A line that no test below runs installs something."""
    assert len(COMMANDS) >= 40
    assert set(LINES) == {*COMMANDS, *PYTEST, *MAKE, *NOT_RUN}
    for path, text in PAGES.items():
        assert not re.search(r"^```(sh|bash|shell|console)", text, re.M), f"{path.name}: indent commands"


def test_every_example_is_a_file_and_files_of_the_same_name_are_identical():
    for path, text in PAGES.items():
        fences = re.findall(r"^```(?:glsl|hlsl|json|python|toml)$", text, re.M)
        assert len(fences) == len(NAMED.findall(text)), path.name
    assert all(FILES[name] == text for _, name, text in EXAMPLES)


def test_every_example_is_used():
    for name in FILES:
        words = [shlex.split(line.replace(",", " ")) for line in (*COMMANDS, *PYTEST)]
        used = any({name, Path(name).parts[0]} & {*line} for line in words)
        assert used or name.startswith("test_") or Path(name).with_suffix(".glsl").name in FILES, name


# What takes more than a second of processor time: it renders, tunes, draws, compiles or measures many rows.
LONG = re.compile(
    r"normalbench (pick|budget|mix|maps|render|effects|motion|lights|sweep|tune|run|report|frames|check|code"
    r"|site before)\b(?! --help)|python|normalbench (doctor|vectors)$"
    r"|.*(--on |--plot|--report|--worst-case|--encoding all|--arithmetic float|--far|--normals (scene|frame))"
)


LONG_COMMANDS = [command for command in COMMANDS if LONG.match(command)]


class BegunError(Exception):
    """A command has checked its arguments and is about to begin."""


def begin(*_: object) -> NoReturn:
    raise BegunError


BEGINNINGS = (
    (measuring.Here, "measure"),
    (code_command, "agreement"),
    (gbuffer_command, "agreement"),
    (report, "read_to_show"),
    (history_command, "past_runs"),
    (site_command, "_is_run"),
    (examine, "examined"),
    (folder, "examined"),
    (machine, "examine"),
)


def write_files(place) -> None:
    """Write the files that the manual shows."""
    for name, text in FILES.items():
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).write_text(text)


@pytest.fixture
def readers_folder(tmp_path, monkeypatch):
    """The working folder, with the files that the commands use."""
    monkeypatch.chdir(tmp_path)
    write_files(tmp_path)
    users_files(tmp_path)
    readers_devices(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("gl", "readers_folder")
@pytest.mark.parametrize("command", LONG_COMMANDS)
def test_every_long_command_is_accepted_as_written(command, monkeypatch):
    """The program checks its options, names and values, and stops before it begins."""
    for place, name in BEGINNINGS:
        monkeypatch.setattr(place, name, begin)
    # These take time, and check nothing.
    monkeypatch.setattr(answers, "key_of_answer", lambda *_: "")
    monkeypatch.setattr(run, "facts_of", lambda _: {})
    monkeypatch.setattr(run, "second_process", nullcontext)
    for module in (run, places):
        monkeypatch.setattr(module, "place", lambda _: nullcontext(measuring.HERE))
    words = shlex.split(command)
    monkeypatch.setattr(sys, "argv", words)
    if words[0] == "python":
        # Some measure nothing.
        with suppress(BegunError):
            runpy.run_path(words[1])
        return
    with pytest.raises(BegunError):
        cli.main()


def test_the_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text()
    assert {"make bench", "make test"} <= set(MAKE)
    for line in MAKE:
        _, target, *variables = line.split()
        assert f"\n{target}:" in makefile
        assert all(f"$({variable.partition('=')[0]})" in makefile for variable in variables)


def test_extras_that_the_manual_installs_exist():
    known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    extras = {extra for line in NOT_RUN for names in re.findall(r"\[([\w,]+)\]", line) for extra in names.split(",")}
    assert extras and extras <= set(known)


def test_pages_have_the_columns_of_the_tables():
    """The generated pages match the registry exactly."""
    for page in (columns_page, gpu_page):
        assert PAGES[page.PAGE] == page.text(), f"write it: python -m tests.{page.__name__}"


IMPORT = re.compile(r"^(?:import|from) (\w+)", re.M)


INSTALL = re.compile(r"`?pip install ([^`\n]+)")


def installed_by(text: str) -> set[str]:
    """Return the packages that a page's pip lines install, and the packages that normalbench requires."""
    known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    words = [word for line in INSTALL.findall(text) for word in line.split() if not word.startswith("-")]
    extras = [name for word in words for names in re.findall(r"\[([\w,]+)\]", word) for name in names.split(",")]
    asked = known["dependencies"] + [line for name in extras for line in known["optional-dependencies"][name]] + words
    return {re.split(r"[\[<>=;/ ]", line)[0].lower() for line in asked}


def test_a_page_installs_the_packages_that_its_examples_import():
    """A file of tests needs pytest, which normalbench does not install."""
    scripts = [example for example in EXAMPLES if example[1].endswith(".py")]
    assert scripts
    for page, name, text in scripts:
        check_installed(page, name, text)


def check_installed(page, name, text):
    imported = {*IMPORT.findall(text), *(["pytest"] if name.startswith("test_") else [])}
    missing = imported - {*sys.stdlib_module_names, "normalbench", *installed_by(PAGES[page])}
    assert not missing, f"{page}: {name} needs {', '.join(sorted(missing))}; say how it is installed"


def anchors(text: str) -> set[str]:
    """Return the link anchors of a page's headings."""
    headings = re.findall(r"^#+ (.+)$", FENCE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_targets_of_links_exist(path):
    for link in re.findall(r"\]\(([^)]+)\)", PAGES[path]):
        name, _, anchor = link.partition("#")
        target = (path.parent / name).resolve() if name else path
        assert target.is_file(), link
        assert not anchor or anchor in anchors(target.read_text()), link
        assert target.suffix != ".png" or target.stat().st_size > 10_000, link


def test_every_page_is_in_the_index():
    docs = ROOT / "docs"
    pages = [path for path in PAGES if path.name != "README.md"]
    missing = [
        name for path in pages if f"({(name := path.relative_to(docs).as_posix())})" not in PAGES[docs / "README.md"]
    ]
    assert not missing, missing


def test_articles_are_not_named_by_seed_numbers():
    """Articles are named by author, title and year."""
    for path, text in PAGES.items():
        assert not re.search(r"\bseed \d", text), path.name


# Screenshots of a run's page, in README.
SHOTS = {"choose", "mirrors"}
PICTURED = re.compile(r"^!\[[^]]+\]\((?:docs/)?pictures/([\w-]+)\.png\)\n(.*)$", re.M)


def test_every_picture_on_a_page_has_a_caption_and_the_command_that_draws_it():
    pages = {path: text for path, text in PAGES.items() if path != README}
    captions = {name: caption for text in pages.values() for name, caption in PICTURED.findall(text)}
    assert sorted(captions) == sorted(
        path.stem for path in manual_pictures.FOLDER.glob("*.png") if path.stem not in SHOTS
    )
    assert not [name for name, caption in captions.items() if not re.fullmatch(r"\*.+\.\*", caption)]
    for name in manual_pictures.PICTURES:
        assert manual_pictures.command_of(name, pages)
