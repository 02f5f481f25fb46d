"""What a step and a stage cost, of pairs, several bodies and points: ``python -m validation.benchmark costs``.

One core, warm, interleaved, the median of several rounds. Absolute times depend on the machine and its neighbours; the
ratio to a plain vectorised sum over 256 point pairs, taken in the same rounds, hardly does. Every time is that of the
loop of a run: what is watched at each step, and the look for contact, are in it.
"""

import statistics
import time
from collections.abc import Callable

import astropy.units as u
import numba
import numpy as np

import binaryast as ba
from binaryast import working
from binaryast.gravity import Gravity
from binaryast.integrators import Stepping
from validation import costs_of_points
from validation.steps import SECOND_ORDER, take_steps
from validation.timing import interleaved

ROUNDS = 15
PLAIN = "plain vectorised sum over 256 point pairs"
SECOND = 1 * u.s  # the steps that are taken are given with each job
FAMILIES: dict[str, tuple[Stepping, float]] = {  # each with its step of Didymos [s]
    "LGVI, order 2": (ba.LGVI(SECOND), 40.0),
    "LGVI, order 8": (ba.LGVI(SECOND, order=8), 300.0),
    "Splitting rkn6a": (ba.Splitting(SECOND), 600.0),
    "Splitting ss10": (ba.Splitting(SECOND, scheme="ss10"), 1200.0),
    "KeplerSplitting aba864": (ba.KeplerSplitting(SECOND), 600.0),
}


@numba.njit(fastmath=True, error_model="numpy")
def plain_sum(a: np.ndarray, b: np.ndarray, repeats: int) -> float:
    """Evaluate potential and attraction of 16 x 16 point pairs, nothing around it; (4, 16) arrays x, y, z, m."""
    result = 0.0
    for k in range(repeats):
        u = fx = fy = fz = 0.0
        for i in range(a.shape[1]):
            x, y, z = a[0, i] + 1e-9 * k, a[1, i], a[2, i]
            for j in range(b.shape[1]):
                dx, dy, dz = x - b[0, j], y - b[1, j], z - b[2, j]
                square = dx * dx + dy * dy + dz * dz
                w = a[3, i] * b[3, j] / np.sqrt(square)
                u += w
                w /= square
                fx += w * dx
                fy += w * dy
                fz += w * dz
        result += u + fx + fy + fz
    return result


def stepper(
    name: str, h: float, gravity: Gravity | None = None, *, save: bool = False, inertial: bool = False
) -> Callable[[int], None]:
    """Return a function that takes steps of a catalogue entry, watched and, on request, with every 10th saved."""
    system, state = ba.catalogue.load(name)
    return steps_of(ba.System(system.bodies, gravity or system.gravity), state, h, save=save, inertial=inertial)


def steps_of(
    system: ba.System,
    state: ba.State,
    h: float,
    *,
    integrator: Stepping = SECOND_ORDER,
    save: bool = False,
    inertial: bool = False,
) -> Callable[[int], None]:
    """Return a function that takes watched steps of a system."""
    w = working.of(system, state, inertial=inertial)
    start = w.state.copy()

    def take(count: int) -> None:
        w.state[:] = start
        take_steps(w, h, count, integrator=integrator, save=10 if save else 0, touching=True)

    return take


def swarm(count: int) -> tuple[ba.System, ba.State]:
    """Return so many ellipsoids far from each other, every pair of them at second degree."""
    bodies = [ba.RigidBody(str(i), ba.Ellipsoid(50 * u.m, 40 * u.m, 30 * u.m), mass=1e9 * u.kg) for i in range(count)]
    place = np.stack([np.arange(count) * 5e3, np.arange(count) ** 2 * 1e3, np.arange(count) % 3 * 1e3], axis=1)
    zero, spin = np.zeros((count, 3)), np.tile([1e-5, 2e-5, 3e-4], (count, 1))
    return ba.System(bodies), ba.State(place * u.m, zero * u.m / u.s, [np.eye(3)] * count, spin * u.rad / u.s)


