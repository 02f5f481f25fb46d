"""The notebooks of examples/ run, print what the paper prints, and are stored with what they print.

``python -m tests.test_examples`` runs them and stores their outputs.
"""

import os
import re
import sys
import tempfile
from pathlib import Path

import nbformat
import pytest
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from traitlets import default

NOTEBOOKS = sorted((Path(__file__).parents[1] / "examples").glob("*.ipynb"))
NUMBER = r"-?\b\d+(?:\.\d*)?(?:e[-+]\d+)?"
ROUND_OFF = 1e-11  # what is smaller differs from one machine to another
SENSITIVE = ("RK45", "DOP853", "Runge-Kutta", "StepWarning", "accepted")  # off SO(3), round-off grows to any size
LARGEST = 700_000  # bytes of a file


class Kernel(AsyncKernelManager):
    """A kernel of this very interpreter: ipykernel's own description of one, not an installed one."""

    @default("kernel_spec_manager")
    def _no_installed_ones(self) -> KernelSpecManager:
        return KernelSpecManager(kernel_dirs=[])


def execute(path: Path, folder: Path) -> nbformat.NotebookNode:
    """Return a notebook as it comes out now, run in a folder of its own."""
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(
        notebook,
        kernel_name="python3",
        kernel_manager_class=Kernel,
        timeout=300,
        coalesce_streams=True,
        record_timing=False,
        resources={"metadata": {"path": str(folder)}},
    )
    assert client.create_kernel_manager().kernel_spec.argv[0] == sys.executable
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}  # for inline figures
    client.execute(env=environment | {"IPYTHONDIR": str(folder / "ipython")})
    return notebook


def store(path: Path, folder: Path) -> None:
    """Run a notebook and keep what it shows, without what only says where and when."""
    notebook = execute(path, folder)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    nbformat.validate(notebook)
    nbformat.write(notebook, path)


def code_cells(notebook: nbformat.NotebookNode) -> list[nbformat.NotebookNode]:
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def printed(notebook: nbformat.NotebookNode) -> str:
    outputs = [output for cell in code_cells(notebook) for output in cell.outputs]
    return "".join(output.text for output in outputs if output.output_type == "stream")


def table(notebook: nbformat.NotebookNode) -> dict[str, float]:
    """Return the last column of the table at a notebook's end."""
    (output,) = code_cells(notebook)[-1].outputs
    rows = [re.split(r"\s{2,}", line.strip()) for line in output.text.splitlines()]
    assert rows[0][0] == "quantity"
    return {row[0]: float(row[-1]) for row in rows[1:]}


@pytest.fixture(scope="module", params=NOTEBOOKS, ids=lambda path: path.stem)
def pair(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, nbformat.NotebookNode]:
    """A notebook's path, and what comes out of it now; a cell that raises is an error here."""
    return request.param, execute(request.param, tmp_path_factory.mktemp("notebook"))


def test_there_are_some() -> None:
    assert NOTEBOOKS


def test_what_is_stored_is_what_comes_out(pair: tuple[Path, nbformat.NotebookNode]) -> None:
    path, fresh = pair
    stored = nbformat.read(path, as_version=4)
    assert [cell.execution_count for cell in code_cells(stored)] == list(range(1, len(code_cells(stored)) + 1))
    for one, two in zip(code_cells(stored), code_cells(fresh), strict=True):
        assert [kind(output) for output in one.outputs] == [kind(output) for output in two.outputs], one.source
    for then, now in zip(printed(stored).splitlines(), printed(fresh).splitlines(), strict=True):
        assert re.sub(rf"\s*{NUMBER}", "#", then) == re.sub(rf"\s*{NUMBER}", "#", now)
        sensitive = any(word in then for word in SENSITIVE)
        for value, found in zip(map(float, re.findall(NUMBER, then)), map(float, re.findall(NUMBER, now)), strict=True):
            if abs(value) > ROUND_OFF and not sensitive:
                assert found == pytest.approx(value, rel=0.03)
            else:
                assert abs(value) / 3 <= abs(found) <= abs(value) * 3


def kind(output: nbformat.NotebookNode) -> tuple[str, ...]:
    return (output.output_type, *sorted(output.get("data", [output.get("name", "")])))


def test_it_says_nothing_of_the_machine(pair: tuple[Path, nbformat.NotebookNode]) -> None:
    path, _ = pair
    text = path.read_text(encoding="utf-8")
    assert len(text) <= LARGEST
    stored = nbformat.reads(text, as_version=4)
    assert stored.metadata.kernelspec.name == "python3"
    assert set(stored.metadata) == {"kernelspec", "language_info"}
    assert not any(cell.metadata for cell in stored.cells)
    for cell in code_cells(stored):
        for output in cell.outputs:
            output.get("data", {}).pop("image/png", None)
    assert not re.search(r"(?<![\w:/.])(/[\w.-]+){2,}|[A-Z]:\\\\|0x[0-9a-f]{6}", str(stored.cells))


def test_no_cell_writes_to_standard_error(pair: tuple[Path, nbformat.NotebookNode]) -> None:
    _, fresh = pair
    outputs = [output for cell in code_cells(fresh) for output in cell.outputs]
    assert not [output.text for output in outputs if output.get("name") == "stderr"]


def test_the_papers_numbers(pair: tuple[Path, nbformat.NotebookNode]) -> None:
    path, fresh = pair
    if path.stem != "01_paper_dumbbells":
        pytest.skip("another notebook")
    found = table(fresh)
    assert found["initial energy E0"] == pytest.approx(0.44066240192821, rel=1e-4)  # errata
    assert found["closest approach: time"] == pytest.approx(9.0022, abs=2e-4)
    for run, rotation in (("(118)-(127) as printed", 2.9e-13), ("production run", 3e-15)):
        assert 2.6960e-7 <= found[f"{run}: max |E - E0|"] <= 2.6967e-7
        assert 0 < found[f"{run}: max rotation error"] <= rotation
    assert found["the same, unrounded inertias: max |E - E0|"] == pytest.approx(2.69675e-7, rel=1e-4)  # errata
    for quantity in ("max |E - E0|", "max rotation error"):
        assert 1e-3 <= found[f"Runge-Kutta: {quantity}"] <= 1e-1
    assert found["variational, step 0.005: max |E - E0|"] == pytest.approx(1.655e-4, rel=1e-3)  # errata
    assert found["variational, step 0.005: max rotation error"] < 3e-15
    assert "StepWarning: the energy was wrong" in printed(fresh)


if __name__ == "__main__":
    for notebook_path in NOTEBOOKS:
        with tempfile.TemporaryDirectory() as temporary:
            store(notebook_path, Path(temporary))
