"""WGSL: compiled by naga and run on a Vulkan device, both through wgpu."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .....encodings.codecs.files import file_text
from .....gbuffer.gl.shader import ShaderError
from ....ground.compilers import tools
from ....ground.compilers.text import Text
from ....ground.machine import children
from ....ground.machine.systems import forks
from ....ground.machine.systems.processes import signal_name
from ....ground.machine.webgpu import API, NO_DRIVER, adapters
from ....ground.output.errors import MissingError
from ...judged import judged_text
from .interface import GIVEN, MADE, Interface, Ran, Run, Runner, ran_of, rows_of
from .sources import SECONDS, folder

WRAPPER = Path(__file__).with_suffix(".j2")
MAIN, GROUP = "run_main", 64
INSTALL = "pip install wgpu"
ROW = 16  # bytes: four numbers


@cache
def device() -> Any:
    """Return wgpu's first device. Raises MissingError, which says what to install."""
    try:
        gpus = adapters()
    except ImportError as error:
        raise MissingError(f"WGSL needs wgpu ({error}); {INSTALL}") from error
    if not gpus:
        raise MissingError(NO_DRIVER)
    # Tables may be larger than what every device has.
    limits = gpus[0].limits
    asked = ("max-buffer-size", "max-storage-buffer-binding-size", "max-texture-dimension-2d")
    return gpus[0].request_device_sync(required_limits={name: limits[name] for name in asked})


def device_name() -> str:
    """Return the device's name as it appears in rows. Raises MissingError."""
    return f"{device().adapter.info['device']}, {API}"


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile a file for the Vulkan device, and yield a function that runs it. Raises MissingError, ShaderError."""
    gpu = device()
    text = judged_text(_text(path, interface), "wgsl")
    if not interface.is_ours:
        _try_apart(path, text)
    program = Program(gpu, str(path), text, interface.tables, 2)

    def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        given = rows_of(n, view, texels)
        count = len(given) // GIVEN
        rows, words = program(given, count, [MADE * count * ROW, count * ROW])
        return ran_of(rows.view(np.float32).reshape(-1, 4), words.reshape(-1, 4), interface)

    yield run


class Program:
    """A compiled compute shader, with its lookup tables as textures of group 0, in the order of their names.

    Args:
        gpu: the device.
        name: the name of the text in messages.
        text: the shader; its entry point MAIN reads the first buffer of group 1 and writes the others.
        tables: the lookup tables by name, float32 of shape (height, width, channels).
        results: the number of buffers that the shader writes.

    Raises:
        ShaderError: the shader does not compile; one line.
    """

    def __init__(self, gpu: Any, name: str, text: Text, tables: Mapping[str, np.ndarray], results: int):
        import wgpu

        self._gpu, seen = gpu, wgpu.ShaderStage.COMPUTE
        kinds = ("read-only-storage", *["storage"] * results)
        chosen, kind = [_texture(gpu, tables[each]) for each in sorted(tables)], {"sample_type": "unfilterable-float"}
        textures = [{"binding": binding, "visibility": seen, "texture": kind} for binding in range(len(chosen))]
        buffers = [
            {"binding": binding, "visibility": seen, "buffer": {"type": kind}} for binding, kind in enumerate(kinds)
        ]
        bound = [{"binding": binding, "resource": texture.create_view()} for binding, texture in enumerate(chosen)]
        layouts = [gpu.create_bind_group_layout(entries=entries) for entries in (textures, buffers)]
        self._tables = gpu.create_bind_group(layout=layouts[0], entries=bound)
        try:
            module = tools.webgpu_module(gpu, text)
            layout = gpu.create_pipeline_layout(bind_group_layouts=layouts)
            compute = {"module": module, "entry_point": MAIN}
            self._pipeline = gpu.create_compute_pipeline(layout=layout, compute=compute)
        except wgpu.GPUError as error:
            raise ShaderError(f"{name}: {_complaint(str(error))}") from error

    def __call__(self, given: np.ndarray, count: int, sizes: Sequence[int]) -> list[np.ndarray]:
        """Run the shader for `count` rows and return its output buffers, of these sizes in bytes, as uint32."""
        import wgpu

        if not count:
            return [np.zeros(0, np.uint32) for _ in sizes]
        usage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
        buffers = [self._gpu.create_buffer_with_data(data=given, usage=usage)]
        buffers += [self._gpu.create_buffer(size=size, usage=usage) for size in sizes]
        bound = [{"binding": binding, "resource": {"buffer": buffer}} for binding, buffer in enumerate(buffers)]
        group = self._gpu.create_bind_group(layout=self._pipeline.get_bind_group_layout(1), entries=bound)
        commands = self._gpu.create_command_encoder()
        compute = commands.begin_compute_pass()
        compute.set_pipeline(self._pipeline)
        compute.set_bind_group(0, self._tables)
        compute.set_bind_group(1, group)
        compute.dispatch_workgroups(-(-count // GROUP))
        compute.end()
        self._gpu.queue.submit([commands.finish()])
        return [np.frombuffer(self._gpu.queue.read_buffer(buffer), np.uint32) for buffer in buffers[1:]]


def _texture(gpu: Any, table: np.ndarray) -> Any:
    import wgpu

    height, width, channels = table.shape
    texels = np.zeros((height, width, 4), np.float32)
    texels[..., :channels] = table
    usage = wgpu.TextureUsage.TEXTURE_BINDING | wgpu.TextureUsage.COPY_DST
    texture = gpu.create_texture(size=(width, height, 1), format="rgba32float", usage=usage)
    layout = {"bytes_per_row": width * ROW, "rows_per_image": height}
    gpu.queue.write_texture({"texture": texture}, texels, layout, (width, height, 1))
    return texture


def _try_apart(path: Path, text: Text) -> None:
    """Compile a user's text in a separate process, because some texts crash naga. Raises ShaderError."""
    with folder() as place:
        tools.put(place / "code.wgsl", text)
        try:
            done = forks.finished(f"{__package__}.naga", [str(place / "code.wgsl")], SECONDS)
        except subprocess.TimeoutExpired as error:
            raise ShaderError(f"{path}: naga did not end within {SECONDS} s") from error
    if done.returncode:
        how = signal_name(done.returncode) or children.how_it_ended(done)
        raise ShaderError(f"{path.name}: naga crashed ({how}); other backends may accept the file")


def _text(path: Path, interface: Interface) -> str:
    from jinja2 import Environment, StrictUndefined

    frame = Environment(undefined=StrictUndefined, trim_blocks=True).from_string(file_text(WRAPPER))
    try:
        return file_text(path) + frame.render(interface.defines)
    except (OSError, ValueError) as error:
        raise ShaderError(f"{path}: {error}") from error


def _complaint(output: str) -> str:
    """Return naga's complaint and its line, as one line of at most 400 characters. The file's own lines come first,
    so that the line's number is right."""
    words = " ".join(output.split())
    for mark in ("Shader '' parsing error:", "Caused by:"):
        words = words.partition(mark)[2].strip() or words
    return words[:400]


def how() -> str:
    """Return the version of wgpu, whose compiler is naga, and the device, as text. Raises MissingError."""
    from importlib.metadata import version

    return f"wgpu {version('wgpu')} (naga), {device_name()}" if device() else ""


RUNNER = Runner(prepared, how)
