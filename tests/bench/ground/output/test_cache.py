"""The cache ignores anything that another user could have written."""

import grp
import os
import stat
from pathlib import Path
from types import SimpleNamespace

import pytest

from normalbench.bench.ground.compilers.text import judged
from normalbench.bench.ground.machine.systems.files import is_guarded
from normalbench.bench.ground.native import library as native
from normalbench.bench.ground.output import cache
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.isa import null_device

ELSE = 12345


FOLDERS = ("native", "programs", "translated")


as_root = pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files to another user")


@pytest.fixture
def folder(own_cache, monkeypatch):
    monkeypatch.delenv(cache.OFF, raising=False)
    return own_cache / "normalbench"


def test_a_key_differs_if_any_of_its_parts_differs():
    """Keys differ even if the joined parts are the same text."""
    parts = [("ab", "c"), ("a", "bc"), ("abc",), ("abc", ""), ("", "abc"), ("1:a", "b"), ("1", ":ab")]
    assert len({cache.key_of(*several) for several in parts}) == len(parts)


def is_open_to_others(path):
    path.chmod(path.stat().st_mode | 0o022)


def is_anothers(path):
    os.chown(path, ELSE, ELSE)


WAYS = [is_open_to_others, pytest.param(is_anothers, marks=as_root)]


KEY = "ab" + "0" * 62


@pytest.mark.parametrize("done_to", WAYS)
@pytest.mark.parametrize("part", ["", "native", "file"])
def test_a_poisoned_library_is_compiled_again(folder, done_to, part):
    """The file, its folder or the whole cache belongs to another user, or others may write to it."""
    if not native.compiler():
        pytest.skip("no C compiler")
    native._made.cache_clear()
    source = f"int answer(void) {{ return {len(part)}; }}"
    assert native.library(judged(source, "c"), "answer").answer() == len(part)
    (kept,) = (folder / "native").glob("*.so")
    # It is whole and says something else, as the digest at its end does.
    poison = native._compiled(judged("int answer(void) { return 666; }", "c"), folder.parent).read_bytes()
    kept.write_bytes(poison)
    done_to({"": folder, "native": folder / "native", "file": kept}[part])
    assert not cache.is_private(kept)
    native._made.cache_clear()
    assert native.library(judged(source, "c"), "answer").answer() == len(part)


def is_open_to_a_group(path):
    os.chown(path, -1, ELSE)
    path.chmod(0o770)


def is_reached_by_a_link_to_anothers(path):
    path.rename(path.with_name("moved"))
    path.symlink_to(path.with_name("moved"))
    is_anothers(path.with_name("moved"))


ABOVE = [
    is_open_to_others,
    pytest.param(is_open_to_a_group, marks=as_root),
    pytest.param(is_anothers, marks=as_root),
    pytest.param(is_reached_by_a_link_to_anothers, marks=as_root),
]


@pytest.fixture
def deep(monkeypatch, tmp_path):
    """The outer of two folders of this user; the cache is in the inner folder."""
    monkeypatch.delenv(cache.OFF, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "outer" / "inner"))
    (tmp_path / "outer" / "inner").mkdir(mode=0o700, parents=True)
    (tmp_path / "outer").chmod(0o700)
    return tmp_path / "outer"


@pytest.mark.parametrize("part", ["outer", "inner"])
@pytest.mark.parametrize("done_to", ABOVE)
def test_a_library_planted_in_a_folder_above_the_cache_is_not_loaded(deep, done_to, part):
    """Anyone who may write to a folder above this user's cache could replace the cache, so nothing is kept."""
    if not native.compiler():
        pytest.skip("no C compiler")
    native._made.cache_clear()
    source = "int answer(void) { return 1; }"
    assert native.library(judged(source, "c"), "answer").answer() == 1
    (kept,) = (deep / "inner" / "normalbench" / "native").glob("*.so")
    kept.write_bytes(native._compiled(judged("int answer(void) { return 666; }", "c"), deep).read_bytes())
    done_to(deep if part == "outer" else deep / "inner")
    before = kept.read_bytes()
    native._made.cache_clear()
    assert cache.is_private(kept) and cache.loadable(kept) is None
    assert native.library(judged(source, "c"), "answer").answer() == 1 and kept.read_bytes() == before


@pytest.mark.parametrize("done_to", ABOVE)
def test_a_device_planted_above_the_cache_is_not_loaded(deep, done_to):
    """The device is built for this process, in a separate folder."""
    there = null_device.library()
    assert there.is_relative_to(deep) and null_device.library() == there
    done_to(deep)
    assert null_device.library().parent == cache.folder_of_this_process()


