"""What is done first: walks before their tasks, and walks of the same steps at once."""

from dataclasses import dataclass

from footfall.scenarios.studies.queue import Queue


@dataclass(frozen=True)
class Work:
    name: str
    walk: str
    steps: str


WORK = [
    Work("a1", "a", "one"),
    Work("b", "b", "two"),
    Work("c", "c", "one"),
    Work("a2", "a", "one"),
    Work("d", "d", "one"),
]


def test_walks_of_the_same_steps_are_one_job_and_its_tasks_follow():
    queue = Queue(WORK, lambda key: key == "d")
    assert (queue.next().task.name, queue.walks) == ("d", ("a", "b", "c"))
    first = queue.next()
    assert (first.task.name, first.walks, first.keys) == ("a1", True, ("a", "c"))
    second = queue.next()
    assert (second.task.name, second.walks, second.keys) == ("b", True, ("b",))
    assert not queue
    for key in first.keys:
        queue.walked(key)
    assert [queue.next().task.name for _ in range(3)] == ["a1", "a2", "c"]
    assert not queue
    assert [one.name for one in queue.fell("b")] == ["b"]
