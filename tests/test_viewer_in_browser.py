"""The page in a real browser: it loads without a word of complaint, plays, goes where it is sent, and shows bodies."""

import io
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import astropy.units as u
import matplotlib.pyplot as plt
import numpy as np
import pytest

import binaryast as ba
from tests import pages

pytestmark = [
    pytest.mark.skipif(pages.CHROMIUM is None, reason="there is no Chromium here: on Debian, apt-get install chromium"),
    pytest.mark.skipif(find_spec("playwright") is None, reason="playwright is not installed: pip install -e '.[dev]'"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),  # the driver's pipes
]
GROUND = np.array([16, 19, 24])


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page of Didymos in the Sun's light, with two bodies, three orbits and an epoch."""
    system, state = ba.catalogue.load("didymos")
    sun = ba.Sun(ba.Orbit(1.6442 * u.au, eccentricity=0.38385))
    system = ba.System(system.bodies, gravity=system.gravity, perturbations=[sun])
    run = ba.propagate(system, state, duration=36 * u.h, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)
    return ba.view(run, tmp_path_factory.mktemp("pages") / "didymos.html")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with pages.browser() as browser:
        yield browser


@pytest.fixture
def page(browser: Any, path: Path) -> Iterator[Any]:
    """The page, open; whatever it complains of fails the test."""
    with pages.opened(browser, path) as page:
        yield page


def time_of(page: Any) -> float:
    return page.evaluate("viewer.state.time")


def shot(page: Any) -> np.ndarray:
    """Return what is drawn of space (height, width, 3), without names and paths."""
    page.evaluate("viewer.state.stale = true")
    pages.until(page, "!viewer.state.stale")
    image = plt.imread(io.BytesIO(page.locator("#space").screenshot()))
    return np.rint(255 * image[..., :3]).astype(int)


def without_words(page: Any) -> None:
    """Leave the bodies alone: no names, no paths, and light from the eye."""
    page.uncheck("#names")
    page.select_option("#trail", "0")
    page.uncheck("#sun")


def near(image: np.ndarray, centre: list[float]) -> float:
    """Return the share of pixels that differ from the ground in a small square."""
    x, y = (round(value) for value in centre)
    patch = image[y - 3 : y + 4, x - 3 : x + 4]
    return float(np.mean(np.abs(patch - GROUND).max(axis=-1) > 30))


def on_screen(page: Any, body: int) -> list[float]:
    """Return where the mass centre of a body is on the screen, by the page's own camera."""
    return page.evaluate(
        """(body) => {
            const { space, motion, state } = viewer, frame = motion.shown(state.time, space.axes);
            const place = Motion.turned(frame.turn, Motion.minus(motion.at(state.time, body).place, frame.origin));
            const seen = new THREE.Vector3(...place).project(space.camera.eye), box = space.canvas;
            return [(seen.x + 1) / 2 * box.clientWidth, (1 - seen.y) / 2 * box.clientHeight];
        }""",
        body,
    )


def test_both_bodies_are_seen_where_they_should_be(page: Any) -> None:
    without_words(page)
    for time in (0, 20_000, 47_000):
        page.evaluate(f"viewer.go({time})")
        image = shot(page)
        assert near(image, on_screen(page, 0)) == 1
        assert near(image, on_screen(page, 1)) == 1 or time == 20_000  # it may be behind the primary
        shown = np.abs(image - GROUND).max(axis=-1) > 30
        assert 0.01 < shown.mean() < 0.25
        assert not shown[:10].any()
        assert not shown[-10:-2].any()


