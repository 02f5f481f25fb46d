"""What every input object has in common: it cannot be changed, is built only by its constructor, and pickles."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

Kind = TypeVar("Kind", bound="Value")


class Value:
    """A frozen dataclass that is made again, when it is unpickled or read from a file, from its arguments."""

    def arguments(self) -> dict[str, Any]:
        """Return the arguments that make this object again."""
        return {field.name: getattr(self, field.name) for field in fields(self) if field.init}  # type: ignore[arg-type]

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return rebuild, (type(self), self.arguments())

    def _set(self, **attributes: Any) -> None:
        """Set attributes during construction; arrays become read-only."""
        for name, value in attributes.items():
            for array in value if isinstance(value, tuple) else (value,):
                if isinstance(array, np.ndarray):
                    array.flags.writeable = False
            object.__setattr__(self, name, value)


def rebuild(kind: type[Kind], arguments: dict[str, Any]) -> Kind:
    """Return ``kind(**arguments)``, which is how a `Value` is unpickled."""
    return kind(**arguments)
