"""The order of work: a walk is walked before its tasks, and tasks go by walk."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar


class OnWalk(Protocol):
    """Whatever is done with a walk, by the walk's key."""

    @property
    def walk(self) -> str:
        """The key."""


T = TypeVar("T", bound=OnWalk)


@dataclass(frozen=True)
class Job(Generic[T]):
    """A task, or the walk that it is the first on."""

    task: T
    walks: bool = False


class Queue(Generic[T]):
    """What is to be done.

    Parameters
    ----------
    tasks : all of it
    walked : whether a walk is there already
    """

    def __init__(self, tasks: Sequence[T], walked: Callable[[str], bool]) -> None:
        self._waiting: dict[str, list[T]] = {}
        for task in tasks:
            self._waiting.setdefault(task.walk, []).append(task)
        self._ready: deque[T] = deque()
        self._to_walk: deque[str] = deque()
        for key in list(self._waiting):
            if walked(key):
                self.walked(key)
            else:
                self._to_walk.append(key)
        self.walks = tuple(self._to_walk)

    def __bool__(self) -> bool:
        return bool(self._ready or self._to_walk)

    def next(self) -> Job[T]:
        """A task that can be done now, or else the next walk."""
        if self._ready:
            return Job(self._ready.popleft())
        return Job(self._waiting[self._to_walk.popleft()][0], walks=True)

    def walked(self, key: str) -> None:
        """A walk is there: its tasks can be done."""
        self._ready.extend(self._waiting.pop(key))

    def fell(self, key: str) -> list[T]:
        """A walk came to no end: the tasks on it."""
        return self._waiting.pop(key)
