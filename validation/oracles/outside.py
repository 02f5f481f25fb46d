"""Bodies on which something acts from outside, by plain differences in quadruple precision, for heyoka.

A distant mass is a third body here: its motion is integrated with the others', and what it does to a body, less what it
does to the origin, is the difference of two large numbers, of which 34 digits leave enough. Bodies attract as bodies of
second degree by Taylor's series of 1/r, which heyoka differentiates: no tide, no torque and no path is in closed form.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.oracles import mutual_potentials, taylor
from validation.oracles.taylor import REAL, Array, Start, Units, gradient, numbers, variables


class Distant(NamedTuple):
    """A mass: G times it [m3/s2], its place [m] and velocity [m/s] from the barycentre at t = 0, and G times all.

    And whether only the first term of its tide is wanted.
    """

    gm: float
    x: Array
    v: Array
    whole: float
    first_term_only: bool = False


class Symbols(NamedTuple):
    """What a force may depend on, in units of order one: of the bodies, of the distant masses, and the units."""

    x: Array
    v: Array
    R: Array
    Omega: Array
    s: Array
    units: Units


Force = Callable[[Symbols], tuple[Array, Array]]  # force (n, 3), inertial, and torque (n, 3) in the bodies' frames


def on_ellipse(gm: float, whole: float, orbit: ba.Orbit) -> Distant:
    """Return a mass about which the barycentre is on an orbit, by its elements."""
    node, i, apse, anomaly = (
        0.0 if angle is None else angle.to_value("rad")
        for angle in (
            orbit.longitude_of_ascending_node,
            orbit.inclination,
            orbit.argument_of_periapsis,
            orbit.true_anomaly,
        )
    )
    a, e = orbit.semi_major_axis.to_value("m"), orbit.eccentricity
    p, u = a * (1 - e * e), apse + anomaly

    def along(angle: float) -> Array:
        return np.array(
            [
                np.cos(node) * np.cos(angle) - np.sin(node) * np.sin(angle) * np.cos(i),
                np.sin(node) * np.cos(angle) + np.cos(node) * np.sin(angle) * np.cos(i),
                np.sin(angle) * np.sin(i),
            ]
        )

    right = np.pi / 2
    velocity = np.sqrt(whole / p) * (along(u + right) + e * along(apse + right))
    return Distant(gm, -p / (1 + e * np.cos(anomaly)) * along(u), -velocity, whole)


def on_hyperbola(flyby: ba.Flyby, whole: float) -> Distant:
    """Return the mass of a flyby at t = 0: from the closest point, where all is known, it is followed back in time."""
    directions = on_ellipse(
        1.0,
        1.0,
        ba.Orbit(
            flyby.distance,
            longitude_of_ascending_node=flyby.longitude_of_ascending_node,
            inclination=flyby.inclination,
            argument_of_periapsis=flyby.argument_of_periapsis,
        ),
    )
    q, far = (REAL(value.si.value) for value in (flyby.distance, flyby.speed))
    x, v = (a.astype(REAL) / np.sqrt((a.astype(REAL) ** 2).sum()) for a in (directions.x, directions.v))
    unit = np.sqrt(q**3 / REAL(whole))  # of time; that of length is q
    y = np.concatenate([x, v * np.sqrt(REAL(2.0) + far**2 * q / REAL(whole))])
    y = taylor.integrate(kepler(), y, REAL(-flyby.time.si.value) / unit, precise=True)
    return Distant(flyby.gm_si, y[:3] * q, y[3:] * q / unit, whole)


def kepler() -> list[tuple[Any, Any]]:
    """Return the equations of a place that is attracted by the origin, in units of order one."""
    s, w = variables("s", 3), variables("w", 3)
    r = mutual_potentials.norm(s)
    return [*zip(s, w, strict=True), *zip(w, -s / (r * r * r), strict=True)]


def path(distant: Distant, times: Array) -> Array:
    """Return the places (N, 3) [m] of a mass at growing times [s], from heyoka's motion."""
    length = REAL(np.linalg.norm(distant.x.astype(float)))
    unit = np.sqrt(length**3 / REAL(distant.whole))
    y = np.concatenate([distant.x.astype(REAL) / length, distant.v.astype(REAL) * (unit / length)])
    places, now = [], REAL(0.0)
    for time in times / unit:
        y = taylor.integrate(kepler(), y, time - now, precise=True) if time > now else y
        places.append(y[:3] * length)
        now = time
    return np.array(places)


def distant_of(perturbation: ba.Sun | ba.Planet | ba.Flyby, system: ba.System) -> Distant:
    """Return the mass of a perturbation: G times it and its path are the package's, its place and velocity are not."""
    whole = perturbation.gm_si + sum(body.si.gm for body in system.bodies if body.pulls)
    if isinstance(perturbation, ba.Flyby):
        return on_hyperbola(perturbation, whole)
    return on_ellipse(perturbation.gm_si, whole, perturbation.orbit)._replace(
        first_term_only=perturbation.first_term_only
    )


