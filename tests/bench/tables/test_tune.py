"""Tuned encodings: fits that agree with theory, and gains on held-out normals."""

import numpy as np
import pytest

from normalbench.bench.subjects.normals.normal_sets import NormalSet, axes, from_arrays, playground, sphere
from normalbench.bench.tables.tune.halves import Normals, halves_of


def all_of(chosen: NormalSet) -> Normals:
    """Return every covered normal of a set."""
    chunks = [load() for load in chosen.loads()]
    n, view = (
        np.concatenate([np.stack([np.asarray(c) for c in planes], axis=1) for planes in kind])
        for kind in zip(*((chunk.n, chunk.view) for chunk in chunks), strict=True)
    )
    covered = np.concatenate([np.asarray(chunk.covered) for chunk in chunks])
    return Normals(n[covered], view[covered])


def test_the_two_halves_make_up_the_set_and_do_not_overlap():
    for by_tiles in (True, False):
        chosen = halves_of(playground(), 0, by_tiles)
        whole = np.count_nonzero(np.concatenate([np.asarray(load().covered) for load in playground().loads()]))
        assert len(chosen.fitting) + chosen.held_out.count == whole
        assert abs(len(chosen.fitting) / whole - 0.5) < 0.02
    chosen = halves_of(sphere(2**12), 3, by_tiles=True)
    together = np.concatenate([chosen.fitting.n, all_of(chosen.held_out).n])
    assert len(np.unique(together, axis=0)) == 2**12
    other = halves_of(sphere(2**12), 4, by_tiles=True)
    assert not np.array_equal(other.fitting.n, chosen.fitting.n)


def one_direction(tmp_path):
    np.save(tmp_path / "one.npy", np.tile(np.float32([0, 0, 1]), (4096, 1)))
    return str(tmp_path / "one.npy")


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["nope"], "unknown encoding 'nope'"),
        (["stereographic,spherical"], "unknown encoding 'stereographic,spherical'"),
        (["octahedral", "--storage", "rg8"], "nothing to tune; it has no parameter and no lookup table"),
        (["xyz", "--storage", "rg8"], "3 components, but RG8 has 2 channels"),
        (["spherical", "--storage", "rg8,rg16"], "tune takes one storage, not 2"),
        (["spherical", "--parameter", "turn"], "unknown parameter 'turn'; known: all, bias, scale"),
        (["best_fit", "--storage", "rgba16f"], "nothing to tune"),
        (["stereographic", "--normals", "nope"], "unknown normal set 'nope'"),
        (["stereographic", "--normals", "sphere,axes"], "tune takes one normal set, not 2"),
        (["stereographic", "--normals", "sphere", "--count", "200"], "200 normals are too few"),
        (["stereographic", "--normals", "sphere", "--count", "17000000"], "at most 16777216"),
        (["stereographic", "--error", "median"], "unknown error 'median'; did you mean mean? known: psnr"),
        (["stereographic", "--error", "psnr,rms"], "one error at a time"),
        (["stereographic", "--table", "x.npy"], "no lookup table"),
        (["stereographic", "--seed", "-1"], "--seed -1"),
        (["stereographic", "--storage", "rg8", "--parameter", "scale", "-o", "."], "is a folder"),
        (["stereographic", "--storage", "rg8_9_9"], "these bits are named rgb8_9_9"),
    ],
)
def test_bad_input_is_a_one_line_error(run, arguments, said):
    status, out, err = run("tune", *arguments)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["stereographic:scale=1.2"], "tune starts from the published encoding; name stereographic"),
        (["best_fit", "--storage", "rgba8", "--table", "my,ta.npy"], "a name without : and comma"),
    ],
)
def test_names_that_could_not_be_used_afterwards_are_refused(run, arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("tune", *arguments, "--normals", "hemisphere", "--count", "4096")
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert not list(tmp_path.iterdir())


def test_a_set_of_one_normal_is_refused(run, tmp_path):
    status, _, err = run("tune", "stereographic", "--normals", one_direction(tmp_path))
    assert status == 2 and "all normals to fit are the same" in err and err.count("\n") == 1, err


@pytest.mark.parametrize(
    "name, said",
    [
        ("stereographic:scale=0", "scale is a number from 0.0088 to 114"),
        ("stereographic:scale=nan", "scale is a number"),
        ("stereographic:bias=1", "no parameter 'bias'; known: scale"),
        ("stereographic:scale", "such as stereographic:scale=1.7777"),
        ("stereographic:scale=1:scale=2", "give each parameter once after stereographic"),
        ("best_fit:table=", "such as best_fit:table=FILE.npy"),
        ("octahedral:scale=1", "octahedral has no parameter 'scale'; known: axis, sign"),
        ("all:scale=1", "unknown encoding 'all'"),
        ("best_fit:table=missing.npy", "missing.npy: there is no such file"),
        ("best_fit:table=text.npy", "not a NumPy file"),
        ("best_fit:table=small.npy", "needs a table of float32 of shape (1024, 1024, 1)"),
        ("best_fit:table=zero.npy", "scales above 0 and at most 1"),
    ],
)
def test_bad_name_is_a_one_line_error(run, name, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "text.npy").write_text("no array")
    np.save(tmp_path / "small.npy", np.ones((4, 4, 1), np.float32))
    np.save(tmp_path / "zero.npy", np.zeros((1024, 1024, 1), np.float32))
    status, out, err = run("quality", "--encoding", name)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


def test_axes_are_enough_for_a_fit():
    """The axes are the smallest set, with 384 normals."""
    assert len(halves_of(axes(), 0, by_tiles=False).fitting) >= 128
    n = np.float32([[0, 0, 1], [1, 0, 0]] * 200)
    assert halves_of(from_arrays("two", "two", n, n, np.ones(400, bool)), 0, by_tiles=False).held_out.count == 200
