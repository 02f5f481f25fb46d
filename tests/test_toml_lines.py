"""In which line of a TOML file a key stands."""

import tomllib
from collections.abc import Iterator
from typing import Any

import pytest

import binaryast as ba
from binaryast.toml_lines import line_of, lines_of

ALL_OF_IT = """# a comment [with] brackets = 1
x = \"\"\"a
[b] = "c\\\"\"\"\"  # a comment
"quoted.key" = 1
dotted . key = [
  1, # [
  { c = 2, d = [3] },
  '''
  ]''',
]
[t]
when = 1979-05-27T07:32:00Z
[[t.several]]
w = '#'
[[t.several]]
w = 1
"""


def paths_of(value: Any, path: str = "") -> Iterator[str]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield (name := f"{path}.{key}" if path else key)
            yield from paths_of(inner, name)
    if isinstance(value, list):
        for i, inner in enumerate(value):
            yield f"{path}[{i}]"
            yield from paths_of(inner, f"{path}[{i}]")


@pytest.mark.parametrize("text", [ALL_OF_IT, *(ba.catalogue.text(name) for name in ba.catalogue.names())])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_every_key_has_a_line(text: str, end: str) -> None:
    found = lines_of(text.replace("\n", end))
    assert sorted(found) == sorted(paths_of(tomllib.loads(text)))
    lines = text.split("\n")
    for path, line in found.items():
        if not path.endswith("]"):
            assert path.rpartition(".")[2] in lines[line - 1]


def test_the_lines_themselves() -> None:
    found = lines_of(ALL_OF_IT)
    chosen = ("x", "quoted.key", "dotted.key[1].d", "t", "t.when", "t.several[0].w", "t.several[1]", "t.several[1].w")
    assert [found[path] for path in chosen] == [2, 4, 7, 11, 12, 14, 15, 16]


@pytest.mark.parametrize(
    ("message", "line"),
    [
        ("t.when: expected something", 12),
        ("t.what is missing", 11),
        ("t.several[1].w: is not 2", 16),
        ("t.several[1]: w: is not 2", 16),
        ("t.several[1]: w=1 has no unit", 16),
        ("t.several[7].w: is not there", 13),
        ("somebody: is unknown", None),
        ("", None),
    ],
)
def test_the_line_of_a_message(message: str, line: int | None) -> None:
    assert line_of(message, lines_of(ALL_OF_IT)) == line
