"""A separate process for a driver that may crash or hang: it reads shaders and writes the compiler's results.

    python -m normalbench.bench.shaders.isa.child < JOBS

JOBS is JSON: the binding of the storage buffer, and for each job its key, stage and SPIR-V (base64). The output is
lines of JSON, each written as soon as it is known: a description of the driver, the key of each job that begins,
and its result. For an empty mapping the output is the list of the driver's files. The driver's files and the GPU
come from the environment.
"""

from __future__ import annotations

import base64
import json
import os
import sys
from collections.abc import Callable
from typing import Any

from .compiler import Compiler, DriverError, MissingDriverError, loaded_files


def own_output() -> Any:
    """Return standard output, reserved for results: the driver's own output goes to standard error."""
    own = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return own


def compiled(driver: Any, job: dict[str, Any], planes: int) -> dict[str, Any]:
    """Compile a job with the driver, and return {"kernels": [...]}, or {"failed": reason} if it does not compile."""
    code, vertex = (base64.b64decode(job[part]) for part in ("code", "vertex"))
    try:
        kernels = driver.compile(job["stage"], code, vertex, planes)
    except DriverError as error:
        return {"failed": str(error)}
    return {"kernels": kernels}


def main(compiler: Callable[[], Any] = Compiler, fingerprints: Callable[[], dict[str, str]] = loaded_files) -> int:
    """Compile every job on standard input, which is JSON, and write the results as lines of JSON; without jobs, write
    the driver's files. Return exit status 0, also after a failure, which is a line too.

    Args:
        compiler: makes a driver with the interface of `Compiler`.
        fingerprints: returns the driver's files, as `loaded_files` does.
    """
    given = json.load(sys.stdin)
    out = own_output()

    def say(**line: Any) -> None:
        print(json.dumps(line), file=out, flush=True)

    try:
        if given:
            _compile_all(compiler(), given, say)
        else:
            say(loaded=fingerprints())
    except MissingDriverError as error:
        say(missing=str(error))
    except DriverError as error:
        say(failed=str(error))
    return 0


def _compile_all(driver: Any, given: dict[str, Any], say: Callable[..., None]) -> None:
    say(device=driver.device, version=driver.version)
    for job in given["jobs"]:
        say(begun=job["key"])
        say(key=job["key"], **compiled(driver, job, given["planes"]))


if __name__ == "__main__":
    sys.exit(main())
