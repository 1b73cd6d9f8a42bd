"""Steps and workers that come and go, without any process: every step has its rows once, or a reason."""

import pickle
import random
from collections import Counter
from dataclasses import dataclass, field

import pytest

from normalbench.bench.ground.options.words import Words, given_in
from normalbench.bench.run.measuring import Asked
from normalbench.bench.run.workers.admission import Admission
from normalbench.bench.run.workers.carrier import LOST
from normalbench.bench.run.workers.chunks import MOST_LOST, MOST_TOGETHER, chunk_size
from normalbench.bench.run.workers.pool import Pool
from normalbench.bench.run.workers.tasks import Answer, StepAnswer
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import GL, VULKAN, Role, Step

CAN = {GL: "llvmpipe", VULKAN: "lavapipe", "compilers": "all"}
OWN = {"versions": {"jax": "1"}, "sources": "abc", "processor": "fast", "host": "h", "name": "me", "can": CAN}


def asked(table: str, keys: list[dict]) -> Asked:
    options = TABLES[table].options()
    return Asked(TABLES[table], options, TABLES[table].outputs(), [Step(key, None, str(key)) for key in keys])


@dataclass
class FakeCrew:
    """Workers as told: `at` makes an answer of a worker and a chunk, or says that the worker is gone."""

    workers: dict[str, dict]
    at: object = None
    generation: int = 0
    is_deciding: bool = False
    sent: list = field(default_factory=list)
    under_way: dict = field(default_factory=dict)
    gone: list = field(default_factory=list)
    most: Counter = field(default_factory=Counter)

    def __post_init__(self):
        self.admission = Admission(OWN)
        for address, changes in self.workers.items():
            self.admission.take(address, OWN | {"name": address} | changes)

    def expect(self):
        pass

    def idle(self):
        return [address for address in self.admission if address not in self.under_way]

    def busy_hosts(self):
        return {self.admission.host(address) for address in self.under_way}

    def send(self, address, what, function, order, names):  # noqa: ARG002
        self.sent.append((address, what, order))
        self.under_way[address] = (what, names)
        self.most[self.admission.host(address)] = max(
            self.most[self.admission.host(address)], len([a for a in self.under_way if a in self.admission])
        )

    def arrival(self):
        if not self.under_way:
            return None
        address = next(iter(self.under_way))
        chunk, names = self.under_way.pop(address)
        found = self.at(address, names) if self.at else answer(names)
        if found == "gone":
            self.gone.append((chunk, True))
            return None
        if found == "scheduler":
            self.gone += [(chunk, False), *((c, False) for c, _ in self.under_way.values())]
            self.under_way.clear()
            self.generation += 1
            return None
        return address, chunk, found

    def lost(self):
        gone, self.gone = self.gone, []
        return gone


def answer(names) -> Answer:
    return Answer([StepAnswer(name, [{"of": name}], {}) for name in names])


def measured(crew: FakeCrew, ask: Asked) -> tuple[list[str], list]:
    ticks: list[str] = []
    return ticks, list(Pool(crew).measure(ask, ask.steps, ticks.append))


JAX = [{"backend": "jax", "encoding": f"e{n}"} for n in range(200)]


def test_every_step_has_its_rows_once():
    crew, ask = FakeCrew({"a": {}, "b": {}, "c": {}}), asked("quality", JAX)
    ticks, found = measured(crew, ask)
    assert Counter(step.name for step, _ in found) == Counter(step.name for step in ask.steps)
    assert sorted(ticks) == sorted(step.name for step in ask.steps)
    assert [isinstance(order, str) for _, _, order in crew.sent].count(False) == 3, "the order is sent to each once"


@pytest.mark.parametrize("seed", range(20))
def test_workers_and_schedulers_that_are_lost_at_random_lose_nothing(seed):
    """A tenth of all tasks ends its worker, and a tenth the scheduler or the answer."""
    rng = random.Random(seed)

    def at(_, names):
        ends = rng.random()
        if ends < 0.3:
            return ["gone", "scheduler", LOST][int(ends * 10)]
        return Answer(knows=False) if ends < 0.35 else answer(names[: rng.randint(0, len(names))])

    _, found = measured(FakeCrew({"a": {}, "b": {}, "c": {}, "d": {}}, at), asked("quality", JAX))
    assert Counter(step.name for step, _ in found) == Counter(str(key) for key in JAX)


