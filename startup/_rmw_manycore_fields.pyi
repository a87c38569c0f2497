from array import array
from collections.abc import Callable

class Array:
    """Stands in for `array.array` in generated message modules."""

    def __new__(
        cls,
        array_type: type[array[int]],
        convert: Callable[[str, object], array[int] | array[float] | None],
        /,
    ) -> Array: ...
    def __call__(self, typecode: str, values: object = ..., /) -> array[int]: ...
    def __instancecheck__(self, value: object) -> bool: ...
