"""A separate process for a driver that may crash or hang: it reads shaders and writes the compiler's results.

    python -m normalbench.bench.shaders.isa.child < JOBS

JOBS is JSON: the binding of the storage buffer, and for each job its key, stage and SPIR-V (base64). The output is
JSON lines, each written as soon as its contents are known: a description of the driver, and for each job its key when
it begins and then its result. For an empty mapping the output is the list of the driver's files. The driver's files
and the GPU come from the environment.
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
    """Return standard output, reserved for results; the driver's own output is redirected to standard error."""
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
    """Compile the jobs on standard input (JSON) and write the results as JSON lines; without jobs, list the driver's
    files. Return exit status 0, even after a failure, which is reported as a line.

    Args:
        compiler: a function that returns an object with the interface of `Compiler`.
        fingerprints: a function that returns the driver's files, as `loaded_files` does.
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
