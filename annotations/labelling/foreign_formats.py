"""Utterances out of the files of other programs: Rasa, snips, subtitles, CoNLL, Kaldi. Each is linear in its length.

What has no utterances that can be told apart is refused by its name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

from annotations.language.texts import LanguageError, Position


class Said(NamedTuple):
    """An utterance, the line where it begins, and its logical form where the file has one."""

    line: int
    text: str
    form: str = ""


FORM_NAMES = ("logical_form", "form", "parse", "lambda", "semantics")
MOST_SAMPLED = 400  # lines by which a format is recognised
MOST_LEVELS = 8  # of JSON that are looked into

_OF_RASA = re.compile(r"\[([^\[\]\n]*)\](?:\([^()\n]*\)|\{[^{}\n]*\})")  # [cup](object)
_OF_SNIPS = re.compile(r"\[[^\[\]\n]*\]\(([^()\n]*)\)")  # [object:thing](cup)
_INTENT = re.compile(r"\s*##\s*intent:\s*\S", re.IGNORECASE)
_RASA_KEY = re.compile(
    r"\s*(?:-\s+)?(intent|synonym|regex|lookup|examples|text|utterances|metadata)\s*:(.*)"
)
_TIMING = re.compile(r"\s*(?:\d+:)?\d\d:\d\d[.,]\d{3}\s*-->\s*(?:\d+:)?\d\d:\d\d[.,]\d{3}")
_TAG = re.compile(r"<[^<>]*>|\{\\[^{}]*\}")
_BIO = re.compile(r"O|[BIESLU]-\S+")
_UTTERANCE_ID = re.compile(r"(?=\S*\d)(?=\S*[_-])[\w.-]+")
_RECORDING = re.compile(r"\s\S*(?:/|\.(?:wav|flac|mp3|sph)\b)")
_BRAT = re.compile(r"(?:T\d+\t\S+ \d+ \d+(?:;\d+ \d+)*\t|[REAMN]\d+\t|#\d+\t|\*\t)")
_BRAT_SPAN = re.compile(r"(T\d+)\t\S+ (\d{1,9}) (\d{1,9})\t")
_BRAT_NOTE = re.compile(r"#\d+\tAnnotatorNotes (T\d+)\t(.*)")
_YAML_KEY = re.compile(r"\s*(?:- )?[\w.-]+:(?:\s|$)")


def take_utterances(text: str, source: str) -> list[Said] | None:
    """Return the utterances of a file of another program; None where ``text`` is of no format that is known here.

    Raises:
        LanguageError: it is of a format without utterances, or without any that can be told apart.
    """
    lines = text.split("\n")
    sample = [line for line in lines[:MOST_SAMPLED] if line.strip()]
    for kind, (is_of, take, hint) in _KINDS.items():
        if is_of(sample):
            said = [each for each in take(lines) if each.text.strip()]
            if not said:
                raise LanguageError(f"this is {kind}, without utterances", Position(source), hint)
            return said
    return None


def join_fragments(value: Any) -> list[str]:
    """Return the utterances of a data set of snips, the fragments of each ``data`` joined; none of other JSON."""
    found: list[str] = []
    inside = [value]
    for _ in range(MOST_LEVELS):
        below: list[Any] = []
        for item in inside:
            data = item.get("data") if isinstance(item, dict) else None
            if isinstance(data, list) and data and all(map(_is_fragment, data)):
                found.append("".join(each["text"] for each in data))
            elif isinstance(item, dict | list):
                below.extend(item.values() if isinstance(item, dict) else item)
        inside = below
    return found


def form_of_task(item: Any) -> str:
    """Return the logical form that the last annotation of a task of Label Studio has; empty without one."""
    annotations = item.get("annotations") if isinstance(item, dict) else None
    for annotation in reversed(annotations if isinstance(annotations, list) else []):
        if isinstance(annotation, dict) and not annotation.get("was_cancelled"):
            results = annotation.get("result")
            for result in results if isinstance(results, list) else []:
                match result:
                    case {"from_name": str(name), "value": {"text": [str(form), *_]}}:
                        if name in FORM_NAMES:
                            return form
            return ""
    return ""


def join_brat(files: Mapping[str, str]) -> list[Said]:
    """Return the lines of the texts of a brat collection, path → content; forms are notes of what spans a line."""
    said: list[Said] = []
    for path, standoff in sorted(files.items()):
        text = files.get(f"{path.removesuffix('.ann')}.txt") if path.endswith(".ann") else None
        if text is not None:
            forms = _forms_by_span(standoff)
            at = 0
            for number, line in enumerate(text.split("\n"), start=1):
                said.append(Said(number, line, forms.get((at, at + len(line)), "")))
                at += len(line) + 1
    return said


def _forms_by_span(standoff: str) -> dict[tuple[int, int], str]:
    spans: dict[str, tuple[int, int]] = {}
    notes: list[tuple[str, str]] = []
    for line in standoff.split("\n"):
        if found := _BRAT_SPAN.match(line):
            spans[found[1]] = int(found[2]), int(found[3])
        elif found := _BRAT_NOTE.match(line):
            notes.append((found[1], found[2]))
    return {spans[about]: note for about, note in notes if about in spans}


def _is_fragment(value: Any) -> bool:
    return isinstance(value, dict) and isinstance(value.get("text"), str) and len(value) <= 5


def _is_rasa(sample: Sequence[str]) -> bool:
    return any(re.match(r"nlu:\s*$|-\s+intent:\s*\S", line) for line in sample)


def _is_snips(sample: Sequence[str]) -> bool:
    return any(re.match(r"type:\s*intent\s*$", line) for line in sample)


def _is_rasa_markdown(sample: Sequence[str]) -> bool:
    return any(map(_INTENT.match, sample))


def _is_subtitles(sample: Sequence[str]) -> bool:
    return any(map(_TIMING.match, sample[:60]))


def _is_conll(sample: Sequence[str]) -> bool:
    if sample and sample[0].startswith("# global.columns ="):  # CoNLL-U Plus
        return True
    rows = [line.split("\t") for line in sample if line[:1] != "#"]
    if rows and all(len(row) == 10 and row[0][:1].isdigit() for row in rows):
        return True
    cells = [line.split() for line in sample if not line.startswith(("#", "-DOCSTART-"))]
    tagged = sum(len(row) > 1 and bool(_BIO.fullmatch(row[-1])) for row in cells)
    return len(cells) > 1 and tagged == len(cells)


def _is_kaldi(sample: Sequence[str]) -> bool:
    ids = [line.split(maxsplit=1)[0] for line in sample]
    is_plain = not any("\t" in line or "," in ids[n] for n, line in enumerate(sample))
    return is_plain and len(set(ids)) == len(ids) > 1 and all(map(_UTTERANCE_ID.fullmatch, ids))


def _is_brat(sample: Sequence[str]) -> bool:
    return bool(sample) and all(map(_BRAT.match, sample))


def _is_text_grid(sample: Sequence[str]) -> bool:
    return any(line.startswith('File type = "ooTextFile"') for line in sample[:3])


def _is_yaml(sample: Sequence[str]) -> bool:
    keys = sum(bool(_YAML_KEY.match(line)) for line in sample)
    nested = sum(
        above.rstrip().endswith((":", ": |", ": >")) and below[:1] in " -"
        for above, below in pairwise(sample)
    )
    begins = bool(sample) and sample[0].startswith(("---", "%YAML", "version:"))
    return keys > 1 and nested > 0 and (begins or 2 * keys >= len(sample))


def _of_yaml(marks: re.Pattern[str], lines: Sequence[str]) -> Iterator[Said]:
    """Yield the examples of intents, as Rasa and snips write them; those of synonyms, patterns and lists stay out."""
    is_intent, within, waits = False, -1, False
    for number, line in enumerate(lines, start=1):
        indent = len(line) - len(line.lstrip())
        key = _RASA_KEY.match(line)
        item = re.match(r"\s*-\s+(.*)", line)
        if waits and line.strip():  # the text below "- text: |"
            waits = False
            yield Said(number, _plain(line, marks))
        elif key and key[1] in ("intent", "synonym", "regex", "lookup"):
            is_intent, within = key[1] == "intent", -1
        elif key and key[1] in ("examples", "utterances"):
            is_intent, within = is_intent or key[1] == "utterances", indent
        elif within >= 0 and key and key[1] == "text":
            waits = key[2].strip() in ("|", ">", "|-", ">-")
            if is_intent and not waits:
                yield Said(number, _plain(key[2], marks))
        elif within >= 0 and item and is_intent and not key:
            yield Said(number, _plain(item[1], marks))
        elif line.strip() and not item and indent <= within:
            within = -1


def _of_markdown(lines: Sequence[str]) -> Iterator[Said]:
    is_intent = False
    for number, line in enumerate(lines, start=1):
        if line.lstrip().startswith("#"):
            is_intent = bool(_INTENT.match(line))
        elif is_intent and (item := re.match(r"\s*[-*+]\s+(.*)", line)):
            yield Said(number, _plain(item[1].partition("<!--")[0], _OF_RASA))


def _plain(text: str, marks: re.Pattern[str]) -> str:
    """Return an example without the marks of its entities."""
    text = marks.sub(r"\1", text.strip())
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    return text[1:-1] if is_quoted else text


def _of_subtitles(lines: Sequence[str]) -> Iterator[Said]:
    begins, said = 0, list[str]()
    for number, line in enumerate([*lines, ""], start=1):
        if _TIMING.match(line):
            begins, said = number + 1, []
        elif begins and line.strip():
            said.append(_TAG.sub("", line).strip().removeprefix("- "))
        elif begins:
            yield Said(begins, " ".join(said))
            begins = 0


def _of_conll(lines: Sequence[str]) -> Iterator[Said]:
    begins, words, whole, form = 0, list[str](), "", ""
    for number, line in enumerate([*lines, ""], start=1):
        if line.startswith(("#", "-DOCSTART-")):
            whole = line.partition("# text = ")[2] or whole
            form = line.partition("# logical_form = ")[2] or form
        elif line.strip():
            cells = line.split("\t") if "\t" in line else line.split()
            is_numbered = len(cells) > 2 and cells[0].replace("-", "").replace(".", "").isdigit()
            begins = begins or number
            if cells[0].isdigit() or not is_numbered:  # else a range such as 3-4, or an empty node
                words.append(cells[1] if is_numbered else cells[0])
        elif begins:
            yield Said(begins, whole or " ".join(words), form)
            begins, words, whole, form = 0, [], "", ""


def _of_kaldi(lines: Sequence[str]) -> Iterator[Said]:
    told = [line.split(maxsplit=1)[1:] for line in lines]
    is_list = all(
        len(each[0].split()) == 1 and _UTTERANCE_ID.fullmatch(each[0].strip())
        for each in told
        if each
    )
    if is_list or any(_RECORDING.search(line) for line in lines[:MOST_SAMPLED]):
        return
    yield from (Said(number, each[0]) for number, each in enumerate(told, start=1) if each)


def _nothing(lines: Sequence[str]) -> Iterator[Said]:
    return iter(())


_RASA_HINT = "send the file with the examples of intents (nlu.yml)"
_KINDS: dict[
    str, tuple[Callable[[Sequence[str]], bool], Callable[[Sequence[str]], Iterator[Said]], str]
] = {
    "training data of Rasa (YAML)": (_is_rasa, partial(_of_yaml, _OF_RASA), _RASA_HINT),
    "training data of snips (YAML)": (
        _is_snips,
        partial(_of_yaml, _OF_SNIPS),
        "send the file with its utterances",
    ),
    "training data of Rasa (Markdown)": (_is_rasa_markdown, _of_markdown, _RASA_HINT),
    "a file of subtitles (SubRip or WebVTT)": (_is_subtitles, _of_subtitles, "send the transcript"),
    "a CoNLL file": (_is_conll, _of_conll, "send its sentences as plain text"),
    "a brat file of annotations": (_is_brat, _nothing, "pack it with the .txt file beside it"),
    "a TextGrid of Praat": (_is_text_grid, _nothing, "export its intervals as a table"),
    "a list of Kaldi": (_is_kaldi, _of_kaldi, "send the file text, which has the transcripts"),
    "YAML": (_is_yaml, _nothing, "send the texts as plain text, one a line, or as CSV"),
}
