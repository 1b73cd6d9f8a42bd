"""A file of WGSL compiled by naga, in a process that it may end.

    python -m normalbench.bench.shaders.code.run.naga FILE

What naga refuses in words is no matter here: whoever compiles it next has the words.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from ....ground.compilers import tools
from ....ground.compilers.text import judged
from ....ground.machine import children
from ....ground.machine.webgpu import adapters


def main(words: Sequence[str]) -> None:
    """Have naga read a file of WGSL, under the limits of a process for users' code."""
    children.limit_this_process()
    import wgpu

    with suppress(wgpu.GPUError):
        device = adapters()[0].request_device_sync()
        tools.webgpu_module(device, judged(Path(words[0]).read_text(encoding="utf-8"), "wgsl"))


if __name__ == "__main__":
    main(sys.argv[1:])
