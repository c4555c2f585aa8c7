"""The workbench of one world."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Iterable, Iterator, Mapping
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, quote, urlsplit
from uuid import uuid4

from gpsr_client.dialogue import Dialogue
from gpsr_client.errors import Away, Refused, WorkbenchError
from gpsr_client.responses import JointPlan, Parse, Plan, TaskPlan
from gpsr_client.transport import Transport


class Workbench:
    """Asks about one world of a workbench.

    Args:
        url: the address of the site, such as ``http://localhost:8000``.
        world: the name of the world, as its pages have it: ``/w/<world>/``.
        token: from the page of your account. Scope read for ``parse`` and ``export``, annotate for ``dialogue``.
        timeout: seconds until an answer has to begin.

    Every method raises ``Away`` if nobody answers, and ``Refused`` with a status and a sentence if the
    workbench refuses.
    """

    def __init__(self, url: str, world: str, token: str, timeout: float = 30.0) -> None:
        self._transport = Transport(url, token, timeout)
        self._path = f"worlds/{quote(world, safe='')}/"

    def parse(
        self,
        utterance: str = "",
        beam: int = 5,
        run: int | None = None,
        parser: str = "",
        alternatives: Iterable[tuple[str, float]] = (),
    ) -> Parse:
        """Return the answer of the world to an utterance, or that of a run or of a parser that needs none alone.

        In place of an utterance ``alternatives`` are what a recogniser may have heard, each with its score, a
        probability or the logarithm of one: the best that is understood is answered.
        """
        offered = [{"utterance": text, "score": score} for text, score in alternatives]
        body: dict[str, object] = {"beam": beam, **_asked_alone(run, parser)}
        body |= {"alternatives": offered} if offered else {"utterance": utterance}
        return Parse.from_json(self._transport.post(f"{self._path}parse/", body))

    def parse_many(
        self,
        utterances: Iterable[str],
        beam: int = 5,
        run: int | None = None,
        parser: str = "",
    ) -> Iterator[Parse]:
        """Yield the answers to many utterances, in order, as they come; all of them are asked the same parts.

        Raises WorkbenchError with a sentence of the workbench for an utterance that cannot be parsed, and
        Away if the answer ends before the last of them.
        """
        asked = [json.dumps({"utterance": each}) + "\n" for each in utterances]
        if not asked:
            return
        lines, answered = "".join(asked).encode(), 0
        path = f"{self._path}parse/"
        query = {"beam": beam, **_asked_alone(run, parser)}
        with self._transport.open("POST", path, lines, "application/jsonl", query) as response:
            try:
                for line in response:
                    value = json.loads(line)
                    if "answered" in value:
                        raise Away(_say_broken_off(answered, len(asked), value["error"]))
                    if "candidates" not in value:
                        raise WorkbenchError(str(value.get("detail", value)))
                    yield Parse.from_json(value)
                    answered += 1
            except (HTTPException, OSError, ValueError) as error:
                raise Away(_say_broken_off(answered, len(asked), str(error))) from error
        if answered < len(asked):
            raise Away(_say_broken_off(answered, len(asked)))

    def plan(self, form: str) -> Plan:
        """Return the plan of a form with entities, such as ``grounded`` of a candidate."""
        return Plan.from_json(self._transport.post(f"{self._path}plan/", {"form": form}))

    def task_plan(self, form: str) -> TaskPlan:
        """Return the plan of a form in the primitives of the robot."""
        value = self._transport.post(f"{self._path}task-plan/", {"form": form})
        return TaskPlan.from_json(value["task_plan"])

    def joint_plan(
        self,
        utterances: Iterable[str],
        distances: Mapping[tuple[str, str], float] | None = None,
        unit: str = "m",
    ) -> JointPlan:
        """Return one plan of up to three commands.

        ``distances`` are those of pairs of places, in ``unit``; ``operator`` is where the person is. Without any the
        walk counts rooms.
        """
        table = [
            {"one": one, "other": other, "distance": distance}
            for (one, other), distance in (distances or {}).items()
        ]
        body = {"utterances": list(utterances), "distances": table, "unit": unit}
        return JointPlan.from_json(self._transport.post(f"{self._path}joint-plan/", body))

    def behavior_tree(
        self,
        form: str,
        in_primitives: bool = False,
        tries: int | None = None,
        seconds: float | None = None,
    ) -> str:
        """Return the plan of a form as XML for BehaviorTree.CPP 4; of its actions, or in the robot's primitives.

        With ``tries`` or ``seconds`` the tree tries each step so often, each time so long at most, and hands a step
        that fails to the action ``step_failed``.
        """
        robust = {name: n for name, n in (("tries", tries), ("seconds", seconds)) if n is not None}
        body = json.dumps({"form": form, "as": "xml", "robust": bool(robust), **robust}).encode()
        path = f"{self._path}task-plan/" if in_primitives else f"{self._path}plan/"
        try:
            with self._transport.open("POST", path, body) as answer:
                return answer.read().decode("utf-8")
        except (HTTPException, OSError) as error:
            raise Away(f"The answer broke off: {error}") from error

    def dialogue(self, utterance: str) -> Dialogue:
        """Start a dialogue about an utterance."""
        path = f"{self._path}dialogues/"
        value = self._transport.post(path, {"utterance": utterance}, uuid4().hex)
        return Dialogue(self._transport, path, value)

    def dialogue_at(self, key: int) -> Dialogue:
        """Return a dialogue that was started earlier, to continue it."""
        path = f"{self._path}dialogues/"
        return Dialogue(self._transport, path, self._transport.get(f"{path}{int(key)}/"))

    def export(
        self,
        split: int | str,
        file: str | Path,
        format: str = "jsonl",
        part: str | None = None,
        source: str | None = None,
    ) -> Path:
        """Write the examples of a split, named or by its number, to a file and return its path.

        The file is written under another name and renamed when it is complete, so that a download that
        breaks off replaces nothing. ``format`` is one that the page of a split offers: txt, jsonl, csv, parquet, zip,
        datasets.
        ``part`` is train, validation or test; ``source`` generated or paraphrased. By default all
        examples are written.
        """
        query = {"as": format, "part": part, "source": source}
        return self._download(f"splits/{self._split(split)}/export/", query, file)

    def export_results(
        self,
        file: str | Path,
        format: str = "csv",
        part: str | None = None,
        split: str | None = None,
        measure: str | None = None,
    ) -> Path:
        """Write the figures of the results page to a file, one a row, and return its path.

        ``format`` is csv or parquet, as pandas reads them, json, or tex: the tables in LaTeX. ``part`` is validation
        or test; ``measure`` exact, equivalent, same_plan, all or well_formed. By default they are those of the page.
        """
        query = {"format": format, "part": part, "split": split, "measure": measure}
        return self._download("results/", query, file)

    def export_vocabulary(
        self, file: str | Path, format: str = "txt", only: str | None = None
    ) -> Path:
        """Write the words of the world for a speech recogniser to a file and return its path.

        ``format`` is txt, jsonl or vosk; ``only`` is names or words. By default both are written.
        """
        return self._download("vocabulary/", {"as": format, "only": only}, file)

    def export_rephrased(
        self,
        file: str | Path,
        format: str = "chat",
        split: int | str | None = None,
        part: str | None = None,
    ) -> Path:
        """Write accepted paraphrases with their plans in primitives to a file and return its path.

        ``format`` is chat, pairs or tests. With a ``split``, named or by its number, only what is in its
        ``part`` is written: train by default.
        """
        query = {"as": format, "split": self._split(split) if split else None, "part": part}
        return self._download("paraphrases/export/", query, file)

    def rows(self, path: str, **filters: object) -> Iterator[dict[str, Any]]:
        """Yield the rows of a list of the world, such as ``runs/`` or ``runs/3/predictions/``, page after page.

        ``filters`` are those of the list, such as ``outcome="wrong"``, ``sort`` and ``limit``, the rows of a page.
        """
        query: Mapping[str, object] = filters
        while True:
            page = self._transport.get(f"{self._path}{path}", **query)
            yield from page["results"]
            if not page["next"]:
                return
            query = dict(parse_qsl(urlsplit(page["next"]).query))

    def events(self, last: str = "", every: float = 5.0) -> Iterator[dict[str, Any]]:
        """Yield what ends in the world, for as long as you take: runs, jobs such as imports, campaigns.

        ``last`` is the ``event_id`` of the last one that you have; by default only what ends from now on is yielded.
        Asks every so many seconds. ``kind`` is run, job or campaign, ``address`` where to read it.
        """
        while True:
            headers = {"Last-Event-ID": last} if last else {}
            kind = ""
            try:
                with self._transport.open("GET", f"{self._path}events/", headers=headers) as answer:
                    lines = answer.read().decode("utf-8").split("\n")
            except (HTTPException, OSError) as error:
                raise Away(f"The answer broke off: {error}") from error
            for line in lines:
                field, _, value = line.partition(": ")
                if field == "event":
                    kind = value
                elif field == "id":
                    last = value
                elif field == "data":
                    yield {"kind": kind, "event_id": last, **json.loads(value)}
            time.sleep(every)

    def _split(self, split: int | str) -> int:
        """Return the number of a split, which may be named. Raises Refused if there is none of the name."""
        if not isinstance(split, str):
            return split
        rows = self._transport.get(f"{self._path}splits/", q=split, limit=1000)["results"]
        for row in rows:
            if row["name"] == split:
                return int(row["id"])
        raise Refused(404, f"This world has no split called {split!r}.", [])

    def _download(self, path: str, query: Mapping[str, object], file: str | Path) -> Path:
        """Write an answer to a file, under another name until it is complete; return its path."""
        target = Path(file)
        beside = target.with_name(f".{target.name}.part")
        try:
            with (
                self._transport.open("GET", f"{self._path}{path}", query=query) as answer,
                beside.open("wb") as out,
            ):
                shutil.copyfileobj(answer, out)
            beside.replace(target)
        except HTTPException as error:
            raise Away(f"The export broke off: {error}") from error
        finally:
            beside.unlink(missing_ok=True)
        return target


def _asked_alone(run: int | None, parser: str) -> dict[str, object]:
    named = {"run": run, "parser": parser}
    return {name: value for name, value in named.items() if value}


def _say_broken_off(answered: int, asked: int, why: str = "The connection ended.") -> str:
    return f"The answer broke off after {answered} of {asked} utterances. {why}"
