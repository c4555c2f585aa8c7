"""Utterances with their labels as other programs take them: doccano, Label Studio, CoNLL-U Plus, brat.

Each holds the text, which words name an entity of which class, and the logical form. Positions count characters.
"""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from tempfile import TemporaryFile
from typing import Any

from annotations.exchange.pipe import Pipe
from annotations.exchange.tables import text_pieces
from annotations.models import Utterance
from annotations.rows.synchronise import batches

FORM = "logical_form"  # how each format calls it
_CHUNK = 1_000  # utterances written at once
_WORD_OR_SIGN = re.compile(r"\w+|[^\w\s]")


class LabelFormat(StrEnum):
    DOCCANO = "doccano"
    LABEL_STUDIO = "label-studio"
    CONLL = "conll"
    BRAT = "brat"


@dataclass(frozen=True, slots=True)
class LabelFile:
    """The end of a file's name, and what writes utterances of a world with ``classes``."""

    suffix: str
    write: Callable[[Iterable[Utterance], Sequence[str]], Iterator[bytes]]


def write_doccano(rows: Iterable[Utterance], classes: Sequence[str]) -> Iterator[bytes]:
    """Return JSON Lines for a project of sequence labelling, which keeps other fields as metadata."""
    return text_pieces(
        _line(
            {
                "id": row.pk,
                "text": row.text,
                "label": [[start, end, token] for start, end, token, _ in row.spans],
                FORM: row.logical_form,
                "status": row.status,
            }
        )
        for row in rows
    )


def write_label_studio(rows: Iterable[Utterance], classes: Sequence[str]) -> Iterator[bytes]:
    """Return a JSON list of tasks: annotations where somebody gave a form, predictions elsewhere."""
    yield b"["
    for n, some in enumerate(batches(rows, _CHUNK)):
        yield (",\n" if n else "\n").encode() + ",\n".join(map(_task, some)).encode()
    yield b"\n]\n"


def _task(row: Utterance) -> str:
    result: list[dict[str, Any]] = [
        {
            **{"id": f"{row.pk}-{start}", "from_name": "entity", "to_name": "text"},
            "type": "labels",
            "value": {
                "start": start,
                "end": end,
                "text": row.text[start:end],
                "labels": [token],
            },
        }
        for start, end, token, _ in row.spans
    ]
    if row.logical_form:
        form = {"type": "textarea", "value": {"text": [row.logical_form]}}
        result.append({"id": f"{row.pk}-form", "from_name": FORM, "to_name": "text"} | form)
    kind = "annotations" if row.logical_form else "predictions"
    return _line({"data": {"text": row.text, "number": row.pk}, kind: [{"result": result}]})[:-1]


def write_conll(rows: Iterable[Utterance], classes: Sequence[str]) -> Iterator[bytes]:
    """Return CoNLL-U Plus: a token a line with its number and its tag of IOB2, texts and forms as comments.

    The number keeps a token ``#`` from being a comment.
    """
    yield b"# global.columns = ID FORM NER\n"
    yield from text_pieces(map(_sentence, rows))


def _sentence(row: Utterance) -> str:
    head = {"sent_id": row.pk, "text": row.text, FORM: row.logical_form}
    comments = "".join(f"# {name} = {value}\n" for name, value in head.items() if value)
    tokens = "".join(
        f"{n}\t{word}\t{tag}\n" for n, (word, tag) in enumerate(tagged_words(row), start=1)
    )
    return f"{comments}{tokens}\n"


def tagged_words(row: Utterance) -> Iterator[tuple[str, str]]:
    """Yield the words and signs of an utterance with their tags of IOB2. None is partly in an entity."""
    at = 0
    for start, end, token, _ in [*row.spans, [len(row.text), len(row.text), "", ""]]:
        yield from ((word, "O") for word in _WORD_OR_SIGN.findall(row.text[at:start]))
        for n, word in enumerate(_WORD_OR_SIGN.findall(row.text[start:end])):
            yield word, f"{'I' if n else 'B'}-{token}"
        at = end


def write_brat(rows: Iterable[Utterance], classes: Sequence[str]) -> Iterator[bytes]:
    """Return a zip archive with a collection: a text of an utterance a line, its annotations, and their kinds.

    An ``Utterance`` spans each line; its form is a note of it.
    """
    kinds = "\n".join(["Utterance", *classes])
    overlap = "<OVERLAP>\tArg1:<ENTITY>, Arg2:<ENTITY>, <OVL-TYPE>:<ANY>"
    target = Pipe()
    with (
        TemporaryFile() as annotations,
        zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        archive.writestr(
            "annotation.conf",
            f"[entities]\n{kinds}\n[relations]\n{overlap}\n[events]\n[attributes]\n",
        )
        with archive.open("utterances.txt", "w", force_zip64=True) as texts:
            for piece in text_pieces(_noting_standoff(rows, annotations)):
                texts.write(piece)
                yield target.take()
        annotations.seek(0)
        with archive.open("utterances.ann", "w", force_zip64=True) as file:
            while piece := annotations.read(1 << 16):
                file.write(piece)
                yield target.take()
    yield target.take()


def _noting_standoff(rows: Iterable[Utterance], annotations: Any) -> Iterator[str]:
    """Yield the lines of the texts, and write what brat says about each to ``annotations``."""
    at = n_spans = n_notes = 0
    for row in rows:
        spans = [(0, len(row.text), "Utterance")]
        spans += [(start, end, token) for start, end, token, _ in row.spans]
        for start, end, kind in spans:
            n_spans += 1
            where = f"{kind} {at + start} {at + end}"
            annotations.write(f"T{n_spans}\t{where}\t{row.text[start:end]}\n".encode())
        if row.logical_form:
            n_notes += 1
            about = f"AnnotatorNotes T{n_spans - len(spans) + 1}"
            annotations.write(f"#{n_notes}\t{about}\t{row.logical_form}\n".encode())
        yield f"{row.text}\n"
        at += len(row.text) + 1


def _line(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False) + "\n"


LABEL_FILES: dict[str, LabelFile] = {
    LabelFormat.DOCCANO: LabelFile("jsonl", write_doccano),
    LabelFormat.LABEL_STUDIO: LabelFile("json", write_label_studio),
    LabelFormat.CONLL: LabelFile("conllup", write_conll),
    LabelFormat.BRAT: LabelFile("zip", write_brat),
}
