"""`normalbench depth`: output, files and messages for bad input."""

from test_depth_command import QUICK


def test_the_plot_is_drawn(run, tmp_path):
    for name, head in (("plot.png", b"\x89PNG"), ("plot.svg", b"<?xml")):
        status, _, err = run(*QUICK, "--plot", str(tmp_path / name))
        assert status == 0, err
        assert (tmp_path / name).read_bytes().startswith(head)
    svg = (tmp_path / "plot.svg").read_text()
    labels = ("linear packed16", "window depth32f", "near 1, far 100")
    assert all(f">{label}</text>" in svg for label in labels), svg[:500]
