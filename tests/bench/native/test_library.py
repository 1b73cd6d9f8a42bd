"""Compiled C is kept, read back whole or made anew, and missing without harm."""

import ctypes

import pytest

from normalbench.bench.native import library as native
from normalbench.bench.output import cache

SOURCE = "int answer(void) { return 42; }"
needs_c = pytest.mark.skipif(not native.compiler(), reason="no C compiler")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(cache.OFF, raising=False)
    return tmp_path / "normalbench" / "native"


def made() -> ctypes.CDLL:
    return native.library.__wrapped__(SOURCE)


@needs_c
def test_what_is_compiled_is_kept(folder, monkeypatch):
    assert made().answer() == 42
    (kept,) = folder.iterdir()
    monkeypatch.setattr(native, "_compiled", lambda *_: pytest.fail("compiled again"))
    assert made().answer() == 42 and [*folder.iterdir()] == [kept]


@needs_c
@pytest.mark.parametrize("damage", [lambda d: d[:-100], lambda _: b"", lambda d: d[:300] + b"x" + d[301:]])
def test_a_damaged_library_is_compiled_again(folder, damage):
    """Cut off, empty, or with another byte: it is never loaded."""
    made()
    (kept,) = folder.iterdir()
    whole = kept.read_bytes()
    kept.unlink()
    kept.write_bytes(damage(whole))
    assert made().answer() == 42 and kept.read_bytes()[-32:] == native.hashlib.sha256(kept.read_bytes()[:-32]).digest()


@needs_c
def test_without_the_cache_nothing_is_kept(folder, monkeypatch):
    monkeypatch.setenv(cache.OFF, "1")
    assert made().answer() == 42 and not folder.exists()


@needs_c
def test_a_folder_that_cannot_be_written_is_no_obstacle(folder):
    folder.parent.mkdir(parents=True)
    folder.write_text("a file")
    assert made().answer() == 42


@needs_c
def test_what_does_not_compile_says_why():
    with pytest.raises(native.NoCompilerError, match=r"^cc: .*error"):
        native.library.__wrapped__("int answer(void) { return }")


def test_without_a_compiler_there_is_none(monkeypatch):
    monkeypatch.setattr(native, "compiler", lambda: "")
    with pytest.raises(native.NoCompilerError, match=r"^no C compiler: install"):
        made()
