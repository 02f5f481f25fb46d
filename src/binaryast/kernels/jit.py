"""The one decorator that compiles a kernel, the folder of its cache, and the signatures of function pointers.

A kernel is either a helper, compiled into whatever calls it (``@jit``), or an entry point with an explicit
signature (``@jit(SIGNATURE)``), compiled once and kept on disk. numba's own cache does not notice when a function in
*another* file changes; so the folder is named by a hash of all kernel sources, and an old number cannot come back.
"""

import contextlib
import functools
import hashlib
import logging
import os
import shutil
import sys
import tempfile
import threading
import time
import warnings
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import numba
import numpy as np
from numba import types
from numpy.typing import NDArray

Function = TypeVar("Function", bound=Callable[..., Any])
Array: TypeAlias = NDArray[np.floating[Any]]
Indices: TypeAlias = NDArray[np.int64]
Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
Matrix: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
PairGravity: TypeAlias = tuple[float, float, float, float, float, float, float]  # U, dU/dX, M
PairPotential: TypeAlias = Callable[..., PairGravity]
Measures: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]

ARRAY = types.Array(types.float64, 1, "C")
ROWS = types.Array(types.float64, 2, "C")
BODY_MATRICES = types.Array(types.float64, 3, "C")  # one matrix for each body
PAIR_INDICES = types.Array(types.int64, 2, "C")  # one row for each pair

# U, dU/dX (3), M (3) from the parameters p, X (3) and R (9, row by row); scalars only, so that the function can be
# inlined, run in lanes or be compiled for another device.
PAIR_POTENTIAL = types.UniTuple(types.float64, 7)(ARRAY, *[types.float64] * 12)
# What is watched at every step, from (state, constants): energy, angular and linear momentum (3 each), rotation error,
# smallest separation.
MEASURE = types.UniTuple(types.float64, 9)(ARRAY, ARRAY)
# From outside, for all bodies at once: the parameters p, the time t, positions x (n, 3) and attitudes R (n, 3, 3); a
# potential adds its forces (n, 3), inertial, and torques (n, 3), in the bodies' frames, to the last two and returns U
# and dU/dt; any other force is told velocities and spins (n, 3) too.
EXTERNAL_POTENTIAL = types.UniTuple(types.float64, 2)(ARRAY, types.float64, ROWS, BODY_MATRICES, ROWS, ROWS)
FORCE = types.void(ARRAY, types.float64, ROWS, ROWS, BODY_MATRICES, ROWS, ROWS, ROWS)
# Which pair of surfaces touches, counted from 1, or 0, from (state, surfaces, state before the step).
TOUCH = types.int64(ARRAY, ARRAY, ARRAY)
# What an event watches, from (p, t, position, velocity, attitude, spin): parameters, the time since the start, and
# where the bodies are about the barycentre (n, 3), (n, 3), (n, 3, 3), (n, 3); and what fills these in, from (state,
# constants, shares of the mass, position, ..).
PLACES = (ROWS, ROWS, BODY_MATRICES, ROWS)
EVENT = types.float64(ARRAY, types.float64, *PLACES)
EVENT_POINTER = types.FunctionType(EVENT)
VIEW = types.void(ARRAY, ARRAY, ARRAY, *PLACES)
# How a system attracts: the potential of a pair, or a table of one for each pair of several bodies.
PAIR_POINTER = types.FunctionType(PAIR_POTENTIAL)
PAIR_POINTERS = types.Array(types.int64, 1, "C")


OPTIONS = {"nogil": True, "error_model": "numpy"}  # numpy: a division by zero gives inf, without a branch for each
_UNUSED_FOR = 30 * 86400.0  # seconds after which the cache of another version is removed
_numba_configuration = threading.Lock()


