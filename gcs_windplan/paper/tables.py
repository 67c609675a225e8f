"""Tables of text, for the terminal and for Markdown alike."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Table:
    """A title, a header, rows as long as the header, and what is to be said about them.

    The first `words` columns hold words and are set to the left, the others numbers to the right.
    """

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    words: int = 1

    def markdown(self) -> str:
        """The table in Markdown."""
        rule = "|" + "---|" * self.words + "---:|" * (len(self.header) - self.words)
        lines = [_row(self.header), rule, *map(_row, self.rows)]
        return f"**{self.title}**\n\n" + "\n".join(lines) + (f"\n\n{self.note}" if self.note else "") + "\n"


def _row(cells: tuple[str, ...]) -> str:
    return "| " + " | ".join(cells) + " |"


def in_seconds(value: float | None) -> str:
    """A time [s] with the paper's two decimals; a dash for none."""
    return "–" if value is None else f"{value:.2f}"
