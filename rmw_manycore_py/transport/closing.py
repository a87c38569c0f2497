# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What members, publishers and subscriptions have in common: `with` closes them."""

from __future__ import annotations

from abc import ABC, abstractmethod

from typing_extensions import Self


class Closing(ABC):
    """Closed at the end of its `with`."""

    @abstractmethod
    def close(self) -> None:
        """Release its resources."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
