"""Write docs/reference/problems.md from the code: python -m tests.problem_page

Every code of a refusal stands beside the sentence that says it, in the source. What a sentence fills in is "…" here.
"""

from __future__ import annotations

import ast
import importlib
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from http import HTTPStatus
from pathlib import Path

from rest_framework import exceptions

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/reference/problems.md"
MOST_SENTENCES = 3
# Rooms that answer on a terminal alone.
TERMINAL = re.compile(r"/(?:management|migrations|benchmarking|backup)/")
# Calls that have a sentence, a code and a status, at these places; names of parameters otherwise.
CALLS = {
    "Refusal": (0, 1, 2),
    "NotServed": (1, 2, 0),
    "refuse": (3, 4, 1),
    "_answer": (2, 0, 1),
    "TooManyCombinations": (0, None, None),
}
# What stands in every module that has such a call, or a class with a code: the others need not be parsed.
SAYS_SO = re.compile(rf"\b(?:{'|'.join(CALLS)})\(|^ +(?:default_)?code\b", re.MULTILINE)
OF_THE_FRAMEWORK = (
    *(exceptions.ParseError, exceptions.AuthenticationFailed, exceptions.NotAuthenticated),
    *(exceptions.PermissionDenied, exceptions.NotFound, exceptions.MethodNotAllowed),
    *(exceptions.NotAcceptable, exceptions.UnsupportedMediaType, exceptions.Throttled),
)
# Codes whose sentences are made elsewhere.
SAID = {
    "not_valid": "What was sent has problems. `problems` names each with its field or its place.",
    "row_refused": "What was sent does not fit what is stored by now. `detail` says why.",
    "bad_rows": "Rows of the file cannot be read. `problems` names each with its line.",
    "entity_refused": "The entity that was offered does not fit the world. `detail` says why.",
    "is_there_already": "Such a row is there already. `problems` names its field.",
    "in_use": "Something uses what was to be deleted. `detail` names it.",
    "no_language_model": "No language model can be asked last here. `detail` says what is missing.",
    "no_language_model_server": "No server of a language model is set up. `detail` says how to name one.",
    "no_promoted_run": "Nothing answers in this world: it has neither templates nor a promoted run.",
    "not_imported": "The file has problems, and nothing of it was stored. `problems` names each with its place.",
    "requirement_missing": "This parser needs something that is not installed here. `detail` names it.",
    "text_refused": "The text cannot be stored. `detail` says why.",
    "unreadable_texts": "No text is stored, since one cannot be. `problems` says which and why.",
    "refused": "The sentence says why. No code tells this apart from other reasons.",
}
INTRODUCTION = """# Problems

Every refusal of the REST API is a problem document (RFC 9457). Its `code` names the reason for programs. It stays when
the sentence changes. Take a code that you do not know by its `status`.

*Output of an address that has no row.*

```json
{
  "type": "/docs/reference/problems/#doc-not_found",
  "title": "Not Found",
  "status": 404,
  "code": "not_found",
  "detail": "There is no template 7 that you can see here. /api/v1/worlds/home/templates/ shows what is there."
}
```

`type` is the address of this page at the site that answered, at the heading of the code. `problems` lists each thing
that is wrong, with its `field`, or with the `file`, `line` and `column` of a text. The Python client has the code as
`error.code`.

This page is made from the code: `python -m tests.problem_page`. A sentence has “…” where it names something.
"""


@dataclass
class Code:
    """When a code arises: its sentences, and the statuses that it comes with."""

    sentences: dict[str, None] = field(default_factory=dict)
    statuses: set[int] = field(default_factory=set)


