"""The cache of compiled code: where it is, what it is named by, what happens where nothing can be written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CODE = "from binaryast.kernels import jit; print(jit.CACHE_FOLDER, jit.is_cold())"


def python(code: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ | environment
    )


def test_the_folder_is_named_by_the_sources(tmp_path: Path) -> None:
    from binaryast.kernels.jit import source_hash

    folder, cold = python(CODE, BINARYAST_CACHE_DIR=str(tmp_path)).stdout.split()
    assert Path(folder) == tmp_path / f"kernels-{source_hash()}"
    assert cold == "True"


def test_a_second_process_compiles_nothing(tmp_path: Path) -> None:
    code = (
        "from binaryast.kernels.mutual import point_mass;print(sum(point_mass.potential.stats.cache_misses.values()))"
    )
    assert python(code, BINARYAST_CACHE_DIR=str(tmp_path)).stdout.split() == ["1"]
    assert python(code, BINARYAST_CACHE_DIR=str(tmp_path)).stdout.split() == ["0"]


def test_the_users_own_numba_cache_is_left_alone() -> None:
    code = (
        "import numba; before = numba.config.CACHE_DIR; import binaryast.kernels.pair.lgvi;"
        "print(numba.config.CACHE_DIR == before)"
    )
    assert python(code).stdout.strip() == "True"


def test_without_a_folder_to_write_it_warns_once_and_works(tmp_path: Path) -> None:
    blocked = tmp_path / "a file, not a folder"
    blocked.write_text("")
    result = python(
        "from binaryast.kernels.mutual.point_mass import potential; import numpy as np;"
        "print(potential(np.array([1.0]), 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)[0])",
        BINARYAST_CACHE_DIR=str(blocked),
    )
    assert result.stdout.strip() == "-1.0"
    assert result.stderr.count("BINARYAST_CACHE_DIR") == 1


def test_a_kernel_that_may_not_allocate_is_refused_an_array() -> None:
    import numba
    import numpy as np

    from binaryast.kernels.jit import ARRAY, jit

    def allocating(x: np.ndarray) -> float:
        y = np.zeros(3)
        return y[0] + x[0]

    with pytest.raises(numba.core.errors.NumbaError):
        jit()(allocating).compile((ARRAY,))
