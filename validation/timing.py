"""Times of jobs that take turns, so that what else the machine does meets all of them alike."""

import time
from collections.abc import Callable, Mapping

Job = tuple[Callable[[int], object], int]  # what is done so many times, and how many times in a round


def interleaved(jobs: Mapping[str, Job], rounds: int) -> dict[str, list[float]]:
    """Return the times [us] of each job, one for each round, after a round that only warms up."""
    times: dict[str, list[float]] = {name: [] for name in jobs}
    for job, _ in jobs.values():
        job(10)
    for _ in range(rounds):
        for name, (job, count) in jobs.items():
            began = time.perf_counter()
            job(count)
            times[name].append((time.perf_counter() - began) / count * 1e6)
    return times
