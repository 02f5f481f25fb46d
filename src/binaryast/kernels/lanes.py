"""What a formula that is written once for numbers of any kind asks of them, besides arithmetic."""

from typing import Any, Protocol, TypeAlias

Number: TypeAlias = Any  # a float, a symbol or an array; or a pair of them, side by side


class Lanes(Protocol):
    """What a kind of numbers must offer."""

    def sqrt(self, a: Number) -> Number:
        """Return the square root."""

    def pair(self, one: Number, two: Number) -> Number:
        """Return two numbers side by side."""

    def first(self, pair: Number) -> Number:
        """Return the first of a pair."""

    def second(self, pair: Number) -> Number:
        """Return the second of a pair."""

    def swapped(self, pair: Number) -> Number:
        """Return a pair the other way round."""

    def where_larger(self, a: Number, b: Number, one: Number, two: Number) -> Number:
        """Return ``one`` where a > b, ``two`` elsewhere."""