class _Module:
    """A module of the code whose refusals are read."""

    def __init__(self, path: Path, source: str) -> None:
        self._name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        self.tree = ast.parse(source)

    def functions(self) -> Iterator[ast.AST]:
        """Yield the functions, and the module for what stands outside of them."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.FunctionDef):
                yield node
        yield ast.Module(
            [each for each in self.tree.body if not isinstance(each, ast.FunctionDef)], []
        )

    def texts(self, node: ast.expr | None, around: ast.AST) -> Iterator[str]:
        """Yield what an expression may say; nothing where that is not written here."""
        match node:
            case ast.Constant(value=str(text)):
                yield text
            case ast.JoinedStr(values=values):
                parts = (
                    str(each.value) if isinstance(each, ast.Constant) else "…" for each in values
                )
                yield "".join(parts)
            case ast.BinOp(left=left, right=right):
                for first in self.texts(left, around):
                    yield from (first + second for second in self.texts(right, around))
            case ast.IfExp(body=body, orelse=other):
                yield from (*self.texts(body, around), *self.texts(other, around))
            case ast.Name(id=name):
                assigned = sorted(
                    (
                        each.value
                        for each in ast.walk(around)
                        if isinstance(each, ast.Assign) and name in map(ast.unparse, each.targets)
                    ),
                    key=lambda each: each.lineno,
                )
                before = [each for each in assigned if each.lineno < node.lineno]
                for each in before[-1:]:  # the nearest above
                    yield from self.texts(each, ast.Module([], []))
                if not assigned:
                    known = getattr(importlib.import_module(self._name), name, None)
                    yield from (known,) if isinstance(known, str) else ()

    def status(self, node: ast.expr | None) -> int | None:
        try:
            namespace = vars(importlib.import_module(self._name))
            return int(eval(ast.unparse(node), dict(namespace))) if node else None
        except (NameError, TypeError, AttributeError):
            return None


@cache
def read_codes() -> dict[str, Code]:
    """Return what the code says of each of its codes. It takes seconds."""
    codes: defaultdict[str, Code] = defaultdict(Code)
    for app in ("annotations", "parser_service", "gpsr_site"):
        for path in sorted((ROOT / app).rglob("*.py")):
            source = path.read_text(encoding="utf-8")
            if SAYS_SO.search(source) and not TERMINAL.search(path.as_posix()):
                _read_module(_Module(path, source), codes)
    for each in OF_THE_FRAMEWORK:
        code = codes[each.default_code]
        said = str(each.default_detail).replace("{method}", "…").replace("{media_type}", "…")
        code.statuses.add(each.status_code)
        if not code.sentences:
            code.sentences[said] = None
    for name, said in SAID.items():
        codes[name].sentences = {said: None}
    codes["not_imported"].statuses = {HTTPStatus.UNPROCESSABLE_ENTITY}  # its call names a variable
    return dict(sorted(codes.items()))


def _read_module(module: _Module, codes: defaultdict[str, Code]) -> None:
    for node in ast.walk(module.tree):
        if isinstance(node, ast.ClassDef):
            _read_class(module, node, codes)
    for function in module.functions():
        for node in ast.walk(function):
            if isinstance(node, ast.Call):
                _read_call(module, node, function, codes)


def _read_class(module: _Module, node: ast.ClassDef, codes: defaultdict[str, Code]) -> None:
    values = {
        ast.unparse(getattr(each, "targets", [getattr(each, "target", None)])[0]): each.value
        for each in node.body
        if isinstance(each, ast.Assign | ast.AnnAssign) and each.value
    }
    named = values.get("code") or values.get("default_code")
    if not (
        isinstance(named, ast.Constant)
        and isinstance(named.value, str)
        and (ast.get_docstring(node))
    ):
        return
    if not any(
        re.search("Refusal|LanguageError|APIException|ValueError", ast.unparse(base))
        for base in node.bases
    ):
        return
    code = codes[named.value]
    code.sentences[(ast.get_docstring(node) or "").partition("\n\n")[0].replace("\n", " ")] = None
    status = values.get("status") or values.get("status_code")
    code.statuses.add(module.status(status) or HTTPStatus.BAD_REQUEST)


def _read_call(
    module: _Module, call: ast.Call, around: ast.AST, codes: defaultdict[str, Code]
) -> None:
    places = CALLS.get(ast.unparse(call.func).rpartition(".")[2])
    if places is None:
        return
    named = {each.arg: each.value for each in call.keywords}

    def argument(number: int, name: str) -> ast.expr | None:
        place = places[number]
        return named.get(name) or (
            call.args[place] if place is not None and place < len(call.args) else None
        )

    status = argument(2, "status")
    for name in module.texts(argument(1, "code"), around):
        if not re.fullmatch("[a-z0-9_]+", name):
            continue
        code = codes[name]
        found = module.status(status) if status else HTTPStatus.BAD_REQUEST
        code.statuses |= {int(found)} if found else set()
        for text in module.texts(argument(0, "message"), around):
            code.sentences[" ".join(re.sub("…(?:[ ,;]*…)+", "…", text).split())] = None


def print_page(codes: dict[str, Code]) -> str:
    parts = [INTRODUCTION]
    for name, code in codes.items():
        statuses = ", ".join(map(str, sorted(code.statuses))) or "400"
        sentences = [each for each in code.sentences if each.strip("… .")][:MOST_SENTENCES]
        said = "\n\n".join(_escape(each) for each in sentences)
        parts.append(f"## {name}\n\n*{statuses}* {said}\n")
    return "\n".join(parts)


def _escape(sentence: str) -> str:
    sentence = sentence if "`" in sentence else re.sub(r"([<>*_|\[\]\\])", r"\\\1", sentence)
    sentence = sentence[:1].upper() + sentence[1:]
    return sentence if sentence.endswith((".", "?", "!", "…", ":", "”")) else f"{sentence}."


def main() -> None:
    import os

    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    PAGE.write_text(print_page(read_codes()), encoding="utf-8")


if __name__ == "__main__":
    main()
