"""A file of gates as tests, one for each gate."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ....reports.tables import visible
from ...ground.output.errors import UsageError
from ..gates.gates import Gate, read_gates
from .session import Normalbench, session_of


class GateFile(pytest.File):
    """A TOML file that was named on the command line."""

    def collect(self) -> Iterator[GateItem]:
        try:
            gates = read_gates(self.path)
        except UsageError as error:
            raise self.CollectError(visible(str(error))) from error
        for number, gate in enumerate(gates, 1):
            yield GateItem.from_parent(self, name=f"gate {number}", gate=gate)


class GateItem(pytest.Item):
    """One gate. Files that it names are looked for next to the file of gates, as `normalbench check` does."""

    def __init__(self, *, gate: Gate, **others: Any):
        super().__init__(**others)
        self.gate = gate

    def runtest(self) -> None:
        bench = Normalbench(session_of(self.config), self.gate.folder)
        said: list[str] = []
        for holds in (self._limits, self._baseline):
            try:
                self.gate.located()
                holds(bench)
            except AssertionError as error:
                said.append(str(error))
            except UsageError as error:
                raise UsageError(f"{self.gate.place}: {error}") from None
        if said:
            raise AssertionError("\n".join(said))

    def _limits(self, bench: Normalbench) -> None:
        if self.gate.limits:
            bench.hold(self.gate.table, self.gate.options, self.gate.limits)

    def _baseline(self, bench: Normalbench) -> None:
        if self.gate.baseline:
            bench.matches(self.gate.table, self.gate.options, self.gate.baseline)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        if isinstance(excinfo.value, AssertionError | UsageError):
            return visible(str(excinfo.value))
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, None, f"{self.path.name}: {self.name}"
