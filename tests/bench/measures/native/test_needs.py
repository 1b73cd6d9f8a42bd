"""Which steps need the same C compiler wherever they are measured."""

from normalbench.bench.run.workers.about import CAN
from normalbench.bench.tables.quality.measure import LARGE
from normalbench.bench.tables.quality.work import WORK
from normalbench.bench.tables.table import C_COMPILER, GL, VULKAN, Step


def needs(**key) -> frozenset[str]:
    return WORK.needs(Step(key, None, ""))


def test_large_rows_by_jax_need_the_c_compiler():
    assert needs(backend="jax", count=LARGE) == {C_COMPILER}
    assert needs(backend="jax", count=LARGE - 1) == frozenset()
    assert needs(backend="glsl", count=LARGE) == {GL, VULKAN}
    assert CAN[C_COMPILER]()
