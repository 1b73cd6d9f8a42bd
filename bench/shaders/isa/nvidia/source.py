"""The CUDA kernel of an operation: its GLSL, translated, between loads and stores."""

from __future__ import annotations

import re
from pathlib import Path

from .....gbuffer.defines.kernels import Operation
from .....gbuffer.gl.shader import ShaderError
from ....ground.compilers.lines import bare
from ....ground.compilers.text import RefusedError, judged, own
from ....ground.output import cache as kept
from ...translator import tree
from ...translator.glsl_parser import read_glsl
from ...translator.reduce import reduced
from ...translator.tree import TranslationError
from .cuda_writer import CudaWriter, kind_text

FOLDER = Path(__file__).parent
ROOT, LANGUAGE, KERNEL = (FOLDER / name for name in ("operation.glsl", "glsl.cuh", "kernel.cu"))
PREFIX = "kernel"
# Of the kernel around an operation.
MACROS = ("GROUP", "BESIDE_PLANE", "GIVEN", "BESIDE", "MADE")


def cuda_of(operation: Operation) -> str:
    """Return the complete CUDA text of an operation's kernel. Raises ShaderError as `functions_of` does."""
    head = "".join(f"#define {name} {kind_text(str(operation.defines[name]))}\n" for name in MACROS)
    try:
        parts = (judged(head, "cuda"), own(LANGUAGE), judged(bare(functions_of(operation)), "cuda"), own(KERNEL))
    except RefusedError as error:
        raise ShaderError(f"not compiled for NVIDIA: {error.why}") from error
    return "\n".join((*(part.content for part in parts), "}  // namespace glsl\n"))


def functions_of(operation: Operation) -> str:
    """Return the text of an operation's own functions, written for glsl.cuh, with `kernel_operation` last. Results
    are cached by GLSL text.

    Raises:
        ShaderError: the GLSL cannot be read, or contains something that cannot be translated; the message names the
            file and the line.
    """
    source = operation.source(str(ROOT))

    def make() -> dict[str, str]:
        try:
            program = reduced(read_glsl(source.text), {"kernel_operation": "operation"}, PREFIX, PREFIX)
            return {"text": CudaWriter(PREFIX, {}).program(program)}
        except TranslationError as error:
            message = source.explain(re.sub(r"^(\d+):\d+: ", r"0:\1: ", str(error)))
            raise ShaderError(f"{message}; CUDA does not allow that, and the counts for NVIDIA use CUDA") from error

    key = kept.key_of("cuda", source.text, *(path.read_text(encoding="utf-8") for path in _own_files()))
    return kept.kept(key, make)["text"]


def _own_files() -> list[Path]:
    """Return the paths of the source files that determine how GLSL is translated."""
    return [*sorted(Path(tree.__file__).parent.glob("*.py")), FOLDER / "cuda_writer.py"]
