"""Where bodies are, in the arrays that events are given: (n, 3, 3) and (n, 3)."""

from binaryast.kernels.jit import Array, Matrix, Vector, jit


@jit()
def put_body(
    attitude: Array, spin: Array, body: int, r: Matrix, momentum: Vector, constants: Array, inverse: int
) -> None:
    """Put a body's attitude, and its spin from its angular momentum and the 1/I of its axes."""
    for i in range(3):
        spin[body, i] = momentum[i] * constants[inverse + i]
        for j in range(3):
            attitude[body, i, j] = r[3 * i + j]


@jit()
def apart(a: Array, one: int, two: int) -> Vector:
    """Return the row of one body less that of another."""
    return a[one, 0] - a[two, 0], a[one, 1] - a[two, 1], a[one, 2] - a[two, 2]


@jit()
def matrix_of(attitude: Array, body: int) -> Matrix:
    """Return the nine elements of a body's attitude."""
    return (
        attitude[body, 0, 0],
        attitude[body, 0, 1],
        attitude[body, 0, 2],
        attitude[body, 1, 0],
        attitude[body, 1, 1],
        attitude[body, 1, 2],
        attitude[body, 2, 0],
        attitude[body, 2, 1],
        attitude[body, 2, 2],
    )
