"""Steps and workers that come and go, without any processes: every step has its rows once, or a reason."""

from concurrent.futures import CancelledError

import pytest

from normalbench.bench.run.workers.carrier import Answer


def test_scheduler_task_is_lost_or_sent_again_or_raises():
    """A task that dask abandons is lost; a task cancelled with its scheduler is sent again; others raise."""
    from distributed import KilledWorker

    from normalbench.bench.run.workers.scheduled import _answer

    class Future:
        def __init__(self, status, error):
            self.status, self._error = status, error

        def exception(self, timeout):  # noqa: ARG002
            return self._error

        def result(self, timeout):  # noqa: ARG002
            raise self._error

    assert _answer(Future("error", KilledWorker("task", None, 3))) == Answer(lost=4)
    assert _answer(Future("cancelled", CancelledError())) is None
    assert _answer(Future("finished", TimeoutError())) is None
    with pytest.raises(OSError, match="no space"):
        _answer(Future("error", OSError("no space")))
