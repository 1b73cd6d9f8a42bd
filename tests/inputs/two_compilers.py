"""A comparison of a codec's results in compiled C and in XLA, in a process of its own.

XLA contracts products into sums, and its simplifier has a reciprocal root of its own. Flags for a whole process turn
both off; XLA then does the arithmetic as written, like the C.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

FLAGS = "--xla_cpu_max_isa=AVX --xla_disable_hlo_passes=algsimp"
# Sums of the two are in another order: means may differ by this share.
MEAN = 1e-9
# Encodings whose zeros differ in sign, and no angle: XLA leaves out the addition of 0, which makes 0 of -0.
SIGN_OF_ZERO = {"spherical"}


def differences(codecs: Sequence[str]) -> dict[str, str]:
    """Describe how C and XLA differ, for each codec (such as "octahedral rg8") for which they do."""
    environment = os.environ | {"XLA_FLAGS": FLAGS, "PYTHONPATH": str(Path(__file__).parent)}
    command = [sys.executable, "-m", "two_compilers", *codecs]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)


def main(names: Sequence[str]) -> None:
    """Print the differences as JSON."""
    from normalbench.bench.ground.machine.cores import on_all_cores
    from normalbench.encodings.catalogue import ENCODINGS
    from normalbench.encodings.codecs.codec import Codec
    from normalbench.encodings.storages.storage import STORAGES

    pairs = [name.split() for name in names]
    codecs = [Codec(ENCODINGS[encoding], STORAGES[storage]) for encoding, storage in pairs]
    named_texts = zip(names, on_all_cores(difference, codecs), strict=True)
    print(json.dumps({name: text for name, text in named_texts if text}))


def difference(codec) -> str:
    """Return how C and XLA differ for a codec, in words; empty if they do not."""
    import jax
    import numpy as np

    from normalbench.bench.measures.metrics.meter import measure_together
    from normalbench.bench.measures.metrics.totals import statistics
    from normalbench.bench.measures.native.meter import NativeMeter
    from normalbench.bench.tables.quality import measure as quality

    normals, meters = chunk_of_normals(), [quality.meter_of(codec), quality.meter_by_xla(codec)]
    assert isinstance(meters[0], NativeMeter), f"{codec.name} has no C"
    (load,) = normals.loads()
    with jax.enable_x64(True):
        decoded = [np.stack([np.asarray(plane) for plane in meter.decoded(load())]) for meter in meters]
    if codec.encoding.name in SIGN_OF_ZERO:
        decoded = [planes + np.float32(0) for planes in decoded]
    apart = decoded[0].view(np.uint32) != decoded[1].view(np.uint32)
    # A number that is none has no sign that counts.
    apart &= ~(np.isnan(decoded[0]) & np.isnan(decoded[1]))
    if apart.any():
        plane, first = (int(index[0]) for index in np.nonzero(apart))
        here, there = (float(planes[plane, first]) for planes in decoded)
        normal = [float(component[first]) for component in load().n]
        return f"{apart.any(axis=0).sum()} decodes differ, first {'xyz'[plane]} of {normal}: C {here!r}, XLA {there!r}"
    ours, theirs = (statistics(normals.count, total) for total in measure_together(meters, [load], lambda _: None))
    exact = ("count", "invalid", "angle_max_deg", "angle_p99_deg", "angle_counts")
    wrong = [name for name in exact if getattr(ours, name) != getattr(theirs, name)]
    for name in ("mse", "article_mse", "angle_mean_deg", "angle_rms_deg"):
        if not np.isclose(getattr(ours, name), getattr(theirs, name), rtol=MEAN, atol=0):
            wrong.append(name)
    return ", ".join(f"{name}: C {getattr(ours, name)}, XLA {getattr(theirs, name)}" for name in wrong)


def chunk_of_normals():
    """Return a set of 2^18 normals, including the hard directions, each with a view position of its own."""
    import numpy as np
    from directions import hard_directions, random_directions, view_positions

    from normalbench.bench.subjects.normals.normal_sets import CHUNK, from_arrays

    hard = hard_directions()
    n = np.concatenate([hard, random_directions(CHUNK - len(hard))])
    return from_arrays("", "", n, view_positions(CHUNK), np.ones(CHUNK, bool))


if __name__ == "__main__":
    main(sys.argv[1:])
