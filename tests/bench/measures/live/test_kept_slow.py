"""What a page's laboratory is given of a run: programs of codecs, their files, scenes, and damaged files."""

import subprocess
import sys


def test_a_page_has_its_laboratory_wherever_its_files_are_written(tmp_path):
    """With --live, too, which writes them elsewhere."""
    page, folder = tmp_path / "page.html", tmp_path / "there"
    words = ("--encoding", "octahedral", "--backend", "jax", "--normals", "sphere", "--count", "4096")
    command = [sys.executable, "-m", "normalbench", "quality", *words, "--live", str(folder)]
    done = subprocess.run([*command, "--report", str(page)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in folder.iterdir()] == ["octahedral-rgba8.json"]
    assert '<section id="live"' in page.read_text()
