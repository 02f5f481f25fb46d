"""What tests of the page need: its numbers, Node, and a Chromium without a window."""

import json
import re
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any


def _node_of_playwright() -> str | None:
    """Return the Node that playwright brings for itself."""
    found = find_spec("playwright")
    if found is None or found.origin is None:
        return None
    return shutil.which("node", path=str(Path(found.origin).parent / "driver"))


CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
NODE = shutil.which("node") or _node_of_playwright()
MOTION = files("binaryast.viewer") / "page" / "motion.js"
FLAGS = [  # drawing by software, and no calls home
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"),
]


def data_of(page: str) -> dict[str, Any]:
    """Return the numbers that a page holds."""
    found = re.search(r'<script type="application/json" id="run">(.*?)</script>', page, re.DOTALL)
    assert found
    return json.loads(found.group(1))


def in_node(data: dict[str, Any], code: str) -> Any:
    """Return the value of an expression of ``motion``, the motion of a page, by Node."""
    script = (
        f"const Motion = require({json.dumps(str(MOTION))});"
        "const run = JSON.parse(require('fs').readFileSync(0));"
        "const motion = Motion.of(run.motion, run.bodies.length);"
        f"process.stdout.write(JSON.stringify({code}));"
    )
    assert NODE
    done = subprocess.run([NODE, "-e", script], input=json.dumps(data), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@contextmanager
def browser() -> Iterator[Any]:
    """Start Chromium."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield started
        started.close()


@contextmanager
def opened(browser: Any, path: Path, width: int = 1000, height: int = 700) -> Iterator[Any]:
    """Open a page; it must ask for nothing but itself, and complain of nothing."""
    page = browser.new_page(viewport={"width": width, "height": height})
    wrong: list[str] = []
    page.on("console", lambda message: wrong.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("request", lambda request: None if request.url == path.as_uri() else wrong.append(request.url[:100]))
    page.goto(path.as_uri())
    until(page, "window.viewer && viewer.state.drawn > 0")
    yield page
    page.close()
    assert wrong == []


def until(page: Any, condition: str, seconds: float = 30) -> None:
    """Wait until an expression is true; from outside, for the page's own policy forbids it to evaluate texts."""
    end = time.monotonic() + seconds
    while not page.evaluate(condition):
        assert time.monotonic() < end, f"waited {seconds:g} s for: {condition}"
        page.wait_for_timeout(20)
