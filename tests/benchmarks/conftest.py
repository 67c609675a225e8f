"""Tables that the benchmarks fill, printed when all have run and written to out/benchmarks.md."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

REPORT = Path("out/benchmarks.md")
_tables: dict[str, Table] = {}


class Table:
    """Rows of text under a heading, in the order in which they came."""

    def __init__(self, heading: str) -> None:
        self.heading, self.columns, self.rows, self.note = heading, (), [], ""

    def row(self, **cells: object) -> None:
        """Add a row; the keywords name the columns (an underscore stands for a space)."""
        self.columns = self.columns or tuple(name.replace("_", " ") for name in cells)
        self.rows.append([str(cell) for cell in cells.values()])

    def __str__(self) -> str:
        grid = [list(self.columns), *self.rows]
        widths = [max(len(row[i]) for row in grid) for i in range(len(self.columns))]
        lines = ["| " + " | ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)) + " |" for row in grid]
        lines.insert(1, "|" + "|".join("-" * (w + 2) for w in widths) + "|")
        return "\n".join([f"## {self.heading}", "", *lines, *(["", self.note] if self.note else []), ""])


@pytest.fixture
def table():
    """Tables by heading: the same heading gives the same table."""
    return lambda heading: _tables.setdefault(heading, Table(heading))


def pytest_terminal_summary(terminalreporter) -> None:
    if not _tables:
        return
    text = "\n".join(str(table) for table in _tables.values())
    REPORT.parent.mkdir(exist_ok=True)
    REPORT.write_text(f"# Benchmarks\n\nPython {platform.python_version()}, {platform.machine()}\n\n{text}")
    terminalreporter.write_line("")
    terminalreporter.write_line(text)
    terminalreporter.write_line(f"wrote {REPORT}")