def test_a_step_that_ends_worker_after_worker_loses_its_own_rows(capsys):
    """The others of its chunk are measured; its row has the reason, and standard error its name."""
    ask = asked("quality", JAX)
    bad = JAX[5]
    name = {}

    def at(_, names):
        return "gone" if name["bad"] in names else answer(names)

    from normalbench.bench.run.workers.orders import step_name

    name["bad"] = step_name("quality", bad)
    crew = FakeCrew({"a": {}, "b": {}}, at)
    _, found = measured(crew, ask)
    rows = {step.name: rows for step, rows in found}
    (lost,) = rows[str(bad)]
    assert lost["skipped"] == f"{MOST_LOST + 1} workers were lost while they measured it"
    assert lost["encoding"] == "e5" and lost["backend"] == "jax" and lost["mse"] is None
    assert sum("of" in row for one in rows.values() for row in one) == len(JAX) - 1
    assert f"{bad}: {MOST_LOST + 1} workers were lost" in capsys.readouterr().err


def test_a_worker_without_the_device_gets_no_step_that_needs_it(capsys):
    """Whatever is left for it; of GL steps a worker with another device gets none either."""
    keys = [{"backend": name, "encoding": f"e{n}"} for n in range(40) for name in ("jax", "glsl")]
    others = {"b": {"can": CAN | {GL: "no GL 4.3 device"}}, "c": {"can": CAN | {GL: "a GPU"}}}
    crew = FakeCrew({"a": {}, **others})
    _, found = measured(crew, asked("quality", keys))
    assert len(found) == len(keys)
    needs = {(address, one.needs) for address, chunk, _ in crew.sent for one in chunk.steps}
    assert {address for address, wanted in needs if GL in wanted} == {"a"}
    assert {address for address, _ in needs} == {"a", "b", "c"}, "all of them measure by JAX"
    said = capsys.readouterr().err
    assert "steps that need the GL device, for workers with no GL 4.3 device and not llvmpipe" in said


def test_workers_of_other_versions_sources_or_processors_are_refused_by_name(capsys):
    others = {"a": {"versions": {"jax": "2"}}, "b": {"sources": "xyz"}, "c": {"processor": "slow"}}
    crew = FakeCrew({**others, "d": {}})
    assert list(crew.admission) == ["d"]
    said = capsys.readouterr().err.splitlines()
    assert said == [
        "normalbench: left out: worker a: it has jax 2 and not 1",
        "normalbench: left out: worker b: it has other sources of normalbench: xyz and not abc",
        "normalbench: left out: worker c: it has another processor: slow and not fast",
    ]


def test_of_steps_that_a_clock_is_read_for_a_machine_has_one_at_a_time():
    """Two machines with two workers each: four workers, never more than one timed step on a machine."""
    keys = [{"repeats": 3, "pipeline": f"p{n}"} for n in range(20)]
    hosts = {name: {"host": name[0]} for name in ("a1", "a2", "b1", "b2")}
    crew = FakeCrew(hosts)
    busy = []
    send = crew.send

    def watched(address, *words):
        busy.append([crew.admission.host(one) for one in (*crew.under_way, address)])
        send(address, *words)

    crew.send = watched
    _, found = measured(crew, asked("sweep", keys))
    assert len(found) == 20
    assert all(len(set(hosts)) == len(hosts) for hosts in busy), busy
    assert any(len(hosts) == 2 for hosts in busy), "both machines measure"


def test_every_table_whose_rows_have_times_says_so_in_its_keys():
    """By `repeats`, or whatever it is that the table goes by."""
    # Readers' times are in the files that they saved.
    timed = {name for name, table in TABLES.items() if table.of_role(Role.TIME)} - {"devices"}
    assert timed == {"cost", "render", "effects", "sweep", "maps"}
    assert all(TABLES[name].work.is_timed(Step({"repeats": 1}, None, "")) for name in timed)
    always = {name for name in timed if TABLES[name].work.is_timed(Step({}, None, ""))}
    assert always == {"maps"}, "its rows always have a time"


@pytest.mark.parametrize(
    ("waiting", "workers", "size"), [(0, 4, 1), (10, 4, 1), (100, 4, 6), (10**5, 4, MOST_TOGETHER)]
)
def test_chunks_shrink_towards_the_end(waiting, workers, size):
    assert chunk_size(waiting, workers) == size


def test_what_no_worker_can_read_ends_the_command():
    """It would come back again and again: an order that cannot be unpacked is no worker's fault."""
    crew = FakeCrew({"a": {}}, lambda _, names: TypeError("cannot be unpacked"))  # noqa: ARG005
    with pytest.raises(TypeError, match="cannot be unpacked"):
        measured(crew, asked("quality", JAX))


def test_lists_of_names_travel():
    """With the caller's own values, which a text would lose."""
    words = pickle.loads(pickle.dumps(Words(["octahedral", "mine"], {"mine": 1})))
    assert words == "octahedral,mine" and given_in(words) == {"mine": 1}


def test_an_answer_that_is_wrong_ends_the_command():
    from normalbench.bench.ground.output.errors import UsageError

    crew = FakeCrew({"a": {}}, lambda _, names: Answer(wrong=UsageError("no such thing")))  # noqa: ARG005
    with pytest.raises(UsageError, match="no such thing"):
        measured(crew, asked("quality", JAX))
