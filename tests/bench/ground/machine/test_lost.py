"""The devices that measure tables."""


def test_a_working_device_answers(gl):
    assert all(gl.answers for _ in range(20))
