"""Compilation of a WGSL file by naga, in a process that naga may crash.

    python -m normalbench.bench.shaders.code.run.naga FILE

Error messages of naga are ignored here: they are reported when the file is compiled again.
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
    """Have naga read the WGSL file that the first word names, under the limits of a process for users' code. A
    refused file is not an error."""
    children.limit_this_process()
    import wgpu

    with suppress(wgpu.GPUError):
        device = adapters()[0].request_device_sync()
        tools.webgpu_module(device, judged(Path(words[0]).read_text(encoding="utf-8"), "wgsl"))


if __name__ == "__main__":
    main(sys.argv[1:])
