"""In which line of a TOML file each key stands, which the parser of the standard library does not tell."""

import re
from bisect import bisect_right
from collections.abc import Callable

PATH = re.compile(r"[\w-]+(?:\[\d+\])*(?:\.[\w-]+(?:\[\d+\])*)*")
DEEPER = re.compile(r": ([\w-]+(?:\[\d+\])*)(?=[:= ])")
BARE = re.compile(r"[\w-]+")
BLANK = re.compile(r"(?:\s|#[^\n]*)*")
SCALAR = re.compile(r"[^,\]}\n#]*")
STRINGS = (  # how they begin, and what they are
    ('"""', re.compile(r'"""(?:\\.|[^\\])*?"{3,5}', re.DOTALL)),
    ("'''", re.compile(r"'''.*?'{3,5}", re.DOTALL)),
    ('"', re.compile(r'"(?:\\.|[^"\\])*"')),
    ("'", re.compile(r"'[^']*'")),
)


def lines_of(text: str) -> dict[str, int]:
    r"""Return the lines, from 1 on, of all keys and tables of a valid TOML text, by paths such as ``bodies[0].mass``.

    Examples
    --------
    >>> from binaryast.toml_lines import lines_of
    >>> lines_of('a = 1\n[[b]]\nc = { d = 2 }\n')
    {'a': 1, 'b': 2, 'b[0]': 2, 'b[0].c': 3, 'b[0].c.d': 3}
    """
    return _Scanner(text.replace("\r\n", "\n")).document()


def line_of(message: str, lines: dict[str, int]) -> int | None:
    """Return the line that a message speaks of, which begins with a path; that of its table where a key is missing."""
    found = PATH.match(message)
    if found is None:
        return None
    path, rest = found.group(), message[found.end() :]
    while (more := DEEPER.match(rest)) and f"{path}.{more.group(1)}" in lines:
        path, rest = f"{path}.{more.group(1)}", rest[more.end() :]
    while path and path not in lines:
        path = path[: max(path.rfind("."), path.rfind("["), 0)]
    return lines.get(path)


class _Scanner:
    """Goes through a text that is known to be valid, and notes where keys begin."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        self.ends = [i for i, letter in enumerate(text) if letter == "\n"]
        self.lines: dict[str, int] = {}
        self.last: dict[str, int] = {}  # of each array of tables, the index of the last

    def document(self) -> dict[str, int]:
        """Return the lines of the whole text."""
        table = ""
        self._blank()
        while self.at < len(self.text):
            if self.text[self.at] == "[":
                table = self._header()
            else:
                self._pair(table)
            self._blank()
        return self.lines

    def _blank(self) -> None:
        """Go on to what is neither white nor a comment."""
        self._over(BLANK)

    def _over(self, pattern: re.Pattern[str]) -> str:
        """Go past what matches a pattern here, and return it."""
        found = pattern.match(self.text, self.at)
        if found is None:  # not TOML, as this understands it: the rest has no lines
            self.at = len(self.text)
            return ""
        self.at = found.end()
        return found.group()

    def _note(self, path: str, begin: int) -> None:
        self.lines.setdefault(path, bisect_right(self.ends, begin - 1) + 1)

    def _header(self) -> str:
        """Take the header of a table, or of one of several; return its path."""
        begin, several = self.at, self.text.startswith("[[", self.at)
        self.at += 1 + several
        path = ""
        parts = self._keys()
        for i, part in enumerate(parts):
            path = f"{path}.{part}" if path else part
            self._note(path, begin)
            if several and i == len(parts) - 1:
                self.last[path] = self.last.get(path, -1) + 1
            if path in self.last:
                path = f"{path}[{self.last[path]}]"
                self._note(path, begin)
        self.at += 1 + several
        return path

    def _keys(self) -> list[str]:
        """Take a key, which may have several parts."""
        parts = []
        while self.at < len(self.text):
            self._blank()
            quoted = self.text[self.at : self.at + 1] in ('"', "'")
            parts.append(self._string()[1:-1] if quoted else self._over(BARE))
            self._blank()
            if self.text[self.at : self.at + 1] != ".":
                break
            self.at += 1
        return parts

    def _string(self) -> str:
        """Take a string, whatever its quotes are."""
        return next(self._over(kind) for quotes, kind in STRINGS if self.text.startswith(quotes, self.at))

    def _pair(self, table: str) -> None:
        """Take a key and its value."""
        begin, path = self.at, table
        for part in self._keys():
            path = f"{path}.{part}" if path else part
            self._note(path, begin)
        self.at += 1
        self._blank()
        self._value(path)

    def _value(self, path: str) -> None:
        """Take a value, with the keys inside it."""
        first = self.text[self.at : self.at + 1]
        if first == "[":
            self._items("]", lambda i: self._value(f"{path}[{i}]"), path)
        elif first == "{":
            self._items("}", lambda _: self._pair(path), None)
        elif first in ('"', "'"):
            self._string()
        else:
            self._over(SCALAR)

    def _items(self, closing: str, take: Callable[[int], None], path: str | None) -> None:
        """Take what stands between brackets, separated by commas."""
        self.at += 1
        index = 0
        self._blank()
        while self.at < len(self.text) and self.text[self.at] != closing:
            if path is not None:
                self._note(f"{path}[{index}]", self.at)
            take(index)
            self._blank()
            if self.text[self.at : self.at + 1] == ",":
                self.at += 1
            elif self.text[self.at : self.at + 1] != closing:
                self.at = len(self.text)
            self._blank()
            index += 1
        self.at += 1
