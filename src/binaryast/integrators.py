"""How a motion is stepped: each integrator is a frozen value that says what it can do, and names its compiled step."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.units import brief, quantity, to_si
from binaryast.values import Value


class Integrator(Value, ABC):
    """What every integrator declares.

    Attributes
    ----------
    step : Quantity
        The largest step that the run may use [s].
    order : int
        Order of the error in the step.
    symplectic, reversible, adaptive : bool
        Its properties.
    """

    step: Quantity
    order: int
    symplectic: ClassVar[bool]
    reversible: ClassVar[bool]
    adaptive: ClassVar[bool]

    @property
    @abstractmethod
    def kernel(self) -> Callable[..., Any]:
        """The compiled step of a pair."""

    @property
    @abstractmethod
    def largest_turn(self) -> float:
        """The turn h Omega [rad] at and above which a step has no solution."""


@dataclass(frozen=True, eq=False)
class LGVI(Integrator):
    """The Lie group variational integrator: equations (118)-(127) of Lee, Leok and McClamroch (2007).

    Symplectic, momentum-preserving, reversible, and on SE(3) by construction; its energy error stays bounded. Its
    attitudes run ahead by Omega t (h Omega)^2/6, which energy does not show: choose the step by the fastest spin.

    Parameters
    ----------
    step : Quantity
        The largest step h (time). A run uses the largest step below it that divides its segments. A step with
        h Omega >= 1 is refused: about a principal axis (128) then has no solution.
    order : int
        2; higher orders by composition are not in this version.

    Raises
    ------
    InputError
        For a step that is not a positive time, or another order.

    References
    ----------
    T. Lee, M. Leok, N. H. McClamroch, Lie group variational integrators for the full body problem, CMAME 196 (2007)
    2907-2924, doi:10.1016/j.cma.2007.01.017.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.LGVI(step=40 * u.s)
    LGVI(step=<Quantity 40. s>, order=2)
    """

    step: Quantity
    order: int = 2

    symplectic: ClassVar[bool] = True
    reversible: ClassVar[bool] = True
    adaptive: ClassVar[bool] = False

    def __post_init__(self) -> None:
        self._set(step=quantity(float(to_si(self.step, "s", "step", sign="positive")), "s"))
        if not isinstance(self.order, int) or self.order != 2:
            raise InputError(f"LGVI: order={brief(self.order)}: this version has order 2")

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled step of a pair."""
        from binaryast.kernels.lgvi import pair_step

        return pair_step

    @property
    def largest_turn(self) -> float:
        """The turn h Omega [rad] at and above which a step is refused: (128) says sin(theta) = h Omega."""
        return 1.0
