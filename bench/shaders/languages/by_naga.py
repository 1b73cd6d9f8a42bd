"""Execution of a WGSL file on a Vulkan device, in a separate process, because some files make naga panic.

    python -m normalbench.bench.shaders.languages.by_naga FOLDER

The folder's given.wgsl computes made.bin from given.bin: rows of four numbers, with three input rows and two output
rows per normal. On failure, the last line states the reason, and the exit status is not 0.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from ...ground.compilers import tools
from ...ground.compilers.text import judged
from ...ground.machine.webgpu import NO_DRIVER, adapters
from ...ground.output.errors import MissingError

ENTRY, GROUP, ROW = "normalbench_second", 64, 16


def main(folder: Path) -> None:
    """Run the `given.wgsl` in a folder on its `given.bin` with a Vulkan device, and write the results to its
    `made.bin`. Raises MissingError if there is no device."""
    import wgpu

    all_adapters = adapters()
    if not all_adapters:
        raise MissingError(NO_DRIVER)
    given = np.fromfile(folder / "given.bin", "<f4")
    count = len(given) // 12
    gpu = all_adapters[0].request_device_sync()
    text = judged((folder / "given.wgsl").read_text(encoding="utf-8"), "wgsl")
    module = tools.webgpu_module(gpu, text)
    program = gpu.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": ENTRY})
    storage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
    source = gpu.create_buffer_with_data(data=given, usage=storage)
    output = gpu.create_buffer(size=2 * count * ROW, usage=storage)
    entries: list[Any] = [{"binding": i, "resource": {"buffer": buffer}} for i, buffer in enumerate((source, output))]
    group = gpu.create_bind_group(layout=program.get_bind_group_layout(0), entries=entries)
    commands = gpu.create_command_encoder()
    compute = commands.begin_compute_pass()
    compute.set_pipeline(program)
    compute.set_bind_group(0, group)
    compute.dispatch_workgroups(-(-count // GROUP))
    compute.end()
    gpu.queue.submit([commands.finish()])
    (folder / "made.bin").write_bytes(gpu.queue.read_buffer(output))


if __name__ == "__main__":
    try:
        main(Path(sys.argv[1]))
    except ImportError as error:
        print(f"WGSL needs wgpu ({error})", file=sys.stderr)
        sys.exit(1)
    except Exception as error:  # whatever wgpu raises
        print(" ".join(str(error).split())[:200], file=sys.stderr)
        sys.exit(1)
