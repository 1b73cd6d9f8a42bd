"""Steps and workers that come and go, without any process: every step has its rows once, or a reason."""

import pickle
import random
from collections import Counter
from threading import Event

import pytest

from normalbench.bench.ground.options.words import Given
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.run.measuring import Asked
from normalbench.bench.run.workers import local, pool, tasks
from normalbench.bench.run.workers.about import BASE, marks, named
from normalbench.bench.run.workers.carrier import Answer
from normalbench.bench.run.workers.chunks import MOST_TOGETHER, chunk_size, tasks_of
from normalbench.bench.run.workers.local import MOST_LOST, LocalWorkers
from normalbench.bench.run.workers.orders import order_of, step_name
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import C_COMPILER, GL, VULKAN, Role, Step


def asked(table: str, keys: list[dict]) -> Asked:
    options = TABLES[table].options()
    return Asked(TABLES[table], options, TABLES[table].outputs(), [Step(key, None, str(key)) for key in keys])


JAX = [{"backend": "jax", "encoding": f"e{n}"} for n in range(200)]


def rows_of(names) -> Answer:
    return Answer([([{"of": name}], {}) for name in names])


def measures(order, needs, names) -> Answer:  # noqa: ARG001
    return rows_of(names)


class Process:
    """Stands for a process: `says` makes an answer of the arguments of a call, or ends it. The first `ending` of them
    end before they are ready."""

    says, ending = staticmethod(measures), 0

    def __init__(self, first, take):  # noqa: ARG002
        self.ended, self.status, self._take = Event(), None, take
        if type(self).ending:
            type(self).ending -= 1
            self.status = -9
        else:
            take(Answer())

    def call(self, _, *arguments):
        answer = type(self).says(*arguments)
        self.status = answer if isinstance(answer, int) else self.status
        if not isinstance(answer, int):
            self._take(answer)

    def end(self):
        pass

    def wait(self):
        return ["broken"]


@pytest.fixture
def workers(monkeypatch):
    """Four workers of this machine, without processes; how they answer."""
    monkeypatch.setattr(local, "Piped", Process)
    monkeypatch.setattr(local, "LOOK_S", 0.01)

    def answer(says):
        monkeypatch.setattr(Process, "says", staticmethod(says))
        return LocalWorkers(4)

    return answer


def measured(carrier, ask: Asked) -> tuple[list[str], list]:
    ticks: list[str] = []
    return ticks, list(pool.Pool(carrier).measure(ask, ask.steps, ticks.append))


def test_every_step_has_its_rows_once(workers):
    ask = asked("quality", JAX)
    ticks, found = measured(workers(measures), ask)
    assert Counter(step.name for step, _ in found) == Counter(step.name for step in ask.steps)
    assert sorted(ticks) == sorted(step.name for step in ask.steps)
    assert all(rows == [{"of": step_name("quality", step.key)}] for step, rows in found)


@pytest.mark.parametrize("seed", range(20))
def test_workers_that_are_lost_at_random_lose_nothing(seed, workers, monkeypatch):
    """A tenth of all tasks ends its worker by a signal, and a tenth reaches one that does not know the order."""
    rng = random.Random(seed)
    monkeypatch.setattr(local, "MOST_LOST", 1000)

    def says(order, needs, names):  # noqa: ARG001
        ends = rng.random()
        return -9 if ends < 0.1 else Answer(knows=False) if ends < 0.2 else rows_of(names)

    _, found = measured(workers(says), asked("quality", JAX))
    assert Counter(step.name for step, _ in found) == Counter(str(key) for key in JAX)
    assert all("of" in row for _, rows in found for row in rows)


@pytest.mark.parametrize("ending", [11, 12])
def test_workers_that_end_before_they_are_ready_cost_no_step(ending, workers, monkeypatch):
    """But where three for each that there should be do so one after the other, the command ends."""
    monkeypatch.setattr(Process, "ending", ending)
    carrier = workers(measures)
    if ending == 12:
        with pytest.raises(UsageError, match="--on local:4: the workers keep ending: broken"):
            measured(carrier, asked("quality", JAX))
        return
    _, found = measured(carrier, asked("quality", JAX))
    assert len(found) == len(JAX) and all("of" in row for _, rows in found for row in rows)


def test_the_order_travels_where_it_is_not_known(workers):
    sent: list[object] = []

    def says(order, needs, names):  # noqa: ARG001
        sent.append(order)
        return Answer(knows=False) if isinstance(order, str) else rows_of(names)

    measured(workers(says), asked("quality", JAX[:2]))
    assert [isinstance(order, str) for order in sent] == [True, True, False, False]


def test_a_step_that_ends_worker_after_worker_loses_its_own_rows(workers, capsys):
    """The others that travelled with it are measured; its row has the reason, and standard error its name."""
    bad = JAX[5]
    name = step_name("quality", bad)
    carrier = workers(lambda order, needs, names: -9 if name in names else rows_of(names))  # noqa: ARG005
    _, found = measured(carrier, asked("quality", JAX))
    rows = {step.name: rows for step, rows in found}
    (lost,) = rows[str(bad)]
    assert lost["skipped"] == f"{MOST_LOST + 1} workers were lost while they measured it"
    assert lost["encoding"] == "e5" and lost["backend"] == "jax" and lost["mse"] is None
    assert sum("of" in row for one in rows.values() for row in one) == len(JAX) - 1
    assert f"{bad}: {MOST_LOST + 1} workers were lost" in capsys.readouterr().err


