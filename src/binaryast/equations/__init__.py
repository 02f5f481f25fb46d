"""The eight forms of the equations of motion of Lee, Leok and McClamroch (2007), to be read beside the paper.

Continuous or discrete, in the inertial frame (any number of bodies) or the relative one (a pair), Lagrangian or
Hamiltonian: the corners of the cube in the paper's Fig. 7. Each is an object that knows its variables, turns a
`binaryast.State` into them and back by the Legendre transforms, and gives its right-hand side or its map to SciPy or to
a loop of the user's. Numbers are plain floats in SI, one flat array ``y`` for a moment.

They are the reference that the production steps are held to, in the paper's own matrices and plain sums. For long runs
there is `binaryast.propagate`.
"""

from astropy.units import Quantity

from binaryast.equations.base import Equations, Invariants
from binaryast.equations.continuous import ContinuousEquations
from binaryast.equations.discrete import DiscreteEquations
from binaryast.system import System

__all__ = ["ContinuousEquations", "DiscreteEquations", "Equations", "Invariants", "continuous", "discrete"]


def continuous(system: System, *, frame: str = "inertial", form: str = "hamiltonian") -> ContinuousEquations:
    """Return continuous equations of motion.

    Parameters
    ----------
    system : System
        The bodies and their gravity.
    frame : {"inertial", "relative"}
        Inertial for any number of bodies, or relative for a pair, with what reconstructs the primary.
    form : {"lagrangian", "hamiltonian"}
        In velocities, or in momenta.

    Returns
    -------
    ContinuousEquations
        (25)-(28), (29)-(32), (55)-(62) or (63)-(70).

    Raises
    ------
    InputError
        For another frame or form, or the relative frame of more than two bodies.

    Examples
    --------
    >>> import binaryast as ba
    >>> from scipy.integrate import solve_ivp
    >>> system, state = ba.catalogue.load("dumbbells")
    >>> equations = ba.equations.continuous(system, frame="relative", form="hamiltonian")
    >>> equations.numbers, list(equations.variables)
    ('(63)-(70)', ['Gamma', 'Pi', 'Pi2', 'X', 'R', 'gamma2', 'x2', 'R2'])
    >>> y = equations.from_state(state)
    >>> solution = solve_ivp(equations.rhs, (0, 1), y, method="DOP853", rtol=1e-12, atol=1e-12 * equations.scales(y))
    >>> print(equations.unpack(solution.y[:, -1])["X"].round(6))
    [0.655894 0.743265 0.06779 ]
    """
    return ContinuousEquations(system, frame, form)


def discrete(
    system: System, *, step: Quantity, frame: str = "inertial", form: str = "hamiltonian", summed: bool = False
) -> DiscreteEquations:
    """Return discrete equations of motion: a Lie group variational integrator as printed.

    Parameters
    ----------
    system : System
        The bodies and their gravity.
    step : Quantity
        The step h (time).
    frame : {"inertial", "relative"}
        Inertial for any number of bodies, or relative for a pair, with what reconstructs the primary.
    form : {"lagrangian", "hamiltonian"}
        From two configurations to the next two, or from a configuration and its momenta to the next.
    summed : bool
        Of the Lagrangian form, the same map in sums of differences, which keep digits: D is the increment of the
        position from this configuration to the next, and S(g) = F J_d - J_d F^T stands for F.

    Returns
    -------
    DiscreteEquations
        (78)-(80), (93)-(97), (112)-(117) or (118)-(127).

    Raises
    ------
    InputError
        For another frame or form, the relative frame of more than two bodies, or ``summed`` in the Hamiltonian form.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("dumbbells")
    >>> equations = ba.equations.discrete(system, step=2e-4 * u.s, frame="relative", form="lagrangian")
    >>> equations.numbers, list(equations.variables)
    ('(112)-(117)', ['X', 'R', 'R2', 'x2', 'next_X', 'next_R', 'next_R2', 'next_x2'])
    >>> y = equations.advance(equations.from_state(state), 5000)
    >>> print(equations.unpack(y)["X"].round(6))
    [0.655894 0.743265 0.06779 ]
    """
    return DiscreteEquations(system, step, frame, form, summed)
