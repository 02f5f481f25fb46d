"""The only place that knows heyoka: it makes an integrator of formulas, which compiles them.

Constants are heyoka's parameters, which are known only at run time, except zeros, with which terms vanish: so all
systems of one kind, such as two ellipsoids at degree 4, share one compiled code. heyoka keeps it in memory and, from
version 7.10 on, in its own cache folder (on Linux ``~/.cache/heyoka``).
"""

from typing import Any

from binaryast.errors import InputError
from binaryast.taylor.motion import Formulas

NEEDED = (
    "Taylor: heyoka is not installed: expected version 7.10 or later, by pip install 'binaryast[taylor]' on Linux, "
    "elsewhere by conda install -c conda-forge heyoka.py"
)


class Constants:
    """Numbers as heyoka's parameters."""

    def __init__(self, heyoka: Any) -> None:
        self.heyoka = heyoka
        self.values: list[float] = []

    def __call__(self, value: float) -> Any:
        """Return what stands for a constant: a parameter, or zero itself."""
        if value == 0.0:
            return 0.0
        self.values.append(value)
        return self.heyoka.par[len(self.values) - 1]


def heyoka() -> Any:
    """Return the module.

    Raises
    ------
    InputError
        Where it is not installed.
    """
    try:
        import heyoka
    except ImportError:
        raise InputError(NEEDED) from None
    return heyoka


def integrator(formulas: Formulas, tolerance: float, *, compact: bool) -> Any:
    """Return heyoka's integrator of a motion, at its start; sums of a step keep what rounding takes from them."""
    hy = heyoka()
    variables = [hy.expression(f"y{k}") for k in range(len(formulas.start))]
    constants = Constants(hy)
    rates = [0.0 * variables[0] + rate for rate in formulas.rates(variables, constants)]  # also a number: an expression
    return hy.taylor_adaptive(
        list(zip(variables, rates, strict=True)),
        formulas.start.copy(),
        pars=constants.values,
        tol=tolerance,
        compact_mode=compact,
        high_accuracy=True,
    )
