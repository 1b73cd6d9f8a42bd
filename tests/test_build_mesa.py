"""Building Mesa's drivers for phones and small boards: what is built, remembered and refused."""

import subprocess
from pathlib import Path

import build_mesa
import pytest

from normalbench.bench.ground.options.gpu_families import TURNIP
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.isa import driver_files
from normalbench.bench.shaders.isa.mobile import driver


@pytest.fixture(autouse=True)
def nothing_remembered():
    """Which drivers there are is asked anew before each test and after it."""
    driver_files.driver_file.cache_clear()
    yield
    driver_files.driver_file.cache_clear()


@pytest.fixture
def built(capsys):
    """The program: its exit status and what it says on standard error."""
    return lambda *words: (build_mesa.main(words), capsys.readouterr().err)


def script(folder: Path, name: str, text: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(f"#!/bin/sh\n{text}\n")
    (folder / name).chmod(0o755)


@pytest.fixture
def tools(tmp_path, monkeypatch):
    """Programs to build with that make what the real ones would, as far as it is looked for."""
    folder = tmp_path / "bin"
    for name in [*build_mesa.PROGRAMS, *build_mesa.DEBIAN_PROGRAMS, "python3"]:
        script(folder, name, "exit 0")
    script(folder, "meson", 'mkdir -p "$2" && touch "$2/build.ninja" && echo configured')
    makes = "; ".join(
        f'mkdir -p "$2/src/{name}/vulkan"; echo \'{{"ICD": {{"library_path": "/x/libvulkan_{name}.so"}}}}\' '
        f'> "$2/src/{name}/vulkan/{name}_devenv_icd.x86_64.json"'
        for name in ("freedreno", "broadcom")
    )
    script(folder, "ninja", makes)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")
    monkeypatch.delenv(driver.VARIABLE, raising=False)
    return folder


@pytest.fixture
def tarball(tmp_path):
    """A source of Mesa, as far as the build looks at it."""
    source = tmp_path / "mesa-1.2.3"
    source.mkdir()
    (source / "meson.build").write_text("project('mesa')\n")
    path = tmp_path / "mesa.tar.gz"
    subprocess.run(["tar", "czf", str(path), "-C", str(tmp_path), source.name], check=True)
    return str(path)


@pytest.mark.usefixtures("own_cache", "tools")
def test_a_build_is_remembered_and_found(built, tmp_path, tarball):
    where = tmp_path / "mesa"
    status, err = built(str(where), "--source", tarball, "--yes")
    assert status == 0 and build_mesa.COST in err, err
    assert driver.folder() == where and driver_files.driver_file(TURNIP).is_relative_to(where)
    assert [path.name for path in where.iterdir() if path.name.endswith(".part")] == []


@pytest.mark.usefixtures("own_cache")
def test_a_build_goes_on_where_it_was_ended(built, tmp_path, tarball, tools):
    where = tmp_path / "mesa"
    whole = (tools / "ninja").read_text()
    script(tools, "ninja", "echo 'x.c:1: error: no such thing'; exit 1")
    words = [str(where), "--source", tarball, "--yes"]
    status, err = built(*words)
    assert status == 2 and "ninja fails: x.c:1: error: no such thing; see" in err and driver.folder() is None
    (tools / "ninja").write_text(whole)
    script(tools, "meson", "exit 1")
    status, err = built(*words)
    assert status == 0 and "fetching" not in err and "configuring" not in err, err


@pytest.mark.usefixtures("tools")
def test_a_build_that_cannot_be_remembered_says_how_to_name_it(built, tmp_path, tarball, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    where = tmp_path / "mesa"
    status, err = built(str(where), "--source", tarball, "--yes")
    assert status == 2 and f"set {driver.VARIABLE}={where}" in err, err


@pytest.mark.usefixtures("own_cache", "tools")
def test_nothing_is_built_unless_somebody_agrees(built, tmp_path, tarball, monkeypatch):
    monkeypatch.setattr(build_mesa, "_agrees", lambda: False)
    status, err = built(str(tmp_path / "mesa"), "--source", tarball)
    assert status == 2 and "nothing was built; --yes builds without asking" in err
    assert not (tmp_path / "mesa").exists()


@pytest.mark.usefixtures("own_cache")
def test_what_is_missing_is_one_line_with_the_packages(built, tmp_path, tarball, tools, monkeypatch):
    for name in ("meson", "flex"):
        (tools / name).unlink()
    monkeypatch.setenv("PATH", str(tools))
    script(tools, "pkg-config", '[ "$2" != libdrm ]')
    words = [str(tmp_path / "mesa"), "--source", tarball, "--yes"]
    status, err = built(*words)
    assert status == 3 and err.count("\n") == 1, err
    assert "missing: meson, flex, libdrm; install them (Debian: apt-get install meson flex libdrm-dev)" in err


@pytest.mark.usefixtures("own_cache", "tools")
@pytest.mark.parametrize(
    "words, said",
    [
        (["mesa", "--yes", "--source", "no/such.tar"], "--source no/such.tar: no such file"),
        (["mesa", "--yes", "--source", __file__], "test_build_mesa.py: "),
    ],
)
def test_bad_words_are_one_line(built, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    status, err = built(*words)
    assert status == 2 and said in err.splitlines()[-1], err


def test_another_system_than_debian_is_told_to_give_a_tarball(monkeypatch):
    monkeypatch.setattr(build_mesa, "_release", lambda: iter(['ID="fedora"', "VERSION_CODENAME="]))
    with pytest.raises(UsageError, match="--source FILE or URL"):
        build_mesa._codename()
