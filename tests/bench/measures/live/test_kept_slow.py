"""What a page's laboratory is given of a run: programs of codecs, their files, scenes, and damaged files."""


def test_a_page_has_its_laboratory_wherever_its_files_are_written(run, tmp_path):
    """With --live, too, which writes them elsewhere."""
    page, folder = tmp_path / "page.html", tmp_path / "there"
    words = ("--encoding", "octahedral", "--backend", "jax", "--normals", "sphere", "--count", "4096")
    status, _, err = run("quality", *words, "--live", str(folder), "--report", str(page))
    assert status == 0, err
    assert [path.name for path in folder.iterdir()] == ["octahedral-rgba8.json"]
    assert '<section id="live"' in page.read_text()
