"""Names of every kind are matched regardless of capitals, hyphens and underscores."""

import pytest


@pytest.mark.parametrize("file", ["spheres.html", "out/spheres.html"])
def test_a_page_is_named_after_its_file(run, tmp_path, monkeypatch, file):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    words = ("--storage", "rg8", "--backend", "jax", "--count", "1000", "--encoding", "octahedral")
    assert run("quality", *words, "--report", file)[0] == 0
    text = (tmp_path / file).read_text()
    assert "<title>normalbench: spheres</title>" in text, text[text.index("<title>") :][:80]
    assert "normalbench-" not in text[: text.index("</header>")]
