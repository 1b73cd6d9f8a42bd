"""Steps and workers that come and go, without any processes: every step has its rows once, or a reason."""

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
    """A stand-in for a process. `says` returns the answer to a call, or an exit status that ends the process. The
    first `ending` processes end before they are ready."""

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
    """A function that returns four local workers without processes, given how they answer."""
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
    ticks, pairs = measured(workers(measures), ask)
    assert Counter(step.name for step, _ in pairs) == Counter(step.name for step in ask.steps)
    assert sorted(ticks) == sorted(step.name for step in ask.steps)
    assert all(rows == [{"of": step_name("quality", step.key)}] for step, rows in pairs)


@pytest.mark.parametrize("seed", range(20))
def test_randomly_lost_workers_lose_no_rows(seed, workers, monkeypatch):
    """A tenth of all tasks kill their worker, and another tenth reach a worker that does not know the order."""
    rng = random.Random(seed)
    monkeypatch.setattr(local, "MOST_LOST", 1000)

    def says(order, needs, names):  # noqa: ARG001
        ends = rng.random()
        return -9 if ends < 0.1 else Answer(knows=False) if ends < 0.2 else rows_of(names)

    _, pairs = measured(workers(says), asked("quality", JAX))
    assert Counter(step.name for step, _ in pairs) == Counter(str(key) for key in JAX)
    assert all("of" in row for _, rows in pairs for row in rows)


@pytest.mark.parametrize("ending", [11, 12])
def test_workers_that_exit_before_they_are_ready_lose_no_steps(ending, workers, monkeypatch):
    """After 12 such workers in a row, three per worker requested, the command ends."""
    monkeypatch.setattr(Process, "ending", ending)
    carrier = workers(measures)
    if ending == 12:
        with pytest.raises(UsageError, match="--on local:4: the workers keep exiting: broken"):
            measured(carrier, asked("quality", JAX))
        return
    _, pairs = measured(carrier, asked("quality", JAX))
    assert len(pairs) == len(JAX) and all("of" in row for _, rows in pairs for row in rows)


def test_order_is_sent_to_workers_that_do_not_know_it(workers):
    sent: list[object] = []

    def says(order, needs, names):  # noqa: ARG001
        sent.append(order)
        return Answer(knows=False) if isinstance(order, str) else rows_of(names)

    measured(workers(says), asked("quality", JAX[:2]))
    assert [isinstance(order, str) for order in sent] == [True, True, False, False]


def test_a_step_that_repeatedly_ends_workers_loses_only_its_own_rows(workers, capsys):
    """Other steps sent with the lost step are measured. The lost step has a row with the reason, which is also
    printed to standard error with the name of the step."""
    bad = JAX[5]
    name = step_name("quality", bad)
    carrier = workers(lambda order, needs, names: -9 if name in names else rows_of(names))  # noqa: ARG005
    _, pairs = measured(carrier, asked("quality", JAX))
    rows = {step.name: rows for step, rows in pairs}
    (lost,) = rows[str(bad)]
    assert lost["skipped"] == f"{MOST_LOST + 1} workers were lost while measuring this row"
    assert lost["encoding"] == "e5" and lost["backend"] == "jax" and lost["mse"] is None
    assert sum("of" in row for step_rows in rows.values() for row in step_rows) == len(JAX) - 1
    assert f"{bad}: {MOST_LOST + 1} workers were lost" in capsys.readouterr().err


@pytest.mark.parametrize("wrong", [UsageError("no such thing"), TypeError("cannot be unpacked")])
def test_an_error_as_the_answer_ends_the_command(wrong, workers):
    with pytest.raises(type(wrong), match=str(wrong)):
        measured(workers(lambda order, needs, names: wrong), asked("quality", JAX))  # noqa: ARG005


def test_order_changes_with_the_text_of_a_users_file(monkeypatch, tmp_path):
    """Otherwise a worker that knows the first file would measure it again in place of the second."""
    monkeypatch.chdir(tmp_path)
    table, ids = TABLES["quality"], []
    for text in ("// first", "// second", "// first"):
        (tmp_path / "mine.glsl").write_text(text)
        ids.append(order_of(Asked(table, table.options(encoding="mine.glsl"), table.outputs(), [])).id)
    assert ids[0] == ids[2] != ids[1]


def test_steps_before_a_failing_step_are_kept(workers, monkeypatch, tmp_path):
    """Both the worker's process and this process keep the rows."""
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


def test_worker_refuses_steps_that_it_would_measure_differently(monkeypatch):
    """Another version, source, setting or processor rules out all steps; another device rules out GLSL steps."""
    ask = asked("quality", [{"backend": name} for name in ("glsl", "jax")])
    by_glsl, by_jax = tasks_of(ask, ask.steps, 1)
    assert named(by_glsl.needs) == f"{GL}, {VULKAN}, {BASE}" and named(by_jax.needs) == f"{C_COMPILER}, {BASE}"
    for other in (BASE, GL, VULKAN, C_COMPILER):
        refused = {other} if other == BASE else {other, ""}
        own = dict(marks()) | {other: f"{other} of another machine"}
        monkeypatch.setattr(tasks, "marks", lambda own=own: own)
        answers = [tasks.measure(*task.arguments()).refused for task in (by_glsl, by_jax)]
        assert {answer.removeprefix("no worker has the same ") for answer in answers} == refused, answers


def test_refused_and_timed_steps_are_measured_locally(workers, monkeypatch, capsys):
    """The steps are measured at the end, in one go; timed steps are never sent to workers."""
    here: list[str] = []

    def measure(ask, steps, tick):  # noqa: ARG001
        here.extend(step.name for step in steps)
        yield from ((step, []) for step in steps)

    monkeypatch.setattr(pool.HERE, "measure", measure)
    keys = [{"repeats": n % 2, "pipeline": f"p{n}"} for n in range(10)]
    carrier = workers(lambda order, needs, names: Answer(refused="no worker has the same GL device"))  # noqa: ARG005
    _, pairs = measured(carrier, asked("sweep", keys))
    assert len(pairs) == 10 and here == [str(key) for key in (*keys[1::2], *keys[::2])]
    assert "sweep: 5 steps are measured by this process: no worker has the same GL device" in capsys.readouterr().err


def test_steps_are_measured_locally_if_no_worker_is_available(monkeypatch, capsys):
    """This happens, for example, if no worker of a scheduler has the OpenGL device."""

    class Nobody:
        def count(self, needs):  # noqa: ARG002
            return 0

        room = count

        def arrivals(self):
            return []

    monkeypatch.setattr(pool, "WAIT_S", 0.0)
    monkeypatch.setattr(pool.HERE, "measure", lambda ask, steps, tick: ((step, []) for step in steps))  # noqa: ARG005
    _, pairs = measured(Nobody(), asked("quality", JAX))
    assert len(pairs) == len(JAX)
    assert (
        f"quality: {len(JAX)} steps are measured by this process: no worker has all of these: {C_COMPILER}, {BASE}"
        in capsys.readouterr().err
    )


def test_every_table_whose_rows_have_times_declares_them_in_its_keys():
    """Most tables have the key `repeats`; the rows of `maps` always have a time."""
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


def test_lists_of_names_can_be_pickled():
    """Lists keep the caller's own values, which text would lose."""
    words = ("octahedral", Given("mine", 1))
    assert pickle.loads(pickle.dumps(words)) == words
