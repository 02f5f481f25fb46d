"""Pictures of what is read off; those of `KINDS` are drawn in ``tests/test_analysis.py``."""

import astropy.units as u
import matplotlib.pyplot as plt
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError


def test_elements_of_short_and_long_runs(tumbling: tuple[ba.System, ba.State]) -> None:
    run = ba.propagate(*tumbling, duration=4 * u.day, integrator=ba.LGVI(20 * u.s), save_every=30 * u.min)
    for rows, lines in ((run, 2), (run[:20], 1)):
        figure = ba.plotting.elements(rows)
        assert len(figure.axes) == 6
        assert all(len(ax.lines) == lines for ax in figure.axes[:5])
    plt.close("all")


def test_a_spectrum_with_its_names() -> None:
    t = np.linspace(0, 400, 2000)
    found = ba.analysis.spectrum(t * u.s, np.cos(t) + 0.1 * np.cos(1.7 * t), lines=2)
    ax = ba.plotting.spectrum(found, proper={"$a": 1 * u.rad / u.s})
    assert [text.get_text() for text in ax.texts] == [r"\$a", ""]
    assert ba.plotting.spectrum(found, ax) is ax
    plt.close("all")


def test_one_of_several_is_named() -> None:
    system, state = ba.catalogue.load("sn263")
    run = ba.propagate(system, state, duration=3 * u.day, integrator=ba.LGVI(60 * u.s))
    assert "Gamma" in ba.plotting.roll_pitch_yaw(run, bodies=("Alpha", "Gamma")).get_title()
    assert "Gamma" in ba.plotting.poincare_section(run, bodies=("Alpha", "Gamma")).get_title()
    with pytest.raises(InputError, match="bodies"):
        ba.plotting.roll_pitch_yaw(run)
    plt.close("all")