class OutsideMotion:
    """The motion of bodies with distant masses and forces, in units of order one."""

    def __init__(
        self,
        system: ba.System,
        state: ba.State,
        distant: Sequence[Distant] = (),
        forces: Sequence[Force] = (),
    ) -> None:
        self.system, self.units = system, Units.of(system, state)
        start = Start.of(system, state, self.units)
        pulling = np.array([float(body.pulls) for body in system.bodies]).astype(REAL) * start.m
        self.origin, self.drift = (pulling @ rows / pulling.sum() for rows in (start.x, start.v))
        self.start = start._replace(x=start.x - self.origin, v=start.v - self.drift)  # from the barycentre
        self.distant = distant
        self.rigid = np.array([not body.is_point for body in system.bodies])
        n, k = len(system.bodies), len(distant)
        shapes = {"x": (n, 3), "v": (n, 3), "R": (n, 3, 3), "Omega": (n, 3), "s": (k, 3), "w": (k, 3)}
        self.symbols = {name: variables(name, *shape) for name, shape in shapes.items()}
        self.equations = self._equations(forces)

    def _squares(self, i: int) -> Array:
        """Return the squares of the semi-axes of an ellipsoid with the body's mass and moments."""
        J = self.start.J[i]
        return numbers(REAL(5.0) * (REAL(0.5) * J.sum() - J) / self.start.m[i])

    def _between(self, i: int, j: int) -> Any:
        """Return U of two bodies."""
        m, gm = numbers(self.start.m), numbers(self.start.gm)
        x, R = self.symbols["x"], self.symbols["R"]
        if not self.rigid[i] and not self.rigid[j]:
            return -gm[i] * m[j] / mutual_potentials.norm(x[i] - x[j])
        squares = self._squares(i), self._squares(j)
        return mutual_potentials.ellipsoids(gm[i], m[j], *squares, x[i] - x[j], R[i], R[j], degree=2)

    def _from(self, mass: int, i: int) -> Any:
        """Return U of a body and a distant mass, and of what the body feels of the origin's fall towards that."""
        gm = numbers(np.array([self.distant[mass].gm / self.units.length**3 * self.units.time**2]).astype(REAL))[0]
        m = numbers(self.start.m)[i]
        x, R, s = self.symbols["x"][i], self.symbols["R"][i], self.symbols["s"][mass]
        r = mutual_potentials.norm(s)
        if self.distant[mass].first_term_only:
            tenth = hy.expression(REAL(1.0) / REAL(10.0))
            second = mutual_potentials.derivatives(s, 2)
            U = -gm * m * 0.5 * (x @ second @ x)
            turned = R @ np.diag(self._squares(i)) @ R.T
            return U - gm * m * tenth * mutual_potentials.contracted(second, turned) if self.rigid[i] else U
        falling = gm * m * (x @ s) / (r * r * r)
        if not self.rigid[i]:
            return -gm * m / mutual_potentials.norm(x - s) + falling
        zero, one = numbers(np.zeros(3).astype(REAL)), numbers(np.eye(3).astype(REAL))
        return mutual_potentials.ellipsoids(gm, m, self._squares(i), zero, x - s, R, one, degree=2) + falling

    def _felt(self, i: int) -> Any:
        """Return the part of U that a body feels."""
        bodies = self.system.bodies
        of_pairs = [self._between(i, j) for j in range(len(bodies)) if j != i and bodies[j].pulls]
        return sum([*of_pairs, *(self._from(mass, i) for mass in range(len(self.distant)))], 0.0)

    def _equations(self, forces: Sequence[Force]) -> list[tuple[Any, Any]]:
        """Return the equations, each as a variable and its derivative."""
        x, v, R, Omega, s, w = self.symbols.values()
        m, J = numbers(self.start.m), numbers(self.start.J)
        given = [force(Symbols(x, v, R, Omega, s, self.units)) for force in forces]
        equations: list[tuple[Any, Any]] = []
        for i in range(len(x)):
            dx, dR = gradient(self._felt(i), x[i], R[i])
            F = sum((F[i] for F, _ in given), -dx)
            equations += [*zip(x[i], v[i], strict=True), *zip(v[i], F / m[i], strict=True)]
            if self.rigid[i]:
                N = sum((N[i] for _, N in given), sum(np.cross(R[i][p], dR[p]) for p in range(3)))
                turning = (np.cross(J[i] * Omega[i], Omega[i]) + N) / J[i]
                rates = np.array([np.cross(row, Omega[i]) for row in R[i]])
                equations += [*zip(R[i].ravel(), rates.ravel(), strict=True), *zip(Omega[i], turning, strict=True)]
        for k, mass in enumerate(self.distant):
            whole = numbers(np.array([mass.whole / self.units.length**3 * self.units.time**2]).astype(REAL))[0]
            r = mutual_potentials.norm(s[k])
            equations += [*zip(s[k], w[k], strict=True), *zip(w[k], -whole * s[k] / (r * r * r), strict=True)]
        return equations

    @property
    def y(self) -> Array:
        """The start, in the order of the equations."""
        st, (length, time, _) = self.start, self.units
        parts = []
        for i in range(len(st.x)):
            parts += [st.x[i], st.v[i], *([st.R[i].ravel(), st.Omega[i]] if self.rigid[i] else [])]
        for mass in self.distant:
            parts += [mass.x.astype(REAL) / REAL(length), mass.v.astype(REAL) * REAL(time / length)]
        return np.concatenate(parts)

    def at(self, time: float) -> Snapshot:
        """Return where the bodies are after a time [s], from the start, in SI and in quadruple precision."""
        y = taylor.integrate(self.equations, self.y, time / self.units.time, precise=True)
        x, v, Omega, R = (array.copy() for array in (self.start.x, self.start.v, self.start.Omega, self.start.R))
        at = 0
        for i in range(len(x)):
            x[i], v[i], at = y[at : at + 3], y[at + 3 : at + 6], at + 6
            if self.rigid[i]:
                R[i], Omega[i], at = y[at : at + 9].reshape(3, 3), y[at + 9 : at + 12], at + 12
        x, v = x + self.origin + self.drift * REAL(time / self.units.time), v + self.drift
        return taylor.floats(taylor.in_si(Snapshot(v, Omega, x, R), self.units))
