"""The report: one page of HTML that needs no other file, and the same as Markdown with its figures beside it."""

import base64
import html
import io
import tempfile
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from binaryast.errors import InputError
from binaryast.reporting import provenance
from validation.case import Check, Picture
from validation.runner import Outcome

TITLE = "Validation of binaryast"
STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 3rem; border-top: 1px solid #ccc; padding-top: 1.2rem; }
table { border-collapse: collapse; width: 100%; font-size: 14px; margin: 1rem 0; }
th, td { text-align: left; vertical-align: top; padding: .35rem .6rem; border-bottom: 1px solid #ddd; }
td.number, th.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.pass { color: #1a6b2f; } .fail { color: #b00020; font-weight: 600; }
figure { margin: 1.5rem 0; } figure img { max-width: 100%; } figcaption { font-size: 14px; color: #444; }
p.oracle { color: #444; } code { font-size: 90%; }
"""


def prepare(folder: Path) -> None:
    """Make the folder, before anything is run that would be lost without it, and remove the figures of a report before.

    Raises
    ------
    InputError
        Where it cannot be written.
    """
    try:
        (folder / "figures").mkdir(parents=True, exist_ok=True)
        for old in (folder / "figures").glob("*.svg"):
            old.unlink()
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"the report cannot be written to {folder} ({error}): choose another folder with -o") from None


def write(folder: Path, outcomes: Sequence[Outcome], command: str) -> list[Path]:
    """Write ``report.html``, ``report.md`` and the figures that the latter shows; return the two pages."""
    for picture in _pictures(outcomes):
        (folder / "figures" / f"{picture.name}.svg").write_bytes(svg(picture))
    pages = {"report.html": as_html(outcomes, command), "report.md": as_markdown(outcomes, command)}
    for name, text in pages.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in pages]


def svg(picture: Picture) -> bytes:
    """Return a figure as SVG, the same bytes for the same figure."""
    stream = io.BytesIO()
    picture.figure.savefig(stream, format="svg", metadata={"Date": None})
    return stream.getvalue()


def number(value: float) -> str:
    """Return an error or a tolerance as the tables show it."""
    return f"{abs(value):.1e}"


def _pictures(outcomes: Sequence[Outcome]) -> list[Picture]:
    return [picture for outcome in outcomes if outcome.findings for picture in outcome.findings.pictures]


def summary(outcomes: Sequence[Outcome]) -> str:
    """Return one sentence: how many cases and checks passed."""
    checks = [check for outcome in outcomes for check in outcome.checks]
    good = sum(outcome.passed for outcome in outcomes)
    text = f"{good} of {len(outcomes)} cases pass, {sum(check.passed for check in checks)} of {len(checks)} checks"
    bad = [outcome.case.name for outcome in outcomes if not outcome.passed]
    return f"{text}. Not passed: {', '.join(bad)}." if bad else f"{text}."


def _made_by(command: str) -> str:
    """Return what made the report, so that it can be made again."""
    made = provenance()
    libraries = ", ".join(f"{name} {made[name]}" for name in ("python", "numpy", "scipy", "numba", "astropy"))
    return (
        f"Made by `{command}` on {datetime.now(UTC):%Y-%m-%d} with binaryast {made['binaryast']} "
        f"(kernels {made['kernels']}), {libraries}, on {made['machine']}; G = {made['G']} m3 kg-1 s-2. An error passes "
        "where it is at most its tolerance; no tolerance is more than ten times the error that is measured, or what "
        "printed digits leave, and each row says where the error comes from. Errors of round-off differ in their "
        "digits from machine to machine."
    )


def as_markdown(outcomes: Sequence[Outcome], command: str) -> str:
    """Return the report as Markdown; its figures are files in ``figures``."""
    lines = [f"# {TITLE}", "", summary(outcomes), "", _made_by(command), ""]
    lines += ["| case | against | checks | nearest to its tolerance | time | |", "|---|---|---|---|---|---|"]
    for o in outcomes:
        lines.append(f"| {' | '.join(_cell(text) for text in _summary_row(o))} |")
    for o in outcomes:
        lines += ["", f"## {o.case.name}: {o.verdict}", "", f"**{o.case.question}**", ""]
        lines += [f"Against: {o.case.oracle_and_version}.", ""]
        if o.problem:
            lines += [f"It did not run: {o.problem}", ""]
        if o.findings:
            for note in o.findings.notes:
                lines += [note, ""]
            lines += ["| what | error | tolerance | where the error comes from | |", "|---|---|---|---|---|"]
            lines += [f"| {' | '.join(_cell(text) for text in _check_row(check))} |" for check in o.checks]
            for picture in o.findings.pictures:
                caption = picture.caption.replace("\n", " ")
                lines += ["", f"![{caption}](figures/{picture.name}.svg)", "", f"*{caption}*"]
    return "\n".join(lines) + "\n"


def as_html(outcomes: Sequence[Outcome], command: str) -> str:
    """Return the report as one page that needs no other file."""
    parts = [
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>',
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body>',
        f"<h1>{TITLE}</h1><p><strong>{_text(summary(outcomes))}</strong></p><p>{_text(_made_by(command))}</p>",
        _table(
            ("case", "against", "checks", "nearest to its tolerance", "time", ""),
            [_summary_row(o) for o in outcomes],
            [o.passed for o in outcomes],
            links=[o.case.name for o in outcomes],
        ),
    ]
    for o in outcomes:
        parts.append(f'<h2 id="{o.case.name}">{o.case.name}: {_verdict(o.verdict, o.passed)}</h2>')
        parts.append(f"<p><strong>{_text(o.case.question)}</strong></p>")
        parts.append(f'<p class="oracle">Against: {_text(o.case.oracle_and_version)}.</p>')
        if o.problem:
            parts.append(f'<p class="fail">It did not run: {_text(o.problem)}</p>')
        if o.findings:
            parts += [f"<p>{_text(note)}</p>" for note in o.findings.notes]
            header = ("what", "error", "tolerance", "where the error comes from", "")
            parts.append(_table(header, [_check_row(c) for c in o.checks], [c.passed for c in o.checks]))
            parts += [_figure(picture) for picture in o.findings.pictures]
    return "\n".join([*parts, "</body></html>"]) + "\n"


def _summary_row(o: Outcome) -> tuple[str, ...]:
    """Return the row of a case in the table on top."""
    nearest = ""
    if (check := o.tightest) is not None:
        nearest = f"{number(check.error)} of {number(check.tolerance)}: {check.what}"
    passed = f"{len(o.checks) - len(o.failed)} of {len(o.checks)}"
    return (o.case.name, o.case.oracle_and_version, passed, nearest or o.problem, f"{o.seconds:.1f} s", o.verdict)


def _check_row(check: Check) -> tuple[str, ...]:
    """Return the row of a check."""
    what = f"{check.what}: {check.shown}" if check.shown else check.what
    verdict = "pass" if check.passed else "FAIL"
    return (what, number(check.error), number(check.tolerance), check.why, verdict)


def _table(
    header: Sequence[str], rows: Sequence[Sequence[str]], passed: Sequence[bool], links: Sequence[str] = ()
) -> str:
    """Return a table whose last column is a verdict."""
    numbers = {k for k, name in enumerate(header) if name in ("error", "tolerance", "time", "checks")}
    style = {k: ' class="number"' if k in numbers else "" for k in range(len(header))}
    head = "".join(f"<th{style[k]}>{_text(name)}</th>" for k, name in enumerate(header))
    lines = [f"<table><thead><tr>{head}</tr></thead><tbody>"]
    for i, (row, good) in enumerate(zip(rows, passed, strict=True)):
        cells = [f"<td{style[k]}>{_text(cell)}</td>" for k, cell in enumerate(row[:-1])]
        if links:
            cells[0] = f'<td><a href="#{links[i]}">{_text(row[0])}</a></td>'
        lines.append(f"<tr>{''.join(cells)}<td>{_verdict(row[-1], good)}</td></tr>")
    return "".join([*lines, "</tbody></table>"])


def _figure(picture: Picture) -> str:
    data = base64.b64encode(svg(picture)).decode("ascii")
    caption = _text(picture.caption)
    alt = html.escape(picture.caption, quote=True)
    return (
        f'<figure><img alt="{alt}" src="data:image/svg+xml;base64,{data}"><figcaption>{caption}</figcaption></figure>'
    )


def _verdict(text: str, passed: bool) -> str:
    return f'<span class="{"pass" if passed else "fail"}">{_text(text)}</span>'


def _text(text: str) -> str:
    """Return a text for HTML; what stands between backticks is code."""
    parts = html.escape(text, quote=False).split("`")
    return "".join(f"<code>{part}</code>" if k % 2 else part for k, part in enumerate(parts))


def _cell(text: str) -> str:
    """Return a text for a cell of a Markdown table."""
    return text.replace("|", "\\|").replace("\n", " ")
