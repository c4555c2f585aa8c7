"""The web process is killed while people save: everything it acknowledged is there.

``TEST_KILLS`` says how often it is killed; ``docs/design/durability.md`` how often for a release.
"""

from __future__ import annotations

import json
import os
import random
from collections.abc import Callable
from http.client import HTTPException
from threading import Event, Lock, Thread

import pytest

from tests.durability.site import KillableSite
from tests.migrated import copy_installation

pytestmark = pytest.mark.processes

KILLS = int(os.environ.get("TEST_KILLS", "2"))
SAVERS, DRAFTERS = 3, 3
MOST_SAVES = 40  # acknowledged in a round before the kill
WAIT_SECONDS = 300  # for the saves of a round, on a busy machine


class Round:
    """What the server acknowledged before it was killed."""

    def __init__(self, site: KillableSite, number: int) -> None:
        self.site, self.number = site, number
        self.wanted = random.Random(number).randint(1, MOST_SAVES)
        self.saves: list[tuple[int, int, str]] = []  # template, version, pattern
        self.drafts: dict[int, int] = {}  # template → number of the draft
        self._lock, self._is_enough, self._is_over = Lock(), Event(), Event()
        self._count = 0
        query = "SELECT id, version FROM annotations_semantictemplate"
        self._versions = dict(site.read(query))

    def run(self) -> None:
        """Save from several threads, and kill the server once enough is acknowledged."""
        savers, drafters = self.site.templates[:SAVERS], self.site.templates[SAVERS:]
        threads = [Thread(target=self._until_killed, args=(self._save, pk)) for pk in savers]
        threads += [Thread(target=self._until_killed, args=(self._draft, pk)) for pk in drafters]
        self.site.start()
        for thread in threads:
            thread.start()
        is_enough = self._is_enough.wait(WAIT_SECONDS)
        self.site.kill()
        self._is_over.set()
        for thread in threads:
            thread.join()
        assert is_enough, "the server acknowledged too little"

    def _until_killed(self, action: Callable[[int, int], bool], pk: int) -> None:
        number = 0
        try:
            while not self._is_over.is_set() and action(pk, number):
                number += 1
                with self._lock:
                    self._count += 1
                    if self._count >= self.wanted:
                        self._is_enough.set()
        except (OSError, HTTPException):
            pass  # the server was killed while it answered

    def _save(self, pk: int, number: int) -> bool:
        pattern = f"round {self.number} save {number}"
        if is_saved := self.site.save_template(pk, pattern, self._versions[pk]):
            self._versions[pk] += 1
            self.saves.append((pk, self._versions[pk], pattern))
        return is_saved

    def _draft(self, pk: int, number: int) -> bool:
        if is_kept := self.site.save_draft(pk, f"round {self.number} draft {number}"):
            self.drafts[pk] = number
        return is_kept


@pytest.fixture(scope="module")
def site(migrated_database, tmp_path_factory) -> KillableSite:
    folder = copy_installation(migrated_database, tmp_path_factory.mktemp("site"))
    return KillableSite(folder, templates=SAVERS + DRAFTERS)


@pytest.mark.parametrize("number", range(KILLS))
def test_what_was_acknowledged_is_there(number, site):
    killed = Round(site, number)
    killed.run()
    assert site.read("PRAGMA integrity_check") == [("ok",)]
    history = site.read("SELECT id, version, pattern FROM annotations_historicalsemantictemplate")
    assert not set(killed.saves) - set(history)
    newest = site.read("SELECT id, version, pattern FROM annotations_semantictemplate")
    assert all(row[1] == 1 or row in history for row in newest)
    kept = dict(site.read("SELECT subject, fields FROM annotations_draft"))
    for pk, last in killed.drafts.items():
        pattern = json.loads(kept[str(pk)])["pattern"]
        prefix = f"round {number} draft "
        assert pattern.startswith(prefix)
        assert int(pattern.removeprefix(prefix)) >= last  # a later one may be kept, unacknowledged
