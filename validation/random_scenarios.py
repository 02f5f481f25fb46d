"""Scenario files at random: sound ones with keys, values, units and shapes changed, through the command line.

Each must end in a run or in one line that says what is wrong: no traceback, no hang, no number that is none in a file.
"""

import io
import json
import os
import re
import signal
import tempfile
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random

import h5py
import numpy as np

from binaryast import catalogue, cli

PATIENCE = 3.0  # s, after which a run is stopped by Ctrl-C, as a user would a long one
HANGS = 60.0  # s: what goes on in spite of that
NUMBERS = ("0", "-1", "1e-300", "1e300", "nan", "inf", "1e20", "-0.0", "3", "0.5", "1e-12", "1_000")
UNITS = ("m", "km", "kg", "s", "h", "d", "rad", "deg", "m / s", "kg / m3", "parsec", "Jy", "", "°", "m m m", "degC")
VALUES = (
    *("true", "false", "[]", "{}", "[[]]", '""', "1", "-1.5", "1979-05-27", "inf", "nan", '"none"', '"synchronous"'),
    *('"[1, 2] m"', '"[[1, 2, 3]] m"', "[1, 2, 3]", '["1 h", "2 h"]', '{ type = "Sphere", radius = "1 km" }', "1e400"),
    *('"LGVI"', '{ type = "Splitting" }', '{ type = "RungeKutta" }', '{ type = "KeplerSplitting" }', '"\\u0000"'),
)
PLAIN = """
[[bodies]]
name = "A"
shape = { type = "Ellipsoid", a = "400 m", b = "390 m", c = "300 m" }
density = "2000 kg / m3"

[[bodies]]
name = "B"
shape = { type = "Sphere", radius = "60 m" }
mass = "2e9 kg"

[gravity]
type = "SecondDegree"

[state]
type = "circular_orbit"
separation = "1.2 km"
spins = ["3 h", "synchronous"]

[run]
duration = "6 h"
step = "60 s"
save_every = "10 min"

[[impulses]]
type = "Impulse"
time = "1 h"
body = "B"
delta_v = "[0, -2.6, 0] mm / s"
"""


OUTSIDE = """
[[perturbations]]
type = "Sun"
orbit = { semi_major_axis = "1.64 AU", eccentricity = 0.38, mean_anomaly = "232 deg" }

[[perturbations]]
type = "Flyby"
gm = "398600 km3 / s2"
distance = "30000 km"
speed = "8 km / s"
time = "3 h"

[[perturbations]]
type = "TidalTorque"
body = "A"
raised_by = "B"
love_number = 0.1
quality_factor = 20

[[perturbations]]
type = "Yorp"
body = "B"
torque = "1 N m"

[[events]]
type = "Crossing"
quantity = "radial_velocity"
bodies = ["A", "B"]

[[events]]
type = "PlaneCrossing"
normal = [1, 0, 0]
accuracy = "1 ms"
interval = "10 min"

[[events]]
type = "Separation"
distance = "1.25 km"
direction = 1
terminal = true

[[events]]
type = "Escape"
distance = "20 km"

[[events]]
type = "Contact"
terminal = false
"""


def seeds() -> list[str]:
    """Return sound files to begin with, whose runs are short."""
    texts = [PLAIN, PLAIN.replace('step = "60 s"', "accuracy = 1e-6")]
    texts += [PLAIN + OUTSIDE, PLAIN.replace('step = "60 s"', "accuracy = 1e-6") + OUTSIDE]
    for name in ("didymos", "dumbbells", "sn263", "cubesat"):
        lines = catalogue.text(name).splitlines()
        short = '"1 s"' if name == "dumbbells" else '"3 h"'
        texts.append("\n".join(f"duration = {short}" if line.startswith("duration") else line for line in lines))
    return texts


def scenario(random: Random, texts: list[str]) -> str:
    """Return a file at random: one to four changes of a sound one."""
    text = random.choice(texts)
    for _ in range(random.choice((1, 1, 2, 4))):
        text = random.choice(CHANGES)(random, text)
    return text


def _line(random: Random, text: str) -> tuple[list[str], int]:
    lines = text.split("\n")
    with_keys = [i for i, line in enumerate(lines) if "=" in line] or [0]
    return lines, random.choice(with_keys)


def _value(random: Random, text: str) -> str:
    lines, i = _line(random, text)
    lines[i] = f"{lines[i].partition('=')[0]}= {random.choice(VALUES)}"
    return "\n".join(lines)


