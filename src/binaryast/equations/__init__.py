"""The eight forms of the equations of motion of Lee, Leok and McClamroch (2007), to be read beside the paper.

Continuous or discrete, in the inertial frame (any number of bodies) or the relative one (a pair), Lagrangian or
Hamiltonian: the corners of the cube in the paper's Fig. 7. Each is an object that knows its variables, turns a
`binaryast.State` into them and back by the Legendre transforms, and gives its right-hand side or its map to SciPy or to
a loop of the user's. Numbers are plain floats in SI, one flat array ``y`` for one time.

======================  ===========================================================  ==============  =================
variables               what they are                                                unit            frame
======================  ===========================================================  ==============  =================
x, v, gamma             position, velocity, m v of each body                         m, m/s, kg m/s  inertial
R (rows)                attitude of each body                                        1               body -> inertial
Omega, Pi (rows)        angular velocity, J Omega of each body                       rad/s, kg m2/s  each body's own
X, V, Gamma             position, velocity of body 1 relative to body 2, m V         m, m/s, kg m/s  body 2's
R (a matrix)            attitude of body 1                                           1               body 1 -> body 2's
Omega, Pi (vectors)     angular velocity of body 1, R J1 R^T Omega                   rad/s, kg m2/s  body 2's
Omega2, Pi2             angular velocity of body 2, J2 Omega2                        rad/s, kg m2/s  body 2's
x2, v2, gamma2          position, velocity, m2 v2 of body 2                          m, m/s, kg m/s  inertial
R2                      attitude of body 2                                           1               body 2 -> inertial
next_x, next_R, ...     the same one step later                                      as above        as above
D, D2                   increments of the position in one step                       m               of x, X, x2
g, g2                   of F J_d - J_d F^T = S(g): h times the momentum between      kg m2           of Pi, Pi2
======================  ===========================================================  ==============  =================

Body 2 of the paper is the primary, at index 0. D of the relative frame is F2_k X_{k+1} - X_k.

They are the reference that the production steps are held to, in the paper's own matrices and plain sums. Each form is
compiled when it is first used, once on a machine, which takes some seconds. For long runs there is
`binaryast.propagate`.
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
        Of the Lagrangian form, the same map in sums of differences, which keep digits: D = x_{k+1} - x_k (in the
        relative frame F2_k X_{k+1} - X_k, and D2 for x2) stands for the next position, and g of
        S(g) = F J_d - J_d F^T for F.

    Returns
    -------
    DiscreteEquations
        (78)-(80), (93)-(97), (112)-(117) or (118)-(127).

    Raises
    ------
    InputError
        For another frame or form, the relative frame of more than two bodies, or ``summed`` in the Hamiltonian form.
    StepError
        By ``from_state`` of the Lagrangian form and by ``advance``, where a body would turn too far in one step.

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
