"""A call that the system makes in the main thread, some seconds later."""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType


def call_later(seconds: float, call: Callable[[FrameType | None], None]) -> None:
    """Have a function called once, with the frame that is interrupted; it takes the place of one that waits."""
    signal.signal(signal.SIGALRM, lambda _, frame: call(frame))
    signal.setitimer(signal.ITIMER_REAL, seconds)


def call_none() -> None:
    """Whatever waits to be called is not."""
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, signal.SIG_IGN)
