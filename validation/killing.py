"""Runs in a process of their own that are killed, and files compared bit by bit."""

import subprocess
import sys
import time
from pathlib import Path

import h5py

from binaryast import storage

BEGIN = """
import sys, warnings
import astropy.units as u
import binaryast as ba
from binaryast import streaming
warnings.simplefilter("ignore")
streaming.OFTEN = {often}
"""
RUN = """
system, state = ba.catalogue.load({name!r})
print("begins", flush=True)
ba.propagate(system, state, file=sys.argv[1], {how})
"""
RESUME = """
ba.resume(sys.argv[1])
"""


def process(path: Path, code: str, often: float = 0.05) -> "subprocess.Popen[str]":
    """Return a process that runs some code, with marks as often as is said."""
    command = [sys.executable, "-c", BEGIN.format(often=often) + code, str(path)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def whole(path: Path, name: str, how: str) -> float:
    """Have a run followed without a stop; return how long that takes [s], without the start of the process."""
    running = process(path, RUN.format(name=name, how=how))
    assert running.stdout is not None
    running.stdout.readline()
    began = time.monotonic()
    finish(running)
    return time.monotonic() - began


def killed(path: Path, name: str, how: str, after: float) -> bool:
    """Have a run killed after a time [s]; whether that came before its end, and its file says so."""
    running = process(path, RUN.format(name=name, how=how))
    assert running.stdout is not None
    running.stdout.readline()
    time.sleep(after)
    running.kill()
    running.communicate()
    under_way = path.exists() and storage.end_of_header(path) is not None
    if not under_way:
        path.unlink(missing_ok=True)
    return under_way


def resumed(path: Path) -> None:
    """Have a run gone on with, in another process."""
    finish(process(path, RESUME))


def finish(running: "subprocess.Popen[str]") -> None:
    """Wait for a process, and raise with what it said where it failed."""
    _, error = running.communicate(timeout=600)
    if running.returncode:
        raise RuntimeError(error)


def differences(one: Path, other: Path) -> list[str]:
    """Return in which datasets two files differ in any bit, and in which attributes beside the wall time."""
    with h5py.File(one) as a, h5py.File(other) as b:
        datasets = [_datasets(file) for file in (a, b)]
        names = sorted(set(datasets[0]) ^ set(datasets[1]))
        names += [name for name in datasets[0] if datasets[0][name] != datasets[1].get(name)]
        attributes = (set(a.attrs) | set(b.attrs)) - {"wall_time"}
        return names + sorted(name for name in attributes if a.attrs.get(name) != b.attrs.get(name))


def _datasets(file: h5py.File) -> dict[str, bytes]:
    """Return the bytes of all datasets, in groups too."""
    found: dict[str, bytes] = {}
    file.visititems(lambda name, item: found.update({name: item[()].tobytes()} if hasattr(item, "shape") else {}))
    return found
