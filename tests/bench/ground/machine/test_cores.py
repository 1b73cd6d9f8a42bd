"""Work shared among threads: calls reuse the same threads, and get new ones after an interruption."""

import threading

import pytest

from normalbench.bench.ground.machine.cores import cores, on_all_cores


def threads_used() -> set[int]:
    """Return the identifiers of all threads of a pool; each thread waits for the others."""
    barrier = threading.Barrier(2 * cores(), timeout=10)
    return {*on_all_cores(lambda _: (barrier.wait(), threading.get_ident())[1], range(2 * cores()))}


def test_threads_are_kept_for_the_next_call():
    assert threads_used() == threads_used()


def test_a_call_within_a_call_has_threads_of_its_own():
    assert [*on_all_cores(lambda i: sum(on_all_cores(lambda j: i * j, range(20))), range(20))] == [
        190 * i for i in range(20)
    ]


def failing(_: int) -> int:
    raise ValueError("wrong")


@pytest.mark.parametrize("interrupted", [failing, None])
def test_new_threads_work_after_an_interruption(interrupted):
    """The function is interrupted, or the caller stops taking results."""
    if interrupted:
        with pytest.raises(ValueError, match="wrong"):
            list(on_all_cores(interrupted, range(20)))
    else:
        results = on_all_cores(lambda i: i, range(20))
        next(results)
        results.close()
    assert [*on_all_cores(lambda i: i + 1, range(20))] == [*range(1, 21)]
