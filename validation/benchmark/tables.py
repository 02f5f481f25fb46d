"""Tables of the benchmark, in Markdown, from measured points."""

from collections.abc import Sequence
from typing import NamedTuple

from validation.benchmark.measure import Point, best
from validation.benchmark.problems import EVERYTHING, POSITION, Problem

TARGETS = (1e-4, 1e-6, 1e-8, 1e-10)


class Result(NamedTuple):
    """What was measured of a problem.

    ``reference`` is how good the reference is; ``compiling`` are lines on what compiling takes.
    """

    problem: Problem
    points: list[Point]
    reference: float
    compiling: list[str]


def kinds_of(problem: Problem) -> tuple[str, ...]:
    """Return the kinds of error of a problem."""
    return (POSITION, EVERYTHING) if problem.has_attitudes else (POSITION,)


def milliseconds(seconds: float) -> str:
    """Return a time in ms with three digits."""
    return f"{seconds * 1e3:.3g}"


def rows(lines: Sequence[Sequence[str]]) -> list[str]:
    """Return a table in Markdown; the first line is the head."""
    head, *body = lines
    return [f"| {' | '.join(line)} |" for line in (head, ["---"] * len(head), *body)]


def times(result: Result, kind: str) -> list[str]:
    """Return the CPU time of each method to each error, the quickest of a family in bold."""
    points = result.points
    lines = [["family", "method", *(f"{target:g}" for target in TARGETS)]]
    for family in dict.fromkeys(point.family for point in points):
        of_family = [point for point in points if point.family == family]
        for method in dict.fromkeys(point.method for point in of_family):
            line = [family, method]
            for target in TARGETS:
                found = best(target, [point for point in of_family if point.method == method], kind)
                first = best(target, of_family, kind)
                cell = "-" if found is None else milliseconds(found.seconds)
                line.append(f"**{cell}**" if found and first and found.method == first.method else cell)
            lines.append(line)
    return rows(lines)


def ratios(result: Result, *, call: bool = False) -> list[tuple[str, float, float | None, float | None, str, str]]:
    """Return kind, error, ratio of heyoka's time to ours, the ratio asked for, and which methods they are."""
    ours = [point for point in result.points if point.family == "ours"]
    theirs = [point for point in result.points if point.family == "heyoka"]
    found = []
    for kind in kinds_of(result.problem):
        for target in TARGETS:
            one, two = best(target, ours, kind, call=call), best(target, theirs, kind)
            ratio = two.seconds / one.seconds if one and two else None
            asked = result.problem.asked.get(kind, {}).get(target)
            found.append((kind, target, ratio, asked, one.method if one else "-", two.method if two else "-"))
    return found


def ratio_table(results: Sequence[Result]) -> list[str]:
    """Return heyoka's best time over our best, of the steps and of the whole call, beside what is asked."""
    lines = [["problem", "error", "of", "heyoka over ours", "asked", "of the whole call", "ours", "heyoka"]]
    for result in results:
        for steps, whole in zip(ratios(result), ratios(result, call=True), strict=True):
            kind, target, ratio, asked, ours, theirs = steps
            if ratio is None and asked is None:
                continue
            value = "-" if ratio is None else f"{ratio:.3g}"
            missed = asked is not None and (ratio is None or ratio < asked)
            of_call = "-" if whole[2] is None else f"{whole[2]:.3g}"
            ask = "" if asked is None else f"{asked:g}" + (", missed" if missed else "")
            lines.append([result.problem.name, f"{target:g}", kind, value, ask, of_call, ours, theirs])
    return rows(lines)


def by_mode(results: Sequence[Result]) -> list[str]:
    """Return the time of each of heyoka's modes, of REBOUND's and SciPy's methods, over our best, to each error."""
    lines = [["problem", "error of", "over ours", *(f"{target:g}" for target in TARGETS)]]
    for result in results:
        ours = [point for point in result.points if point.family == "ours"]
        for kind in kinds_of(result.problem):
            for family, method in dict.fromkeys((p.family, p.method) for p in result.points if p.family != "ours"):
                of_method = [p for p in result.points if (p.family, p.method) == (family, method)]
                pairs = [(best(target, ours, kind), best(target, of_method, kind)) for target in TARGETS]
                cells = [f"{two.seconds / one.seconds:.3g}" if one and two else "-" for one, two in pairs]
                lines.append([result.problem.name, kind, f"{family}, {method}", *cells])
    return rows(lines)


def readme(results: Sequence[Result]) -> list[str]:
    """Return our best and heyoka's best time [ms], and their ratio, in one small table."""
    lines = [["ms, ours / heyoka (ratio), to an error of", *(f"{target:g}" for target in TARGETS)]]
    for result in results:
        for kind in kinds_of(result.problem):
            cells = []
            for target in TARGETS:
                found = [best(target, [p for p in result.points if p.family == f], kind) for f in ("ours", "heyoka")]
                texts = [milliseconds(one.seconds) if one else "-" for one in found]
                ratio = f" ({found[1].seconds / found[0].seconds:.3g})" if found[0] and found[1] else ""
                cells.append(" / ".join(texts) + ratio)
            lines.append([f"{result.problem.title}: {kind}", *cells])
    return rows(lines)


def points_table(result: Result) -> list[str]:
    """Return every measured point."""
    lines = [["family", "method", "setting", "ms", "ms of the call", "error of position", "error of everything"]]
    for p in result.points:
        values = (milliseconds(p.seconds), milliseconds(p.call), f"{p.position:.1e}", f"{p.everything:.1e}")
        lines.append([p.family, p.method, p.setting, *values])
    return rows(lines)


def report(results: Sequence[Result]) -> str:
    """Return everything in Markdown."""
    text = ["## heyoka's CPU time over ours, the best of both", "", *ratio_table(results)]
    text += ["", "## Each method of others over our best", "", *by_mode(results)]
    for result in results:
        text += ["", f"## {result.problem.name}: {result.problem.title}", ""]
        text += [f"Reference: 80-bit Taylor series at 1e-19, {result.reference:.1e} from one at 1e-17.", ""]
        for kind in kinds_of(result.problem):
            text += [f"CPU time of the steps [ms] to an error of {kind}:", "", *times(result, kind), ""]
        text += [f"- {line}" for line in result.compiling]
        text += ["", "<details><summary>every point</summary>", "", *points_table(result), "", "</details>"]
    return "\n".join(text) + "\n"
