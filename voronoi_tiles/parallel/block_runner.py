"""What does blocks of work, whatever it runs on, and blocks that come to nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

Block = TypeVar("Block")
Result = TypeVar("Result")
Result_co = TypeVar("Result_co", covariant=True)


@dataclass(frozen=True, slots=True)
class LostBlock:
    """A block without a result, as its process has died: `reason` is a clause, without a full stop."""

    reason: str


class BlockRunner(Protocol[Result_co]):
    """What does blocks by their numbers; those whose process died are lost, and may be asked for again."""

    def finished(self, numbers: Sequence[int]) -> Iterator[tuple[int, Result_co | LostBlock]]:
        """The numbers with their results, as they finish."""
