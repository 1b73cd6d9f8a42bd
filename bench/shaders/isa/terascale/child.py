"""The process of its own for r600; see `..child`, whose jobs have GLSL where SPIR-V stands there.

python -m normalbench.bench.shaders.isa.terascale.child < JOBS
"""

from __future__ import annotations

import sys

from ..child import main
from .compiler import Compiler, loaded

if __name__ == "__main__":
    sys.exit(main(Compiler, loaded))