def test_it_plays_and_stops(page: Any) -> None:
    assert page.locator("#play").get_attribute("aria-label") == "Play"
    page.keyboard.press(" ")
    pages.until(page, "viewer.state.time > 5000")
    assert page.locator("#play").get_attribute("aria-label") == "Pause"
    page.click("#play")
    stopped, drawn = time_of(page), page.evaluate("viewer.state.drawn")
    page.wait_for_timeout(200)
    assert time_of(page) == stopped
    assert page.evaluate("viewer.state.drawn") <= drawn + 2  # nothing new, nothing drawn
    page.evaluate("viewer.go(129600 - 1)")
    page.keyboard.press(" ")
    pages.until(page, "!viewer.state.playing")
    assert time_of(page) == 129600
    page.click("#play")  # from the start again
    pages.until(page, "viewer.state.time > 0 && viewer.state.time < 100000")


def test_it_goes_where_it_is_sent(page: Any) -> None:
    page.locator("#scrub").evaluate("(one) => { one.value = 64800; one.dispatchEvent(new Event('input')); }")
    assert time_of(page) == pytest.approx(64800, abs=1)
    pages.until(page, "!viewer.state.stale")
    assert page.locator("#clock").inner_text() == "18.000 h"
    page.locator("#space").focus()
    for key, time in (
        ("Home", 0),
        ("ArrowRight", 600),
        ("Shift+ArrowRight", 6600),
        ("ArrowLeft", 6000),
        ("End", 129600),
    ):
        page.keyboard.press(key)
        assert time_of(page) == time
    before = float(page.locator("#pace").inner_text().removesuffix(" min a second"))
    page.keyboard.press("ArrowUp")
    pages.until(page, "!viewer.state.stale")
    after = float(page.locator("#pace").inner_text().removesuffix(" h a second"))
    assert after == pytest.approx(2 * before / 60, rel=1e-3)


def test_the_panel_follows_the_time(page: Any, path: Path) -> None:
    page.evaluate("viewer.go(64800)")
    pages.until(page, "!viewer.state.stale")
    rows = page.locator("#kept tbody tr")
    data = pages.data_of(path.read_text(encoding="utf-8"))
    assert rows.count() == len(data["kept"]) == 4
    value, unit = rows.nth(0).locator("td").nth(0).inner_text().split()
    assert (float(value), unit) == (pytest.approx(1.1104e10, rel=1e-4), "J")
    at_start = page.locator("#chart").screenshot()
    page.keyboard.press("End")
    pages.until(page, "!viewer.state.stale")
    assert page.locator("#chart").screenshot() != at_start


def test_axes_that_turn_keep_the_secondary_where_it_is(page: Any) -> None:
    without_words(page)
    page.select_option("#axes", label="line of centres")
    places = []
    for time in (1000, 30_000, 90_000):
        page.evaluate(f"viewer.go({time})")
        image = shot(page)
        places.append(on_screen(page, 1))
        assert near(image, places[-1]) == near(image, on_screen(page, 0)) == 1
    assert np.ptp(places, axis=0).max() < 12  # pixels: the separation changes by little
    page.locator("#space").focus()
    page.keyboard.press("f")
    assert page.locator("#axes option:checked").inner_text() == "fixed in Didymos"


def test_light_comes_from_the_sun(page: Any) -> None:
    page.uncheck("#names")
    page.select_option("#trail", "0")
    by_day = shot(page)
    page.uncheck("#sun")
    by_lamp = shot(page)
    lit = [np.mean(image.max(axis=-1) > 90) for image in (by_day, by_lamp)]
    assert lit[0] < 0.8 * lit[1]  # there is a night side


def test_one_row_is_shown_and_does_not_play(browser: Any, tmp_path: Path) -> None:
    system, state = ba.catalogue.load("dumbbells")
    run = ba.propagate(system, state, duration=0.01 * u.s, integrator=ba.LGVI(0.001 * u.s))
    with pages.opened(browser, ba.view(run[:1], tmp_path / "one.html")) as page:
        assert page.locator("#play").is_disabled()
        page.keyboard.press(" ")
        page.keyboard.press("ArrowRight")
        assert time_of(page) == 0
        assert not page.locator("#with-sun").is_visible()
        assert np.mean(np.abs(shot(page) - GROUND).max(axis=-1) > 30) > 0.003
