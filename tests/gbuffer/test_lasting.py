"""What outlives frames on a device."""

from contextlib import ExitStack

from normalbench.gbuffer.gl.lasting import Lasting


def test_what_is_in_use_is_not_released():
    """Of the others the one that was asked for longest ago."""
    released = []
    held = Lasting(2, released.append)
    with ExitStack() as outer:
        held.used(outer, "a", lambda: "A")
        for key in "bcd":
            with ExitStack() as stack:
                assert held.used(stack, key, key.upper) == key.upper()
        assert released == ["B", "C"]
    with ExitStack() as stack:
        held.used(stack, "e", lambda: "E")
        assert held.used(stack, "d", lambda: "another") == "D"
    assert released == ["B", "C", "A"]