def scaling() -> None:
    """Measure steps of several bodies and print what a body and what a pair costs."""
    counts = (2, 3, 5, 10, 20)
    jobs = {n: steps_of(*swarm(n), 30.0, inertial=True) for n in counts}
    best = dict.fromkeys(counts, np.inf)
    for _ in range(ROUNDS):
        for n, job in jobs.items():
            steps = 40_000 // n**2
            began = time.perf_counter()
            job(steps)
            best[n] = min(best[n], (time.perf_counter() - began) / steps * 1e6)
    pairs = np.array([n * (n - 1) / 2 for n in counts])
    shares = np.linalg.lstsq(
        np.stack([np.array(counts), pairs], axis=1) / np.array([best[n] for n in counts])[:, None],
        np.ones(len(counts)),
    )[0]
    print(f"\n{'bodies':>7} {'pairs':>6} {'us, best':>9} {'fit':>8}")
    for n, count in zip(counts, pairs, strict=True):
        print(f"{n:7} {count:6.0f} {best[n]:9.3f} {shares @ (n, count):8.3f}")
    print(f"fit: {shares[0]:.3f} us for each body and {shares[1]:.3f} us for each of the n (n - 1)/2 pairs")


def plain() -> tuple[Callable[[int], object], int]:
    """Return the job of the plain sum, and how often it is done in a round."""
    random = np.random.default_rng(0)
    clouds = [
        np.vstack([random.normal(size=(3, 16)) + np.array([[offset], [0], [0]]), np.ones(16)]) for offset in (0.0, 10.0)
    ]
    return lambda n: plain_sum(*clouds, n), 40_000


def show(title: str, times: dict[str, list[float]], pieces: dict[str, int] | None = None) -> None:
    """Print times in us, each over the number of its pieces, beside the plain sum of the same rounds."""
    print(f"\n{title:44} {'us, median':>12} {'us, best':>10} {'ratio':>8}")
    for name, values in times.items():
        each = np.array(values) / (pieces or {}).get(name, 1)
        ratio = statistics.median(each / times[PLAIN])
        print(f"{name:44} {statistics.median(each):12.3f} {each.min():10.3f} {ratio:8.2f}")


def steps() -> None:
    """Measure steps of order 2 and print what they cost."""
    second = ba.SecondDegree()
    times = interleaved(
        {
            PLAIN: plain(),
            "LGVI step, second degree (didymos)": (stepper("didymos", 40.0, second), 60_000),
            "the same, every 10th step saved": (stepper("didymos", 40.0, second, save=True), 60_000),
            "LGVI step, degree 4 (didymos)": (stepper("didymos", 40.0), 60_000),
            "LGVI step, 2 x 2 point pairs (dumbbells)": (stepper("dumbbells", 1e-4), 60_000),
            "LGVI step, second degree, inertial frame": (stepper("didymos", 40.0, second, inertial=True), 60_000),
        },
        ROUNDS,
    )
    show("one step of order 2", times)
    pair, inertial = (times[name] for name in times if name.startswith("LGVI step, second degree"))
    ratio = statistics.median(two / one for one, two in zip(pair, inertial, strict=True))
    print(f"inertial frame over relative, median of rounds: {ratio:.2f}")


def stages() -> None:
    """Measure steps of every family at three degrees and print what a stage costs: an evaluation of gravity and all."""
    jobs, pieces = {PLAIN: plain()}, {}
    system, state = ba.catalogue.load("didymos")
    for degree, gravity in {2: ba.SecondDegree(), 4: ba.Multipole(4), 8: ba.Multipole(8)}.items():
        for family, (integrator, h) in FAMILIES.items():
            name = f"{family}, degree {degree}"
            job = steps_of(ba.System(system.bodies, gravity), state, h, integrator=integrator)
            pieces[name] = integrator.shares.stages
            jobs[name] = job, 20_000 // pieces[name] // (4 if degree == 8 else 1)
    show("one stage, a step over its stages (didymos)", interleaved(jobs, ROUNDS), pieces)


def main() -> None:
    """Measure and print."""
    steps()
    stages()
    scaling()
    costs_of_points.main()


if __name__ == "__main__":
    main()