@pytest.mark.parametrize("wrong", [UsageError("no such thing"), TypeError("cannot be unpacked")])
def test_an_answer_that_is_wrong_ends_the_command(wrong, workers):
    with pytest.raises(type(wrong), match=str(wrong)):
        measured(workers(lambda order, needs, names: wrong), asked("quality", JAX))  # noqa: ARG005


def test_an_order_is_another_one_where_a_users_file_is(monkeypatch, tmp_path):
    """A worker that has the first would measure it again for the second, of the same name."""
    monkeypatch.chdir(tmp_path)
    table, ids = TABLES["quality"], []
    for text in ("// first", "// second", "// first"):
        (tmp_path / "mine.glsl").write_text(text)
        ids.append(order_of(Asked(table, table.options(encoding="mine.glsl"), table.outputs(), [])).id)
    assert ids[0] == ids[2] != ids[1]


def test_steps_before_one_that_raises_are_kept(workers, monkeypatch, tmp_path):
    """By the worker's process, and by this one."""
    ask = asked("quality", JAX[:2])

    def measure(_, steps, tick):  # noqa: ARG001
        yield steps[0], [{"a": 1}]
        raise UsageError("the device is lost")

    monkeypatch.setattr(tasks.HERE, "measure", measure)
    order, names = order_of(ask), [step_name("quality", step.key) for step in ask.steps]
    laid = tasks.Laid(order, tmp_path, ask, dict(zip(names, ask.steps, strict=True)))
    (tmp_path / "typed").mkdir()
    monkeypatch.setattr(tasks, "_laid_down", lambda _: laid)
    answer = tasks.measure(order, frozenset(), names)
    assert [rows for rows, _ in answer.steps] == [[{"a": 1}]] and str(answer.error) == "the device is lost"
    kept = []
    with pytest.raises(UsageError, match="the device is lost"):
        for _, rows in pool.Pool(workers(lambda *_: answer)).measure(ask, ask.steps, lambda _: None):
            kept.append(rows)
    assert kept == [[{"a": 1}]]


def test_a_worker_measures_only_what_it_would_measure_as_this_process(monkeypatch):
    """Of other versions, sources, settings or processors nothing; of steps by GLSL nothing with another device."""
    ask = asked("quality", [{"backend": name} for name in ("glsl", "jax")])
    by_glsl, by_jax = tasks_of(ask, ask.steps, 1)
    assert named(by_glsl.needs) == f"{GL}, {VULKAN}, {BASE}" and named(by_jax.needs) == f"{C_COMPILER}, {BASE}"
    for other in (BASE, GL, VULKAN, C_COMPILER):
        refused = {other} if other == BASE else {other, ""}
        own = dict(marks()) | {other: f"{other} of another machine"}
        monkeypatch.setattr(tasks, "marks", lambda own=own: own)
        answers = [tasks.measure(*task.arguments()).refused for task in (by_glsl, by_jax)]
        assert {answer.removeprefix("no worker has this ") for answer in answers} == refused, answers


def test_what_workers_refuse_and_what_reads_a_clock_is_measured_here(workers, monkeypatch, capsys):
    """In the end, in one go; workers are not asked for what reads a clock."""
    here: list[str] = []

    def measure(ask, steps, tick):  # noqa: ARG001
        here.extend(step.name for step in steps)
        yield from ((step, []) for step in steps)

    monkeypatch.setattr(pool.HERE, "measure", measure)
    keys = [{"repeats": n % 2, "pipeline": f"p{n}"} for n in range(10)]
    carrier = workers(lambda order, needs, names: Answer(refused="no worker has this GL device"))  # noqa: ARG005
    _, found = measured(carrier, asked("sweep", keys))
    assert len(found) == 10 and here == [str(key) for key in (*keys[1::2], *keys[::2])]
    assert "sweep: 5 steps are measured by this process: no worker has this GL device" in capsys.readouterr().err


def test_without_a_worker_for_long_this_process_measures(monkeypatch, capsys):
    """As where no worker of a scheduler has the GL device."""

    class Nobody:
        def count(self, needs):  # noqa: ARG002
            return 0

        room = count

        def arrivals(self):
            return []

    monkeypatch.setattr(pool, "WAIT_S", 0.0)
    monkeypatch.setattr(pool.HERE, "measure", lambda ask, steps, tick: ((step, []) for step in steps))  # noqa: ARG005
    _, found = measured(Nobody(), asked("quality", JAX))
    assert len(found) == len(JAX)
    assert (
        f"quality: {len(JAX)} steps are measured by this process: no worker has all of this: {C_COMPILER}, {BASE}"
        in capsys.readouterr().err
    )


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


def test_lists_of_names_travel():
    """With the caller's own values, which a text would lose."""
    words = ("octahedral", Given("mine", 1))
    assert pickle.loads(pickle.dumps(words)) == words