def _key(random: Random, text: str) -> str:
    lines, i = _line(random, text)
    key, _, value = lines[i].partition("=")
    at = random.randrange(len(key) or 1)
    lines[i] = f"{key[:at]}{random.choice(['', 'x', '_', '.', '-'])}{key[at + 1 :]}={value}"
    return "\n".join(lines)


def _gone(random: Random, text: str) -> str:
    lines = text.split("\n")
    del lines[random.randrange(len(lines))]
    return "\n".join(lines)


def _twice(random: Random, text: str) -> str:
    lines = text.split("\n")
    i = random.randrange(len(lines))
    return "\n".join([*lines[:i], lines[i], *lines[i:]])


def _exchanged(random: Random, text: str) -> str:
    (lines, i), (_, j) = _line(random, text), _line(random, text)
    one, other = lines[i].partition("="), lines[j].partition("=")
    lines[i], lines[j] = "".join([*one[:2], other[2]]), "".join([*other[:2], one[2]])
    return "\n".join(lines)


def _numbers(text: str) -> list[tuple[int, int]]:
    return [found.span() for found in re.finditer(r"(?<![\w.])-?\d[\d.e+-]*", text)] or [(0, 0)]


def _number(random: Random, text: str) -> str:
    begin, end = random.choice(_numbers(text))
    return text[:begin] + random.choice(NUMBERS) + text[end:]


def _unit(random: Random, text: str) -> str:
    _, end = random.choice(_numbers(text))
    quote = text.find('"', end)
    return text if quote < 0 else f"{text[:end]} {random.choice(UNITS)}{text[quote:]}"


def _letter(random: Random, text: str) -> str:
    at = random.randrange(len(text) or 1)
    return text[:at] + random.choice('"[]{}=#.\n\\x0é\t,') + text[at + 1 :]


CHANGES = (_value, _value, _key, _gone, _twice, _exchanged, _number, _number, _unit, _letter)


def trouble(text: str, folder: Path) -> str:
    """Return what is wrong with how the command line takes a file, nothing where it is as it should be."""
    path, output = folder / "random.toml", folder / "random.h5"
    path.write_text(text, encoding="utf-8")
    out, err = io.StringIO(), io.StringIO()
    arguments = ["run", str(path), "-o", str(output), "--no-picture", "--force", "--json"]
    try:
        with redirect_stdout(out), redirect_stderr(err), _patience(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            status = cli.main(arguments)
    except BaseException as error:  # that is what is looked for
        return f"{type(error).__name__}: {error}"
    said = [line for line in err.getvalue().splitlines() if line.startswith("binaryast: error: ")]
    if "Traceback" in err.getvalue():
        return "a traceback"
    if status in (cli.FAILED, cli.WRONG_INPUT) and len(said) != 1:
        return f"status {status}, and {len(said)} lines of errors"
    if status not in (0, cli.FAILED, cli.WRONG_INPUT, cli.INTERRUPTED):
        return f"status {status}"
    json.loads(out.getvalue())
    return _not_finite(output) if output.exists() else ""


def _not_finite(path: Path) -> str:
    """Return which dataset of a file has numbers that are none; the file is removed."""
    with h5py.File(path) as file:
        bad = [name for name in file if isinstance(file[name], h5py.Dataset) and not np.all(np.isfinite(file[name]))]
    path.unlink()
    return f"not finite: {', '.join(bad)}" if bad else ""


@contextmanager
def _patience() -> Iterator[None]:
    """Have Ctrl-C pressed when it lasts too long, and the process ended where that does not help."""
    process = os.getpid()
    timers = [
        threading.Timer(PATIENCE, os.kill, (process, signal.SIGINT)),
        threading.Timer(HANGS, os.kill, (process, signal.SIGABRT)),
    ]
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    for timer in timers:
        timer.daemon = True
        timer.start()
    try:
        yield
    finally:
        for timer in timers:
            timer.cancel()
        signal.signal(signal.SIGINT, before)


def tried(count: int) -> int:
    """Return how many files at random were taken as they should be, by hypothesis, which makes a bad one small.

    Raises
    ------
    AssertionError
        For the first that was not, with what was wrong and the file.
    """
    from hypothesis import HealthCheck, given, settings
    from hypothesis.strategies import randoms

    texts, good = seeds(), []

    @settings(
        max_examples=count,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(randoms(use_true_random=False))
    def one(random: Random) -> None:
        text = scenario(random, texts)
        with tempfile.TemporaryDirectory() as folder:
            what = trouble(text, Path(folder))
        assert not what, f"{what}: {text}"
        good.append(text)

    one()
    return len(good)
