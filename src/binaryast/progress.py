"""What a long run shows and listens to while it is under way: why it has not begun yet, a bar, and Ctrl-C."""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import astropy.units as u

MOMENT = 0.5  # s


@contextmanager
def keyboard() -> Iterator[list[int]]:
    """Give a list that stays empty until Ctrl-C, which then waits for the end of the chunk.

    Only where Python's own handler is in place: in another thread, or under somebody else's, nothing changes.
    """
    pressed: list[int] = []
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield pressed
        return
    signal.signal(signal.SIGINT, lambda number, _: pressed.append(number))
    try:
        yield pressed
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def bar(end: float, progress: bool, begin: float = 0.0) -> Iterator[Any]:
    """Give a function that shows how far the run is, in seconds since ``begin``; it appears after a second."""
    if not progress:
        yield lambda _: None
        return
    from tqdm import tqdm

    unit, size = ("d", u.day.to(u.s)) if end > 2 * u.day.to(u.s) else ("s", 1.0)
    layout_of_bar = "{desc}{percentage:3.0f}%|{bar}| {n:.6g}/{total:.6g} {unit} simulated, {remaining} left"
    look = {"unit": unit, "delay": 1.0, "bar_format": layout_of_bar, "leave": False}
    with tqdm(total=end / size, initial=begin / size, **look) as shown:

        def show(elapsed: float) -> None:
            shown.update((begin + elapsed) / size - shown.n)

        yield show


@contextmanager
def said_if_long(text: str, progress: bool) -> Iterator[None]:
    """Say on standard error what keeps a run from beginning, where that takes more than a moment."""
    if not progress:
        yield
        return
    timer = threading.Timer(MOMENT, print, [f"binaryast: {text}"], {"file": sys.stderr, "flush": True})
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