def source_hash() -> str:
    """Return the hash of all kernel sources, the package version and numba's, which names the cache folder."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for path in sorted(folder.rglob("*.py")):
        digest.update(path.relative_to(folder).as_posix().encode())
        digest.update(path.read_bytes())
    with contextlib.suppress(PackageNotFoundError):  # a bare source tree has no version
        digest.update(version("binaryast").encode())
    digest.update(numba.__version__.encode())
    return digest.hexdigest()[:16]


def cache_root() -> Path:
    """Return the user's folder for compiled kernels: ``$BINARYAST_CACHE_DIR``, or the platform's cache folder."""
    if chosen := os.environ.get("BINARYAST_CACHE_DIR"):
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "binaryast" / "Cache"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "binaryast"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "binaryast"


def _open_cache_folder() -> Path | None:
    """Create the cache folder of these sources; None, with one warning, where nothing can be written."""
    root = cache_root()
    folder = root / f"kernels-{source_hash()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        os.utime(folder)
    except OSError as error:
        warnings.warn(
            f"compiled code cannot be kept in {root} ({error}); every process will compile again. "
            "Set BINARYAST_CACHE_DIR to a folder that can be written",
            UserWarning,
            stacklevel=2,
        )
        return None
    for other in root.glob("kernels-*"):
        if other != folder and time.time() - other.stat().st_mtime > _UNUSED_FOR:
            shutil.rmtree(other, ignore_errors=True)
    return folder


CACHE_FOLDER = _open_cache_folder()


def is_cold() -> bool:
    """Whether nothing has been compiled yet by these sources on this machine."""
    return CACHE_FOLDER is None or next(CACHE_FOLDER.rglob("*.nbi"), None) is None


if is_cold():
    logging.getLogger("binaryast").warning("binaryast: compiling, once on this machine; this takes some ten seconds")


def jit(signature: Any = None, *, allocates: bool = False, **options: Any) -> Callable[[Function], Function]:
    """Compile a kernel; with a signature it is an entry point, compiled at once and kept in the cache folder.

    Parameters
    ----------
    signature : numba signature, optional
        Explicit types. Without one the function is a helper, compiled into its callers.
    allocates : bool
        Whether the function may make arrays. Where it may not, numba's reference counting is left out altogether: the
        compiler then refuses an allocation, and passing an array to a helper costs nothing.
    **options
        Passed to `numba.njit`, such as ``fastmath``.
    """
    options = OPTIONS | {"_nrt": allocates} | options
    if signature is None:
        return numba.njit(forceinline=not allocates, **options)  # type: ignore[no-any-return]

    def decorate(function: Function) -> Function:
        with _numba_configuration:  # numba reads its folder where the function is decorated: lend it ours meanwhile
            previous = numba.config.CACHE_DIR
            numba.config.CACHE_DIR = str(CACHE_FOLDER or previous)
            try:
                return numba.njit(  # type: ignore[no-any-return]
                    signature, cache=CACHE_FOLDER is not None, **options
                )(function)
            finally:
                numba.config.CACHE_DIR = previous

    return decorate


def deferred(signature: Any, **options: Any) -> Callable[[Function], Callable[[], Function]]:
    """Compile a kernel when it is first asked for; what this decorates returns the compiled function."""

    def decorate(function: Function) -> Callable[[], Function]:
        return functools.cache(lambda: jit(signature, **options)(function))

    return decorate


def reference(signature: Any) -> Callable[[Function], Function]:
    """Compile a kernel that may make arrays when it is first called, for each of these takes seconds; kept as others.

    It is for the equations as printed, of which a user needs one or two: it can be called from Python only.
    """

    def decorate(function: Function) -> Function:
        compiled = deferred(signature, allocates=True)(function)

        @functools.wraps(function)
        def call(*arguments: Any) -> Any:
            return compiled()(*arguments)

        return call  # type: ignore[return-value]

    return decorate


def compile_for_user(function: Function, signature: Any) -> Function:
    """Compile a user's function with a signature of ours; it is not kept on disk."""
    return numba.njit(signature, **OPTIONS)(function)  # type: ignore[no-any-return]
