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

    @property
    def steps(self) -> str:
        """Of its steps: walks that differ in mount and rate alone have the same (`Plan.steps`)."""


T = TypeVar("T", bound=OnWalk)


@dataclass(frozen=True)
class Job(Generic[T]):
    """A task, or the walk that it is the first on.

    `also` : the first tasks on walks of the same steps, which are walked at once.
    """

    task: T
    walks: bool = False
    also: tuple[T, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """Of the walks."""
        return (self.task.walk, *(one.walk for one in self.also))


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
        """A task that can be done now, or else the next walk, with those of the same steps."""
        if self._ready:
            return Job(self._ready.popleft())
        first, *others = (self._waiting[key][0] for key in self._to_walk)
        also = tuple(one for one in others if one.steps == first.steps)
        self._to_walk = deque(one.walk for one in others if one.steps != first.steps)
        return Job(first, walks=True, also=also)

    def walked(self, key: str) -> None:
        """A walk is there: its tasks can be done."""
        self._ready.extend(self._waiting.pop(key))

    def fell(self, key: str) -> list[T]:
        """A walk came to no end: the tasks on it."""
        return self._waiting.pop(key)
