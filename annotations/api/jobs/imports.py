"""Files taken in and given out, and commands made of templates: at once, or as a job where it takes long."""

from __future__ import annotations

from collections.abc import Callable
from http import HTTPStatus
from typing import Any, ClassVar

from django import forms
from django.http import HttpResponse, StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.parsers import MultiPartParser
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.jobs.jobs import JobSerializer, address_of_job
from annotations.api.negotiation import AnyType
from annotations.api.once import once
from annotations.api.permissions import ForSiteAdmins
from annotations.api.problems import Refused, refusal_of_form
from annotations.api.routes import Route, WorldRoute
from annotations.exporting.generator_export import Part
from annotations.jobs.starting import (
    start_generation,
    start_generator_import,
    start_pairs_import,
    start_world_import,
)
from annotations.language.english import say_count
from annotations.models import Duty, Job
from annotations.upload_forms import ImportForm, PairsForm, WorldArchiveForm
from annotations.views.worlds.files import file_of
from annotations.views.worlds.importing import uploads_of
from annotations.world_archive import archive_name, world_archive


class DoneSerializer(serializers.Serializer):
    """What came of it, or the job that will say so: one of both is null."""

    job = JobSerializer(allow_null=True)
    report = serializers.DictField(allow_null=True)


class ImportedFiles(serializers.Serializer):
    """The files of a generator, as they are or in one zip archive."""

    files = serializers.ListField(child=serializers.FileField(), min_length=1)
    keeps_others = serializers.BooleanField(default=False)
    brings_back = serializers.BooleanField(default=False)


class ImportedPairs(serializers.Serializer):
    """The pair files of a published corpus in one zip archive; splits are named after ``name``."""

    name = serializers.SlugField(max_length=60)
    archive = serializers.FileField()
    brings_back = serializers.BooleanField(default=False)


class ImportedWorldFile(serializers.Serializer):
    """The archive that ``download/`` of a world gives, and what the world is to be called here."""

    name = serializers.CharField(max_length=60)
    archive = serializers.FileField()


class Doing(Route):
    """Work that is done at once where it is quick; otherwise the answer is a job (202)."""

    model = Job
    http_method_names = ["post", "options"]

    def answer(self, start: Callable[[], Any]) -> Response:
        """Start the work and say what came of it. Raises Refused, with every problem and its place."""
        started = start()
        if isinstance(started, Job):
            done = {"job": JobSerializer(started).data, "report": None}
            location = {"Location": address_of_job(self.request, started)}
            return Response(done, status=HTTPStatus.ACCEPTED, headers=location)
        report = started.as_json()
        problems = report.get("problems", [])
        errors = sum(each["severity"] == "error" for each in problems)
        if errors:
            sentence = f"Nothing was imported: {say_count(errors, 'error')}."
            raise Refused(sentence, problems, HTTPStatus.UNPROCESSABLE_ENTITY)
        return Response({"job": None, "report": report})

    def valid(self, form: forms.Form) -> forms.Form:
        if not form.is_valid():
            raise refusal_of_form(form)
        return form


class ImportWorld(Doing):
    """Makes a world of the archive of another one. For administrators of the site."""

    permission_classes = [ForSiteAdmins]
    parser_classes = [MultiPartParser]
    duty = Duty.MANAGE

    @extend_schema(
        request={"multipart/form-data": ImportedWorldFile},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: Request) -> Response:
        sent = self.valid(WorldArchiveForm(request.data, request.FILES)).cleaned_data
        return self.answer(lambda: start_world_import(sent["name"], sent["archive"], request.user))


class ImportGenerator(Doing, WorldRoute):
    """Imports the files of a generator, all of them or nothing."""

    parser_classes = [MultiPartParser]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.MANAGE}

    @extend_schema(
        request={"multipart/form-data": ImportedFiles},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        form = self.valid(ImportForm(request.data, request.FILES))
        files, brings_back = uploads_of(self.world, form), form.cleaned_data["brings_back"]
        return self.answer(
            lambda: start_generator_import(self.world, files, request.user, brings_back)
        )


class ImportPairs(Doing, WorldRoute):
    """Imports the pairs of a published corpus as frozen splits and paraphrases."""

    parser_classes = [MultiPartParser]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.MANAGE}

    @extend_schema(
        request={"multipart/form-data": ImportedPairs},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.valid(PairsForm(request.data, request.FILES)).cleaned_data
        values = sent["name"], sent["archive"], request.user, sent["brings_back"]
        return self.answer(lambda: start_pairs_import(self.world, *values))


class Generate(Doing, WorldRoute):
    """Expands all templates into commands and forms."""

    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=None, responses={200: DoneSerializer, 202: DoneSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        return self.answer(lambda: start_generation(self.world, request.user))


class Archive(WorldRoute):
    """Downloads the whole world as one zip archive, packed while it is sent."""

    model = Job
    content_negotiation_class = AnyType

    @extend_schema(responses={(200, "application/zip"): OpenApiTypes.BINARY})
    def get(self, request: Request, **kwargs: object) -> StreamingHttpResponse:
        name = archive_name(self.world)
        headers = {"Content-Disposition": f'attachment; filename="{name}"'}
        content = world_archive(self.world)
        return StreamingHttpResponse(content, content_type="application/zip", headers=headers)


class ArchivePart(WorldRoute):
    """Downloads one part of a world, as a generator has it: a file, or a zip archive of several."""

    model = Job
    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="download_part",
        parameters=[OpenApiParameter("part", OpenApiTypes.STR, "path", enum=Part.values)],
        responses={
            (200, "application/zip"): OpenApiTypes.BINARY,
            (200, "text/plain"): OpenApiTypes.STR,
        },
    )
    def get(self, request: Request, **kwargs: str) -> HttpResponse:
        return file_of(self.world, kwargs["part"])
