"""Steps that draw one frame each: rows and pictures."""

from threading import Event

from normalbench.bench.tables.shots import Shot, by_shots
from normalbench.bench.tables.table import Step


class Cases:
    """Cases that measure numbers and signal when the last case is measured."""

    def __init__(self, count: int):
        self.count, self.all_measured = count, Event()

    def measure(self, case: int):
        if case == self.count - 1:
            self.all_measured.set()
        return {"case": case}, f"frame {case}"

    def reference(self, _: int) -> str:
        return "exact"


def test_pictures_are_written_before_their_row_while_the_next_is_drawn(tmp_path):
    """Once a row is stored, its pictures are never drawn again."""
    cases, written = Cases(2), []

    def write(folder, row, drawn, reference):
        assert cases.all_measured.wait(30), "nothing is measured while pictures are written"
        written.append((folder, row["case"], drawn, reference))

    steps = [Step({"case": case}, Shot(cases, case, tmp_path), str(case)) for case in range(2)]
    ticks = []
    for (row,) in by_shots(write)(steps, ticks.append):
        assert written[-1] == (tmp_path, row["case"], f"frame {row['case']}", "exact")
    assert len(written) == 2 and ticks == ["0", "1"]
