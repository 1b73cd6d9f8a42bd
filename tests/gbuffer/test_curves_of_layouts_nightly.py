"""Material attributes on a curve or in a light encoding: their effect on the image, and errors for bad requests."""

import json
import re
from pathlib import Path

import pytest
import test_curves_of_layouts

exact = test_curves_of_layouts.exact


@pytest.mark.parametrize("first", ["roughness", "f0", "base_color"])
def test_the_manual_gives_the_psnr_of_each_curve(gl, run, tmp_path, first):  # noqa: ARG001 # a device is needed
    """Each row of the manual's table for this attribute matches `render` with a layout file to 0.1 dB."""
    page = (Path(__file__).parents[2] / "docs" / "render.md").read_text()
    rows = re.findall(rf"^\| `([\w:.]*\(?{first}\)?)`[^|]*\| ([\d.]+) \|$", page, re.M)
    others = {"base_color", "metallic", "roughness", "f0", "ao"} - {first}
    exact = "".join(
        f'[[targets]]\nformat = "rgba32f"\nholds = "{name}"\n'
        for name in ("normal.x normal.y normal.z shading_model", *others)
    )
    paths = []
    for number, (words, _) in enumerate(rows):
        paths.append(tmp_path / f"kept{number}.toml")
        own = f'[[targets]]\nformat = "rgba8"\nholds = "{words}"\n'
        paths[-1].write_text(f'encoding = "xyz"\nspace = "world"\n{exact}{own}')
    status, out, err = run("render", "--layout", ",".join(map(str, paths)), "--repeats", "0", "--format", "json")
    assert status == 0, err
    measured = {row["layout"]: row["psnr_db"] for row in json.loads(out)}
    assert len(rows) == 3
    assert [measured[path.stem] for path in paths] == pytest.approx([float(kept) for _, kept in rows], abs=0.1)
