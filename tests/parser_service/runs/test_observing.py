"""How often a run keeps its state."""

from __future__ import annotations

import pytest

from parser_service.runs import observing
from parser_service.runs.observing import RunObserver
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import claimed


class Held:
    """The lease of a run, as far as its checkpoints need one."""

    def __init__(self, run):
        self.work = run

    def check(self):
        pass


@pytest.fixture
def clock(monkeypatch):
    class Clock:
        now = 100.0

        def monotonic(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(observing, "time", clock)
    return clock


@pytest.fixture
def observe(world, transactional_db, clock):
    return RunObserver(Held(claimed(make_split(world))))


def write(folder):
    (folder / "state").write_text("kept")


def test_a_checkpoint_is_due_twenty_seconds_after_the_last(observe, clock):
    assert not observe.is_checkpoint_due()
    clock.now += 20
    assert observe.is_checkpoint_due()
    observe.checkpoint(1, True, write)
    assert not observe.is_checkpoint_due()
    clock.now += 19
    assert not observe.is_checkpoint_due()


def test_where_the_disk_is_slow_a_tenth_of_the_time_is_spent_on_writing(observe, clock):
    def write_slowly(folder):
        write(folder)
        clock.now += 7

    observe.checkpoint(1, True, write_slowly)
    clock.now += 69
    assert not observe.is_checkpoint_due()
    clock.now += 1
    assert observe.is_checkpoint_due()


def test_several_checkpoints_of_one_epoch_replace_each_other(observe):
    folders = []
    for _ in range(3):
        observe.checkpoint(0, True, write)
        folders.append(observe.last_checkpoint())
    assert len(set(folders)) == 3
    assert [folder.exists() for folder in folders] == [False, False, True]
    assert observe.run.checkpoints.count() == 1
