"""A function call in the main thread after some seconds."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from types import FrameType

Call = Callable[[FrameType | None], None]

if sys.platform == "win32":
    import _thread
    from threading import Timer

    # Windows has no signal of a timer. Python runs the handler of a signal in the main thread, whoever asks for it.
    _SIGNAL = signal.SIGBREAK
    _waiting: list[Timer] = []

    def call_later(seconds: float, call: Call) -> None:
        """Arrange for a function to be called once after some seconds, with the interrupted frame as its argument.
        Cancel any pending call."""
        call_none()
        signal.signal(_SIGNAL, lambda _, frame: call(frame))
        timer = Timer(seconds, _thread.interrupt_main, [_SIGNAL])
        timer.daemon = True
        _waiting.append(timer)
        timer.start()

    def call_none() -> None:
        """Cancel any call that is waiting."""
        while _waiting:
            _waiting.pop().cancel()
        signal.signal(_SIGNAL, signal.SIG_IGN)

else:

    def call_later(seconds: float, call: Call) -> None:
        """Arrange for a function to be called once after some seconds, with the interrupted frame as its argument.
        Cancel any pending call."""
        signal.signal(signal.SIGALRM, lambda _, frame: call(frame))
        signal.setitimer(signal.ITIMER_REAL, seconds)

    def call_none() -> None:
        """Cancel any call that is waiting."""
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, signal.SIG_IGN)
