"""The devices that tables are measured on."""


def test_a_device_that_draws_says_so(gl):
    assert all(gl.answers for _ in range(20))
