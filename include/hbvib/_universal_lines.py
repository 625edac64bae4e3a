"""Lines, bytes and numbers of universal files (UFF), with sentences that name file, line and reason."""
from __future__ import annotations

import math
import os
import re
from typing import TYPE_CHECKING, Any, NoReturn, Optional

if TYPE_CHECKING:
    from collections.abc import Iterator

#: The mark before and after a data set, which ends in the sixth column.
_MARK = re.compile(r" {0,4}-1\s*")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")
#: A sign that does not follow the letter of an exponent begins a number: those of fixed width may touch each other.
_TOUCHING = re.compile(r"(?<=[0-9.])(?=[-+])")


class UniversalLines:
    """A file and the line that is reached."""

    def __init__(self, path: Any) -> None:
        self.path = os.fspath(path)
        with open(self.path, "rb") as file:
            self.data = file.read()
        self.at = self.number = 0

    def fail(self, reason: str) -> NoReturn:
        """Raises a ReadError at the present line."""
        from .io import ReadError  # which imports this file

        raise ReadError(f"{self.path}: line {self.number}: universal file: {reason}")

    def next(self) -> Optional[str]:
        """The next line, None at the end of the file."""
        if self.at >= len(self.data):
            return None
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        line = self.data[self.at:end].decode("latin-1").rstrip("\r")
        self.at, self.number = end + 1, self.number + 1
        return line

    def item(self) -> Optional[str]:
        """The next line of a data set, None at its mark."""
        line = self.next()
        if line is None:
            self.fail("the file ends within a data set, needs a line with -1")
        return None if _MARK.fullmatch(line) else line

    def expect(self, needed: str) -> str:
        """The next line, which must be in the data set."""
        line = self.item()
        if line is None:
            self.fail(f"the data set ends where {needed} is needed")
        return line

    def end(self, told: str) -> None:
        """Moves behind the end of the data set, before which nothing may follow."""
        while True:
            line = self.item()
            if line is None:
                return
            if line.strip():
                self.fail(f"more follows than {told}")

    def pass_over(self) -> None:
        """Moves behind the end of the data set."""
        while self.item() is not None:
            pass

    def data_sets(self) -> Iterator[tuple[int, str]]:
        """Number and first line of each data set, which must be read to its mark. Binary ones, with a letter b, are those of 58 alone."""
        found = False
        while True:
            line = self.next()
            if line is None:
                break
            if not line.strip():
                continue
            if not _MARK.fullmatch(line):
                self.fail("needs a line with -1 before each data set")
            head = self.next()
            # Some programs end a file with a mark too many.
            if head is None:
                break
            if not head.strip():
                continue
            found = True
            word = head.split()[0]
            if not re.fullmatch(r"\d+[bB]?", word):
                self.fail(f"{word!r} needs to be the number of a data set")
            if word[-1] in "bB" and word[:-1] != "58":
                self.fail(f"data set {word[:-1]} is binary, which only 58 is read as: write it as text")
            yield int(word.rstrip("bB")), head
        if not found:
            self.fail("holds no data set")

    def whole(self, text: str, what: str) -> int:
        """A whole number of the present line."""
        if not re.fullmatch(r"[-+]?\d+", text.strip(), re.ASCII):
            self.fail(f"{what}: {text.strip()!r} needs to be a whole number")
        return int(text)

    def wholes(self, line: str, what: str) -> list[int]:
        """The whole numbers of the present line."""
        return [self.whole(word, what) for word in line.split()]

    def real(self, word: str) -> float:
        """A number of the present line."""
        value = float(re.sub("[dD]", "e", word)) if _NUMBER.fullmatch(word) else math.nan
        if not math.isfinite(value):
            self.fail(f"{word!r} needs to be a finite number")
        return value

    def reals(self, count: int, what: str) -> list[float]:
        """So many numbers, on as many lines as they need."""
        found: list[float] = []
        while len(found) < count:
            line = self.item()
            if line is None:
                self.fail(f"the data set ends after {len(found)} {what}, needs {count}")
            found += [self.real(word) for word in _TOUCHING.sub(" ", line).split()]
        if len(found) > count:
            self.fail(f"more numbers follow than the {count} {what}")
        return found

    def mark_follows(self, count: int) -> bool:
        """Whether the end of a data set follows so many bytes."""
        rest = self.data[self.at + count:self.at + count + 16].lstrip()
        return self.at + count < len(self.data) and re.match(rb"-1(?:\s|$)", rest) is not None

    def take(self, count: int) -> bytes:
        """So many bytes, and moves to the line after them."""
        found = self.data[self.at:self.at + count]
        self.at += count
        rest = self.data[self.at:self.at + 2]
        self.at += 2 if rest == b"\r\n" else 1 if rest[:1] == b"\n" else 0
        return found
