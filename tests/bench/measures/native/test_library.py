"""Compiled C: libraries are cached, damaged libraries are compiled again and a compiler is optional."""

import ctypes

import pytest

from normalbench.bench.ground.compilers.text import judged
from normalbench.bench.ground.native import library as native
from normalbench.bench.ground.output import cache

SOURCE = "int answer(void) { return 42; }"
needs_c = pytest.mark.skipif(not native.compiler(), reason="no C compiler")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(cache.OFF, raising=False)
    return tmp_path / "normalbench" / "native"


@pytest.fixture(autouse=True)
def forgotten(monkeypatch):
    """Caches of libraries and compiler versions, emptied before and after the test."""
    native._made.cache_clear()
    native.tools.version_text.cache_clear()
    monkeypatch.setattr(native, "_hangs", [])
    yield
    native._made.cache_clear()
    native.tools.version_text.cache_clear()


def made(text: str = SOURCE) -> ctypes.CDLL:
    native._made.cache_clear()
    return native.library(judged(text, "c"), "answer")


@needs_c
def test_a_compiled_library_is_cached(folder, monkeypatch):
    assert made().answer() == 42
    (kept,) = folder.iterdir()
    monkeypatch.setattr(native, "_compiled", lambda *_: pytest.fail("compiled again"))
    assert made().answer() == 42 and [*folder.iterdir()] == [kept]


@needs_c
@pytest.mark.parametrize("damage", [lambda d: d[:-100], lambda _: b"", lambda d: d[:300] + b"x" + d[301:]])
def test_a_damaged_library_is_compiled_again(folder, damage):
    """A library that is truncated or empty or has a changed byte is never loaded."""
    made()
    (kept,) = folder.iterdir()
    whole = kept.read_bytes()
    kept.unlink()
    kept.write_bytes(damage(whole))
    assert made().answer() == 42 and kept.read_bytes()[-32:] == native.hashlib.sha256(kept.read_bytes()[:-32]).digest()


@needs_c
def test_nothing_is_stored_if_the_cache_is_off(folder, monkeypatch):
    monkeypatch.setenv(cache.OFF, "1")
    assert made().answer() == 42 and not folder.exists()


@needs_c
def test_a_library_is_compiled_without_a_writable_folder(folder):
    folder.parent.mkdir(parents=True)
    folder.write_text("a file")
    assert made().answer() == 42


@needs_c
def test_compile_error_includes_the_compilers_message():
    with pytest.raises(native.NoCompilerError, match=r"^cc: .*error"):
        made("int answer(void) { return }")


def test_a_missing_compiler_is_reported(monkeypatch):
    monkeypatch.setattr(native.tools.shutil, "which", lambda _: None)
    with pytest.raises(native.NoCompilerError, match=r"^no C compiler: .*install"):
        made()


ODD = {
    "prints what is not text": ("printf '\\377\\376'; exit 1", "^cc: "),
    "makes nothing": ("exit 0", "No such file"),
    "makes no library": ('for word; do :; done; while [ "$1" != -o ]; do shift; done; echo x > "$2"', "library.so"),
    "makes another library": (
        'echo "int other;" > o.c; exec {real} -shared -fPIC o.c -o "${{@: -2:1}}"',
        "the compiled library lacks answer",
    ),
    "does not end": ("sleep 60", "did not end within"),
}


@needs_c
@pytest.mark.parametrize("name", ODD)
def test_a_faulty_compiler_counts_as_missing(folder, tmp_path, monkeypatch, name):
    """The failure has a message, no library is cached, and a compiler that hangs is not started again."""
    script, message = ODD[name]
    real, calls = native.tools.shutil.which("cc"), tmp_path / "calls"
    (tmp_path / "bin").mkdir()
    body = f'echo >> {calls}; [ "$1" = --version ] && echo odd && exit; {script.format(real=real)}'
    (tmp_path / "bin" / "cc").write_text(f"#!/bin/bash\n{body}\n")
    (tmp_path / "bin" / "cc").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/usr/bin:/bin")
    monkeypatch.setattr(native, "COMPILING_S", 1)
    with pytest.raises(native.NoCompilerError, match=message):
        made()
    asked = calls.read_text().count("\n")
    for text in (SOURCE, SOURCE + "\n"):
        with pytest.raises(native.NoCompilerError):
            native.library(judged(text, "c"), "answer")
    assert not [*folder.glob("*.so")]
    assert calls.read_text().count("\n") == asked + (name != "does not end")
