"""Objects on a device that outlive frames."""

from contextlib import ExitStack

from normalbench.gbuffer.gl.lasting import Lasting


def test_objects_in_use_are_not_released():
    """Of the other objects, the least recently used is released."""
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
