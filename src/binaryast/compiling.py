"""Functions of a user's, compiled to a signature of ours."""

from collections.abc import Callable
from typing import Any, TypeVar

from binaryast.errors import InputError
from binaryast.units import brief

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function, signature: Any, name: str, expected: str) -> Function:
    """Return a user's function compiled, or say in a line why it cannot be: by what decorator, and what is expected."""
    from numba.core.errors import NumbaError

    from binaryast.kernels.jit import compile_for_user

    try:
        return compile_for_user(function, signature)
    except (NumbaError, TypeError) as error:
        reason = next((line.strip() for line in str(error).splitlines()[1:] if line.strip()), brief(error))
        raise InputError(
            f"{name}: {getattr(function, '__name__', function)} cannot be compiled: {brief(reason)}; "
            f"expected {expected}"
        ) from None
