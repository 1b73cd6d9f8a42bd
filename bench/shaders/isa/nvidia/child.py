"""A separate process for NVIDIA's compiler, which may crash or hang: it reads CUDA and writes the compiler's results.

    python -m normalbench.bench.shaders.isa.nvidia.child < JOBS

Input and output are as in `bench.shaders.isa.child`, but a job's code is CUDA text. ARCHITECTURE names the GPU.
"""

from __future__ import annotations

import base64
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from ....ground.machine.systems.processes import limit_memory
from ..child import own_output
from ..compiler import DriverError, MissingDriverError
from . import sass, tools
from .cubin import Kernel, kernel_of
from .listing import listings
from .nvrtc import Nvrtc

ARCHITECTURE = "NORMALBENCH_CUDA_ARCHITECTURE"
LANES = 32
# Of kernels that one run of the disassembler lists.
MOST_AT_ONCE = 64
# Bytes of this process; it takes a tenth of them.
MEMORY = 4 << 30


def main() -> int:
    """Compile the jobs in the JSON on standard input, write the results as JSON lines, and return 0."""
    limit_memory(MEMORY)
    given = json.load(sys.stdin)
    out = own_output()

    def say(**line: Any) -> None:
        print(json.dumps(line), file=out, flush=True)

    try:
        _compile_all(given["jobs"], os.environ[ARCHITECTURE], say)
    except MissingDriverError as error:
        say(missing=str(error))
    except DriverError as error:
        say(failed=str(error))
    return 0


def _compile_all(jobs: Sequence[dict[str, str]], architecture: str, say: Callable[..., None]) -> None:
    library, lister = tools.found()
    compiler = Nvrtc(library)
    compiler.check(architecture)
    say(device=architecture, version=tools.title(compiler.version))
    for first in range(0, len(jobs), MOST_AT_ONCE):
        some = jobs[first : first + MOST_AT_ONCE]
        compiled: dict[str, Kernel] = {}
        for job in some:
            say(begun=job["key"])
            try:
                text = base64.b64decode(job["code"]).decode()
                compiled[job["key"]] = kernel_of(compiler.cubin(text, architecture))
            except DriverError as error:
                say(key=job["key"], failed=str(error))
        for key, answer in _listed(compiled, architecture, lister):
            say(key=key, **answer)


def _listed(compiled: dict[str, Kernel], architecture: str, lister: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each kernel's key and its result, a dictionary: `kernels` with statistics and listing, or `failed` with
    the reason. Kernels are listed one by one if they cannot be listed together."""
    if not compiled:
        return
    try:
        texts = listings([kernel.code for kernel in compiled.values()], architecture, lister)
    except DriverError as error:
        if len(compiled) == 1:
            yield next(iter(compiled)), {"failed": str(error)}
            return
        for key, kernel in compiled.items():
            yield from _listed({key: kernel}, architecture, lister)
        return
    for (key, kernel), text in zip(compiled.items(), texts, strict=True):
        yield key, {"kernels": [{"simd_width": LANES, "statistics": statistics(kernel, text), "assembly": text}]}


def statistics(kernel: Kernel, assembly: str) -> dict[str, int]:
    """Return a kernel's known statistics, under the names that the columns of `cost` are computed from; spill counts
    are included only if they are 0."""
    count = len(sass.instructions(assembly))
    figures = {"Instructions": count, "Registers": kernel.registers, "Code size": count * sass.SIZE}
    figures |= {"Stall cycles": sass.stall_cycles(assembly)}
    # What lies on a stack is spilled, or an array: only nothing is told from something.
    figures |= {"Spill Count": 0, "Fill Count": 0} if kernel.stack == 0 else {}
    return {name: figure for name, figure in figures.items() if figure is not None}


if __name__ == "__main__":
    sys.exit(main())
