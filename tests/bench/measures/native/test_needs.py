"""The steps that need the same C compiler on every machine that measures them."""

from normalbench.bench.run.workers.about import CAN
from normalbench.bench.tables.quality.work import WORK
from normalbench.bench.tables.table import C_COMPILER, GL, VULKAN, Step


def needs(backend: str) -> frozenset[str]:
    return WORK.needs(Step({"backend": backend}, None, ""))


def test_rows_measured_by_jax_need_the_c_compiler():
    assert needs("jax") == {C_COMPILER}
    assert needs("glsl") == {GL, VULKAN}
    assert CAN[C_COMPILER]()