@as_root
def test_folders_that_keep_others_out_store_libraries(deep):
    """Safe folders are a sticky folder of root, like /tmp, and a folder whose group has no other members."""
    (deep / "inner" / "file").touch()
    deep.chmod(0o1777)
    assert is_guarded(deep / "inner" / "file") and cache.keeps_code()
    deep.chmod(0o775)
    assert cache.keeps_code() == (grp.getgrgid(0).gr_mem in ([], ["root"])), "the group of root"
    os.chown(deep, ELSE, 0)
    deep.chmod(0o1777)
    assert not cache.keeps_code(), "who owns a sticky folder moves what is in it"


@pytest.mark.parametrize("done_to", WAYS)
def test_another_users_value_is_computed_again(folder, done_to):
    cache.write(KEY, {"bits": 8})
    assert cache.read(KEY) == {"bits": 8}
    done_to(folder / KEY[:2] / f"{KEY}.json")
    assert cache.read(KEY) is None and cache.kept(KEY, lambda: {"bits": 9}) == {"bits": 9}
    assert cache.read(KEY) == {"bits": 9}, "and that is kept"


def pipe(path):
    path.unlink()
    os.mkfifo(path)


def endless(path):
    path.unlink()
    path.symlink_to("/dev/zero")


@pytest.mark.parametrize("put", [pipe, endless])
def test_a_pipe_or_a_device_in_place_of_a_file_is_not_read(folder, put):
    """Values and libraries are made again; among JAX's programs, anything other than a file is removed."""
    cache.write(KEY, {"bits": 8})
    put(folder / KEY[:2] / f"{KEY}.json")
    assert cache.read(KEY) is None
    if native.compiler():
        native._made.cache_clear()
        native.library(judged("int answer(void) { return 7; }", "c"), "answer")
        (kept,) = (folder / "native").glob("*.so")
        put(kept)
        native._made.cache_clear()
        assert native.library(judged("int answer(void) { return 7; }", "c"), "answer").answer() == 7
    programs = folder / "programs"
    cache.make_folder(programs)
    for name in ("file", "odd"):
        (programs / name).touch()
    put(programs / "odd")
    cache.keep_only_files(programs)
    assert [path.name for path in programs.iterdir()] == ["file"]


@pytest.mark.parametrize("nowhere", ["normalbench", "tmp"])
@pytest.mark.usefixtures("folder")
def test_a_library_is_loaded_even_if_one_folder_forbids_execution(monkeypatch, tmp_path, nowhere):
    """The folder is the cache or the temporary folder; the library is loaded the second time as well."""
    if not native.compiler():
        pytest.skip("no C compiler")
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    load = native.ctypes.CDLL

    def guarded(path):
        if nowhere in Path(path).relative_to(tmp_path).parts[:2]:
            raise OSError(f"{path}: failed to map segment from shared object")
        return load(path)

    monkeypatch.setattr(native.ctypes, "CDLL", guarded)
    for _ in range(2):
        native._made.cache_clear()
        assert native.library(judged("int answer(void) { return 5; }", "c"), "answer").answer() == 5


def test_a_device_is_built_elsewhere_if_the_cache_forbids_execution(folder, monkeypatch):
    """The loader skips a library that it cannot map, and then no device is found."""
    flags = SimpleNamespace(f_flag=os.ST_NOEXEC)
    monkeypatch.setattr(cache.os, "statvfs", lambda _: flags)
    there = null_device.library()
    assert not there.is_relative_to(folder) and there.parent == cache.folder_of_this_process()
    flags.f_flag = 0
    assert null_device.library().is_relative_to(folder)


def test_folders_are_private_to_their_user(folder):
    old = os.umask(0)
    try:
        cache.write(KEY, {})
        for name in FOLDERS:
            cache.make_folder(folder / name / "deeper")
    finally:
        os.umask(old)
    modes = {path: stat.S_IMODE(path.stat().st_mode) for path in (folder.parent, folder, *folder.rglob("*/"))}
    assert len(modes) >= 9 and set(modes.values()) == {cache.PRIVATE}, modes


@as_root
def test_an_open_folder_is_made_private_and_files_of_others_are_removed(folder):
    programs = folder / "programs"
    cache.make_folder(programs)
    (programs / "mine").write_text("mine")
    (programs / "theirs").write_text("theirs")
    (programs / "folder").mkdir()
    for name in ("theirs", "folder"):
        os.chown(programs / name, ELSE, ELSE)
    programs.chmod(0o777)
    cache.make_folder(programs)
    assert [path.name for path in programs.iterdir()] == ["mine"] and stat.S_IMODE(programs.stat().st_mode) == 0o700


@pytest.mark.parametrize("put", [lambda path: path.write_text("mine"), os.mkfifo, lambda path: path.symlink_to("none")])
def test_a_cache_path_that_is_not_a_folder_is_left_unchanged(folder, put):
    folder.parent.mkdir(parents=True)
    put(folder)
    before = folder.lstat()
    cache.write(KEY, {})
    with pytest.raises(MissingError, match="name another folder with XDG_CACHE_HOME"):
        cache.require_folder()
    assert cache.read(KEY) is None and folder.lstat().st_mode == before.st_mode
