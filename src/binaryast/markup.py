"""What a notebook shows of bodies, systems, states and runs: small tables, and a run's paths. All texts are escaped.

Colours and fonts are the notebook's own, so that it reads on light and on dark ground.
"""

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from binaryast.units import Floats, span

INKS = ("#3d7ab5", "#c8553d", "#6a994e", "#9b5fb0", "#e0a030", "#2a9d8f", "#8d6b4f", "#888888")
MOST_BODIES, MOST_POINTS, SIDE = 12, 400, 220
ENDINGS = {"completed": "#6a994e", "failed": "#c8553d"}  # the others are in between


def body(one: Any) -> str:
    """Return a body: shape, mass, density, moments of inertia."""
    moments = ", ".join(f"{moment:.6g}" for moment in one.si.moments)
    rows = [
        ("shape", shape_text(one.shape)),
        ("mass", f"{one.si.mass:.6g} kg"),
        ("G times mass", f"{one.si.gm:.8g} m³/s²"),
        *([] if one.density is None else [("density", f"{one.density.value:.5g} kg/m³")]),
        ("moments of inertia", f"{moments} kg m²"),
        *([("reaches", f"{one.bounding_radius:.6g} m from its mass centre")] if one.bounding_radius else []),
        *([] if one.pulls else [("pulls others", "no")]),
    ]
    return card(one.name, table(rows))


def system(one: Any) -> str:
    """Return a system: its bodies, how they attract, what acts from outside."""
    shown = [
        (each.name, shape_text(each.shape), f"{each.si.mass:.6g} kg", "" if each.pulls else "does not pull")
        for each in one.bodies[:MOST_BODIES]
    ]
    models = [one.gravity] if not isinstance(one.gravity, tuple) else [pair.gravity for pair in one.pairs]
    rows = [("gravity", "; ".join(dict.fromkeys(repr(model) for model in models)))]
    rows += [("from outside", type(each).__name__) for each in one.perturbations]
    return card(f"System of {len(one.bodies)} bodies", table(shown, left_out(one.bodies)) + table(rows))


def state(one: Any) -> str:
    """Return a state: where each body is, how fast it moves and turns."""
    position, velocity, _, spin = one.si
    shown = [("body", "position", "velocity", "spin period")]
    for i in range(min(len(position), MOST_BODIES)):
        rate = float(np.linalg.norm(spin[i]))
        turn = span(2 * np.pi / rate) if rate > 0 else "does not turn"
        shown.append((str(i), f"{vector(position[i])} m", f"{vector(velocity[i])} m/s", turn))
    epoch = "" if one.epoch is None else f", {one.epoch.isot} TDB"
    return card(f"State in axes {one.frame}{epoch}", table(shown, left_out(position)))


def run(one: Any) -> str:
    """Return a run: how it ended, what it cost, how well it kept what it should, and a picture of its paths."""
    figures = [
        ("energy", f"{one.max_relative_energy_error:.1e} of |E0|, {one.max_energy_error_over_potential:.1e} of |U0|"),
        ("angular momentum", f"{one.max_relative_angular_momentum_error:.1e}"),
        ("linear momentum", f"{one.max_relative_linear_momentum_error:.1e}"),
        ("rotation", f"{one.max_rotation_error:.1e}"),
    ]
    rows = [
        ("time", f"{span(one.si.time[-1])}, {len(one)} rows"),
        *([] if one.epoch is None else [("from", f"{one.epoch.isot} TDB")]),
        ("by", f"{type(one.integrator).__name__}, {one.steps} steps of {one.step.value:g} s"),
        ("took", f"{one.wall_time.value:.2g} s"),
        ("closest", f"{one.closest_approach.value:.6g} m after {span(one.closest_approach_time.value)}"),
        *((f"error of {name}", value) for name, value in figures),
        *([("events", str(len(one.events)))] if one.watched else []),
        *([("impulses", str(len(one.impulses)))] if one.impulses else []),
    ]
    names = [*one.system.names[:MOST_BODIES], *([] if len(one.system.names) <= MOST_BODIES else ["..."])]
    ink = ENDINGS.get(one.status, "#e0a030")
    badge = f'<span style="color: {ink}">&#9679; {escape(one.status)}</span>'
    said = f"<div>{escape(one.message)}</div>" if one.message else ""
    aside = f'<div style="display: flex; gap: 1.5em; align-items: flex-start">{table(rows)}{paths(one)}</div>'
    return card(", ".join(names), aside, badge + said)


def paths(one: Any) -> str:
    """Return the paths of the mass centres about the first body's mean place, across the axis that they go round."""
    chosen = np.unique(np.linspace(0, len(one) - 1, MOST_POINTS).round().astype(int))
    places = one.si.position[chosen][:, :MOST_BODIES]
    places = places - places[:, :1].mean(axis=0)
    flat = places @ plane(one).T
    size = float(np.abs(flat).max())
    if not size > 0:
        return ""
    scaled = SIDE / 2 * (1 + 0.94 * flat * [1, -1] / size)
    lines = []
    for i in range(scaled.shape[1]):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in scaled[:, i])
        x, y = scaled[-1, i]
        ink, name = INKS[i % len(INKS)], escape(one.system.names[i])
        lines.append(f'<polyline points="{points}" fill="none" stroke="{ink}" stroke-opacity="0.6"/>')
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{ink}"><title>{name}</title></circle>')
    return f'<svg width="{SIDE}" height="{SIDE}" role="img" aria-label="paths of the bodies">{"".join(lines)}</svg>'


def plane(one: Any) -> Floats:
    """Return two axes (2, 3) across the angular momentum of the second body about the first, at the start."""
    x, v = (array[0, 1] - array[0, 0] for array in (one.si.position, one.si.velocity))
    pole = np.cross(x, v)
    if not np.linalg.norm(pole) > 0:
        return np.eye(3)[:2]
    z = pole / np.linalg.norm(pole)
    first = np.eye(3)[np.argmin(np.abs(z))]
    first = first - (first @ z) * z
    first = first / np.linalg.norm(first)
    return np.array([first, np.cross(z, first)])


def shape_text(shape: Any) -> str:
    """Return a shape without the clutter of its quantities."""
    return repr(shape).replace("<Quantity ", "").replace(">", "")


def vector(values: Floats) -> str:
    """Return three numbers."""
    return f"({', '.join(f'{value:.5g}' for value in values)})"


def left_out(items: Sequence[Any]) -> str:
    """Return how many items there are beyond those shown; nothing where there are none."""
    return "" if len(items) <= MOST_BODIES else f"and {len(items) - MOST_BODIES} more"


def table(rows: Sequence[Sequence[str]], more: str = "") -> str:
    """Return rows of texts as a table, the first text of each as its head."""
    lines = []
    for head, *cells in rows:
        rest = "".join(f'<td style="text-align: left">{escape(cell)}</td>' for cell in cells)
        lines.append(f'<tr><th style="text-align: left">{escape(head)}</th>{rest}</tr>')
    return f"<table>{''.join(lines)}</table>" + (f"<div>{escape(more)}</div>" if more else "")


def card(title: str, inner: str, more: str = "") -> str:
    """Return a title, and what is below it; ``title`` is a text, the others are HTML."""
    return f"<div><strong>{escape(title)}</strong> {more}{inner}</div>"
