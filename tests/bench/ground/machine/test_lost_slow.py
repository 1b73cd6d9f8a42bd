"""The devices that tables are measured on."""

from normalbench.gbuffer.gl.device import Device

MEASURED = ("quality", "--encoding", "octahedral", "--storage", "rgba8", "--normals", "sphere", "--count", "4096")


def test_what_a_lost_device_gives_is_no_row(run, gl, monkeypatch):
    """A driver that loses its GPU raises nothing: rows of one that did had 6 dB in place of 61."""
    monkeypatch.setattr(Device, "answers", False)
    status, out, err = run(*MEASURED, "--backend", "glsl")
    assert (status, out) == (3, "") and err.count("\n") == 1, err
    assert err.startswith(f"normalbench: {gl.renderer} was lost by its driver"), err
