"""The devices that measure tables."""

from normalbench.gbuffer.gl.device import Device

MEASURED = ("quality", "--encoding", "octahedral", "--storage", "rgba8", "--normals", "sphere", "--count", "4096")


def test_results_from_a_lost_device_do_not_become_rows(run, gl, monkeypatch):
    """A driver that loses its GPU raises no error: rows of a lost device had 6 dB instead of 61."""
    monkeypatch.setattr(Device, "answers", False)
    status, out, err = run(*MEASURED, "--backend", "glsl")
    assert (status, out) == (3, "") and err.count("\n") == 1, err
    assert err.startswith(f"normalbench: {gl.renderer} was lost by its driver"), err
