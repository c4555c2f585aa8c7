"""Refusals of the API: ``application/problem+json`` (RFC 9457)."""

from __future__ import annotations

from collections.abc import Iterator
from http import HTTPStatus
from typing import Any

from django import forms
from django.core.exceptions import ValidationError as RowRefused
from django.db import IntegrityError
from django.http import Http404
from rest_framework import exceptions, serializers
from rest_framework.response import Response

from annotations.editing.edits import Overtaken
from annotations.language.texts import LanguageError, Refusal
from annotations.rows.clashes import MADE_MEANWHILE, is_clash
from annotations.rows.stored_problems import as_json
from annotations.web.not_found import say_missing, where_to_look
from annotations.web.problems import CONTENT_TYPE, problem

# Codes of the framework that the workbench calls otherwise.
_OWN_CODES = {"invalid": "not_valid", "error": "refused"}


class ProblemItemSerializer(serializers.Serializer[Any]):
    """One thing that is wrong: in which field, or where in which file, and what to do about it."""

    field = serializers.CharField(required=False, help_text="The field of the body.")
    file = serializers.CharField(required=False, help_text="The file, or the name of the text.")
    line = serializers.IntegerField(required=False, help_text="Counted from 1.")
    column = serializers.IntegerField(required=False, help_text="The character, from 1.")
    severity = serializers.CharField(required=False, help_text="error, or warning.")
    message = serializers.CharField(help_text="What is wrong, for people.")
    hint = serializers.CharField(required=False, help_text="What to do about it.")


class ProblemSerializer(serializers.Serializer[Any]):
    """Why a request was refused. ``current`` is the row as it is now where it has changed since."""

    type = serializers.CharField(
        help_text="Where the documents of this site say what the code means; relative to the site."
    )
    title = serializers.CharField(help_text="The HTTP status in words.")
    status = serializers.IntegerField(help_text="The HTTP status.")
    code = serializers.RegexField(
        r"^[a-z0-9_]+$",
        help_text="The reason, for programs: it stays when the sentences change. The document problems lists all.",
    )
    detail = serializers.CharField(help_text="What is wrong and what to do, for people.")
    problems = ProblemItemSerializer(
        many=True,
        required=False,
        help_text="Each thing that is wrong, with its field or its place.",
    )
    current = serializers.DictField(
        required=False, help_text="The row as it is now, where it has changed since it was read."
    )


class PreconditionRequired(exceptions.APIException):
    """A write does not say which version it changes."""

    status_code = HTTPStatus.PRECONDITION_REQUIRED
    default_code = "precondition_required"
    default_detail = (
        "Send the header If-Match with the ETag of the row as you read it, so that nobody's work is "
        "overwritten unseen."
    )


def refusal_of_form(form: forms.BaseForm) -> Refusal:
    """Return what is wrong with a form of the pages, with the places that its checker knows."""
    checked = getattr(form, "checked", None)
    found = [as_json(each) for each in checked.problems if each.is_error] if checked else []
    placed = [
        {"field": item["file"], **item} if item["file"] in form.fields else item for item in found
    ]
    problems = placed or list(_problems_in(form.errors))
    return Refusal(problems[0]["message"], "not_valid", problems=problems)


def refusal_of_text(error: LanguageError, field: str = "") -> Refusal:
    """Return what is wrong with a text, and where in it."""
    item = as_json(error.problem)
    parts = [part for part in (error.message, error.hint) if part]
    sentence = f"{'; '.join(parts)}."
    item = {"field": field, **item} if field else item
    return Refusal(f"{sentence[:1].upper()}{sentence[1:]}", error.code, problems=[item])


def handle(error: Exception, context: dict[str, Any]) -> Response | None:
    """Turn an error of a route into a problem. Return None for a fault of the server."""
    # Its module reads the settings, and they name parsers of bodies that raise what is defined here.
    from rest_framework.views import exception_handler

    if isinstance(error, LanguageError):
        error = refusal_of_text(error)
    match error:
        case Refusal():
            more: dict[str, Any] = {"problems": list(error.problems)} if error.problems else {}
            if isinstance(error, Overtaken) and error.current is not None:
                # The row as it is now, as its route shows it.
                more["current"] = context["view"].get_serializer(error.current).data
            answer = _answer(error.code, error.status, error.message, **more)
            if error.wait:
                answer["Retry-After"] = str(error.wait)
            return answer
        case RowRefused():
            return _answer("row_refused", HTTPStatus.CONFLICT, " ".join(error.messages))
        case IntegrityError() if is_clash(error):
            return _answer("made_meanwhile", HTTPStatus.CONFLICT, MADE_MEANWHILE)
    response = exception_handler(error, context)
    if response is None:
        return None
    problems = None
    if isinstance(error, exceptions.ValidationError):
        problems = list(_problems_in(error.detail))
    if problems:
        detail = problems[0]["message"]
    else:
        said = response.data
        detail = str(said.get("detail", "") if isinstance(said, dict) else said)
    if isinstance(error, Http404):
        path = context["request"].path
        where = where_to_look(error, path)
        detail = f"{say_missing(error, path)}{f' {where} shows what is there.' if where else ''}"
    if isinstance(error, exceptions.UnsupportedMediaType):
        taken = dict.fromkeys(each.media_type for each in context["view"].parser_classes)
        detail = f"{detail} This address takes: {', '.join(taken)}."
    more = {"problems": problems} if problems else {}
    answer = _answer(_code_of(error), response.status_code, detail, **more)
    for name, value in response.headers.items():
        if name.lower() in ("www-authenticate", "retry-after", "allow"):
            answer[name] = value
    return answer


def _code_of(error: Exception) -> str:
    """Return the code of an error of the framework. What it answers itself is not found, or not allowed."""
    if not isinstance(error, exceptions.APIException):
        return "not_found" if isinstance(error, Http404) else "permission_denied"
    codes = error.get_codes()
    code = codes if isinstance(codes, str) else error.default_code
    return _OWN_CODES.get(code, code)


def _answer(code: str, status: int, detail: str, **more: Any) -> Response:
    document = problem(code, status, detail, **more)
    return Response(document, status=status, content_type=CONTENT_TYPE)


def _problems_in(errors: Any, field: str = "") -> Iterator[dict[str, Any]]:
    """Flatten the errors of a serializer or form: nested names are joined by dots."""
    if isinstance(errors, dict):
        for name, inner in errors.items():
            is_whole = name in ("non_field_errors", "__all__")
            yield from _problems_in(inner, field if is_whole else f"{field}.{name}".strip("."))
    elif isinstance(errors, list | tuple):
        for place, inner in enumerate(errors):
            is_nested = isinstance(inner, dict | list)
            if inner:
                yield from _problems_in(inner, f"{field}.{place}" if is_nested else field)
    else:
        yield {"field": field, "message": str(errors)} if field else {"message": str(errors)}
