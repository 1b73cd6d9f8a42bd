"""`normalbench renderdoc`: the script saves a G-buffer unchanged, and prints commands that measure it."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import captured_program
import numpy as np
import OpenImageIO as oiio  # noqa: N813 # as its own documentation has it
import pytest
from screens import screen
from typed import scene_makers_named

from normalbench.bench.tables.budget.rates import Exact, Stage
from normalbench.gbuffer.gl.device import device
from normalbench.gbuffer.scenes.setting import Setting


def lacking():
    """Return the reason why this machine cannot make a capture; an empty text if it can."""
    if not Path("/usr/bin/python3").exists() or not shutil.which("Xvfb"):
        return "no Xvfb; install it (Debian: apt-get install xvfb)"
    has = subprocess.run(["/usr/bin/python3", "-c", "import renderdoc"], capture_output=True).returncode == 0
    return "" if has else "no RenderDoc for Python; install it (Debian: apt-get install python3-renderdoc)"


@pytest.fixture
def display():
    """A display of a separate X server, on which RenderDoc replays OpenGL."""
    if why := lacking():
        pytest.skip(why)
    with screen() as name:
        yield name


@pytest.mark.usefixtures("gl")
def test_a_captured_program_is_measured(display, run, tmp_path, monkeypatch):
    """RenderDoc captures and replays the program. The normals match its sphere, the camera's planes and angle are
    found, and the printed commands run."""
    monkeypatch.chdir(tmp_path)
    shown = {**os.environ, "DISPLAY": display}
    program = [sys.executable, captured_program.__file__, str(tmp_path / "frame")]
    subprocess.run(program, env={**shown, "LD_PRELOAD": "librenderdoc.so"}, check=True)
    (capture,) = tmp_path.glob("*.rdc")
    assert run("renderdoc", "--script", "save.py")[0] == 0
    words = ["/usr/bin/python3", "save.py", str(capture)]
    done = subprocess.run(words, env=shown, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    frame = json.loads(Path("gbuffer/gbuffer.json").read_text())
    kept = frame["capture"]
    formats = {name: target["format"] for name, target in kept["targets"].items()}
    assert (
        list(formats.values()) == ["R8G8B8A8_UNORM", "R10G10B10A2_UNORM", "R16_FLOAT"] and "GBuffer normal" in formats
    )
    assert [bool(target["normals"]) for target in kept["targets"].values()] == [False, True, False]
    assert np.allclose(np.loadtxt("gbuffer/view_matrix.txt"), captured_program.view())
    check_pixels()
    quality, world, depth = kept["commands"]
    assert "--near 0.1 --far 100 --fov 60" in depth and "--fov 60" in quality
    assert done.stdout.splitlines()[-2:] == [depth, "normalbench budget --bytes 12,16 --scene gbuffer/gbuffer.json"]
    (row, *_) = rows_of(run, quality)
    assert row["count"] > 2000 and 45 < row["psnr_db"] < 55
    turned = rows_of(run, quality + world.partition("add:")[2])
    assert turned[0]["psnr_db"] == pytest.approx(row["psnr_db"], abs=1e-3), "the camera does not turn"
    assert all(row["relative_max"] < 1e-3 for row in rows_of(run, depth))
    guessed = [name for name in ("base_color", "roughness") if frame[name]]
    assert len(guessed) == 2 and frame["metallic"] is None and "guessed" in done.stdout and "metallic" in done.stdout
    check_scene()


def check_scene():
    """Check the captured sphere as a scene: its roughness, its base colour, and its normal at the centre."""
    (maker,) = scene_makers_named("gbuffer/gbuffer.json")
    assert maker.sides == captured_program.SIZE
    with ExitStack() as stack:
        exact = Exact(device(), stack, Stage(maker, Setting(), maker.sides))
        covered, surfaces = exact.covered, exact.surfaces
    assert 2000 < covered.sum() < 8000 and set(np.unique(surfaces.roughness[covered])) == {0.375}
    assert np.allclose(surfaces.base_color[covered], np.round(np.array([1, 0.5, 0.25]) * 255) / 255, atol=1e-6)
    middle = surfaces.normal[45, 80]
    assert np.allclose(middle, (0, 0, 1), atol=0.03)


def rows_of(run, command):
    status, out, err = run(*shlex.split(command)[1:], "--backend", "jax", "--format", "json")
    assert status == 0, err
    return json.loads(out)


def check_pixels():
    """Check that normals are upright and have unit length, and that the mask covers the sphere but not the corner."""
    image = oiio.ImageBuf("gbuffer/gbuffer_normal.exr")
    names = list(image.spec().channelnames)
    pixels = image.get_pixels(oiio.FLOAT)
    normals = pixels[..., [names.index(name) for name in "RGB"]] * 2 - 1
    mask = pixels[..., names.index("covered")] == 1
    height, width = mask.shape
    top, bottom = normals[height // 4, width // 2], normals[3 * height // 4, width // 2]
    assert top[1] > 0.5 and bottom[1] < -0.5 and mask[height // 2, width // 2] and not mask[0, 0]
    assert np.abs(np.linalg.norm(normals[mask], axis=-1) - 1).max() < 0.003
