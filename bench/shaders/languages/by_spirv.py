"""Execution of a SPIR-V module on OpenGL, in a separate process, because some modules crash drivers.

    python -m normalbench.bench.shaders.languages.by_spirv FOLDER

The folder's made.spv, compiled from second.hlsl, computes made.bin from given.bin: rows of four numbers, with three
input rows and two output rows per normal. On failure, the last line states the reason, and the status is not 0.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from ....gbuffer.gl.device import NoDeviceError, device
from ....gbuffer.gl.raw import compute_program, dispatch

EXTENSION, ENTRY = "GL_ARB_gl_spirv", "main"
# Statuses: nothing runs SPIR-V here; the module did what its language does not define.
NO_DEVICE, UNDEFINED = 3, 4
GROUP, GIVEN, MADE, ROW = 64, 3, 2, 16
# Functions of second.hlsl, in an overload for each type: one is told both sides of a division, one converts floats.
NOTED, CONVERTED = b"normalbench_noted", b"normalbench_converted"
# SPIR-V: words before the first instruction, and where the first unused number is in them.
HEADER, BOUND = 5, 3
NAME, POINTER, FUNCTION_TYPE, NULL, FUNCTION, CALL, VARIABLE = 5, 32, 33, 46, 54, 57, 59
# OpUDiv, OpSDiv, OpUMod, OpSRem and OpSMod: an OpenGL driver gives anything where they are not defined.
DIVISIONS = (134, 135, 137, 138, 139)
# OpConvertFToU and OpConvertFToS; how many operands a variable has that begins as anything.
CONVERSIONS, UNSET = (109, 110), 3


def defined(module: bytes) -> bytes:
    """Return a SPIR-V module, changed so that undefined operations in it do not look defined.

    Integer divisions are noted, the functions CONVERTED convert floats to integers, and variables start at 0.

    Raises:
        ValueError: the module divides integers of a size other than 32 bits.
    """
    words = np.frombuffer(module, "<u4")
    instructions = [*_instructions(words)]
    first = next(i for i, (opcode, _) in enumerate(instructions) if opcode == FUNCTION)
    declared, bodies = instructions[:first], instructions[first:]
    names = {of[0]: of[1:].tobytes() for opcode, of in declared if opcode == NAME}
    parameters = {of[0]: of[2:] for opcode, of in declared if opcode == FUNCTION_TYPE}
    pointees = {of[0]: of[2] for opcode, of in declared if opcode == POINTER}
    functions = [of for opcode, of in bodies if opcode == FUNCTION]
    notes = {parameters[of[3]][0]: of[:2] for of in functions if names.get(of[1], b"").startswith(NOTED)}
    converters = {of[0]: of[1] for of in functions if names.get(of[1], b"").startswith(CONVERTED)}
    unset = dict.fromkeys(pointees[of[0]] for opcode, of in bodies if opcode == VARIABLE and len(of) == UNSET)
    numbers = itertools.count(int(words[BOUND]))
    zeros = dict(zip(unset, numbers, strict=False))
    new_words = [word for instruction in declared for word in _written(*instruction)]
    new_words += [word for of_type, zero in zeros.items() for word in _written(NULL, (of_type, zero))]
    function = 0
    for opcode, of in bodies:
        function = of[1] if opcode == FUNCTION else function
        if opcode in DIVISIONS:
            divided_type, _, x, y = of
            if divided_type not in notes:
                raise ValueError("integer division is supported only in 32 bits")
            result, note = notes[divided_type]
            new_words += _written(CALL, (result, next(numbers), note, x, y))
        if opcode in CONVERSIONS and of[0] in converters and function not in converters.values():
            new_words += _written(CALL, (of[0], of[1], converters[of[0]], of[2]))
        elif opcode == VARIABLE and len(of) == UNSET:
            new_words += _written(VARIABLE, (*of, zeros[pointees[of[0]]]))
        else:
            new_words += _written(opcode, of)
    header = [*words[:BOUND], next(numbers), *words[BOUND + 1 : HEADER]]
    return np.array([*header, *new_words], "<u4").tobytes()


def _written(opcode: int, operands: Iterable[int]) -> list[int]:
    operands = [*operands]
    return [(len(operands) + 1) << 16 | opcode, *operands]


def _instructions(words: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """Yield the opcode and the operands of each instruction in a module's words."""
    offset = HEADER
    while offset < len(words):
        size, opcode = divmod(int(words[offset]), 1 << 16)
        yield opcode, words[offset + 1 : offset + size]
        offset += size


def main(folder: Path) -> int:
    """Run the `made.spv` in a folder on its `given.bin`, write the results to its `made.bin`, and return the exit
    status of the process: UNDEFINED if the module did something undefined, else 0."""
    context = device().context
    if EXTENSION not in context.extensions:
        raise NoDeviceError(f"the OpenGL driver does not support {EXTENSION}")
    program = compute_program(defined((folder / "made.spv").read_bytes()), ENTRY)
    given = np.fromfile(folder / "given.bin", "<f4").reshape(-1, GIVEN * 4)
    groups = -(-len(given) // GROUP)
    # The last group is filled up with the first rows.
    source = context.buffer(np.resize(given, (groups * GROUP, GIVEN * 4)).tobytes())
    output, undefined = context.buffer(reserve=groups * GROUP * MADE * ROW), context.buffer(bytes(12))
    for binding, buffer in enumerate((source, output, undefined)):
        buffer.bind_to_storage_buffer(binding)
    dispatch(program, groups)
    (folder / "made.bin").write_bytes(output.read(len(given) * MADE * ROW))
    return UNDEFINED if any(undefined.read(4)) else 0


if __name__ == "__main__":
    try:
        sys.exit(main(Path(sys.argv[1])))
    except NoDeviceError as error:
        print(error, file=sys.stderr)
        sys.exit(NO_DEVICE)
    except Exception as error:  # whatever the driver says
        print(" ".join(str(error).split())[:200], file=sys.stderr)
        sys.exit(1)
