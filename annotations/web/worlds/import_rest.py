"""Files taken in and given out, and commands made of templates: at once, or as a job where it takes long."""

from __future__ import annotations

from collections.abc import Callable
from http import HTTPStatus
from typing import Any, TypeVar

from django import forms
from django.http import HttpResponse, StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.background.requesting import refusal_in
from annotations.exchange.generator_export import GeneratorPart
from annotations.exchange.import_jobs import (
    start_competition_import,
    start_generator_import,
    start_pairs_import,
)
from annotations.exchange.pair_files import Notation
from annotations.exchange.world_import_job import start_world_import
from annotations.generation.generating import start_generation
from annotations.generation.language_size import language_size
from annotations.language.templates import (
    LARGEST_SEED,
    MOST_COUNTED,
    MOST_SAMPLED,
    Balance,
    SampleRequest,
)
from annotations.language.texts import ENCODINGS, Refusal
from annotations.models import Duty, Job, SemanticTemplate
from annotations.people.allowances import may_take_long, takes_files
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.parsing import FilesParser
from annotations.web.rest.permissions import ApiRequest, ForSiteAdmins
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import Route, WorldRoute
from annotations.web.rest.samples import SampleNoteSerializer
from annotations.web.worlds.downloads import archive_of, file_of
from annotations.web.worlds.import_forms import (
    CompetitionForm,
    ImportForm,
    PairsForm,
    WorldArchiveForm,
    uploads_of,
)
from annotations.web.worlds.job_rest import JobSerializer, address_of_job

AnyForm = TypeVar("AnyForm", bound=forms.Form)


class DoneSerializer(serializers.Serializer[Any]):
    """The report of the work, or the job that carries it out: one of the two is null."""

    job = JobSerializer(allow_null=True)
    report = serializers.DictField(allow_null=True)


class EncodingChoice(serializers.ChoiceField):
    def __init__(self) -> None:
        super().__init__(
            choices=list(ENCODINGS),
            required=False,
            help_text="Of files that are not UTF-8.",
        )


class SentFilesField(serializers.ListField):
    """Files as they are, or one archive (.zip, .tar, .tar.gz)."""

    def __init__(self) -> None:
        super().__init__(child=serializers.FileField(allow_empty_file=True), min_length=1)


class WithPaths(serializers.Serializer[Any]):
    """``paths`` say where each file lies in its folder, in the order of the files; without them names say it."""

    paths = serializers.ListField(child=serializers.CharField(), required=False)


class ImportedFiles(WithPaths):
    """The files of a generator, as they are or in one archive."""

    files = SentFilesField()
    keeps_others = serializers.BooleanField(default=False)
    encoding = EncodingChoice()
    brings_back = serializers.BooleanField(default=False)


class ImportedPairs(WithPaths):
    """The pair files of a published corpus, with their ``paths`` or in one archive; splits are named after ``name``."""

    name = serializers.SlugField(max_length=60)
    archive = SentFilesField()
    notation = serializers.ChoiceField(
        choices=[Notation.LAMBDA], required=False, help_text="Of another corpus."
    )
    encoding = EncodingChoice()
    brings_back = serializers.BooleanField(default=False)


class ImportedCompetition(WithPaths):
    """The files of a competition's folder, as they are or in one archive. ``arena``: whose files are taken where it has
    those of several; without it the answer is a job that asks."""

    files = SentFilesField()
    encoding = EncodingChoice()
    arena = serializers.CharField(required=False, max_length=60)
    brings_back = serializers.BooleanField(default=False)


class ImportedWorldFile(serializers.Serializer[Any]):
    """The archive that ``download/`` of a world gives, and what the world is to be called here."""

    name = serializers.CharField(max_length=60)
    archive = serializers.FileField()


class Doing(Route):
    """Work that is done at once where it is quick; otherwise the answer is a job (202)."""

    model = Job
    http_method_names = ["post", "options"]

    @property
    def sent(self) -> Any:
        """The fields beside the files, as a form of the pages takes them."""
        return self.request.data

    def answer(self, start: Callable[[], Any]) -> Response:
        """Start the work and say what came of it. Raises Refusal, with every problem and its place."""
        started = start()
        if isinstance(started, Job):
            done = {"job": JobSerializer(started).data, "report": None}
            location = {"Location": address_of_job(self.request, started)}
            return Response(done, status=HTTPStatus.ACCEPTED, headers=location)
        report = started.as_json()
        if sentence := refusal_in(report):
            status = HTTPStatus.UNPROCESSABLE_ENTITY
            raise Refusal(sentence, "not_imported", status, report["problems"])
        return Response({"job": None, "report": report})

    def valid(self, form: AnyForm) -> AnyForm:
        if not form.is_valid():
            raise refusal_of_form(form)
        return form


@takes_files
class ImportWorld(Doing):
    """Makes a world of the archive of another one. For administrators of the site."""

    permission_classes = [ForSiteAdmins]
    parser_classes = [FilesParser]
    duty = Duty.MANAGE

    @extend_schema(
        request={"multipart/form-data": ImportedWorldFile},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: ApiRequest) -> Response:
        sent = self.valid(WorldArchiveForm(self.sent, request.FILES)).cleaned_data
        return self.answer(lambda: start_world_import(sent["name"], sent["archive"], request.user))


@takes_files
class ImportGenerator(Doing, WorldRoute):
    """Imports the files of a generator, all of them or nothing."""

    parser_classes = [FilesParser]
    duties = {"POST": Duty.MANAGE}

    @extend_schema(
        request={"multipart/form-data": ImportedFiles},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        form = self.valid(ImportForm(self.sent, request.FILES))
        files = uploads_of(self.world, form)
        choices = form.cleaned_data["brings_back"], form.cleaned_data["encoding"]
        return self.answer(
            lambda: start_generator_import(self.world, files, request.user, *choices)
        )


@takes_files
class ImportCompetition(Doing, WorldRoute):
    """Imports names, rooms, locations and objects from the folder of a competition, all of it or nothing."""

    parser_classes = [FilesParser]
    duties = {"POST": Duty.MANAGE}

    @extend_schema(
        request={"multipart/form-data": ImportedCompetition},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.valid(CompetitionForm(self.sent, request.FILES)).cleaned_data
        files = sent.pop("files")
        return self.answer(
            lambda: start_competition_import(self.world, files, request.user, **sent)
        )


@takes_files
class ImportPairs(Doing, WorldRoute):
    """Imports the pairs of a published corpus as frozen splits and paraphrases."""

    parser_classes = [FilesParser]
    duties = {"POST": Duty.MANAGE}

    @extend_schema(
        request={"multipart/form-data": ImportedPairs},
        responses={200: DoneSerializer, 202: DoneSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.valid(PairsForm(self.sent, request.FILES)).cleaned_data
        choices = sent["brings_back"], sent["encoding"], sent["notation"]
        values = sent["name"], sent["archive"], request.user, *choices
        return self.answer(lambda: start_pairs_import(self.world, *values))


class WantedCommands(Fields):
    """``sample`` commands are drawn under a ``seed``, with equally many of each of what is ``balanced``; with 0 all
    are made. Without ``sample`` as many as the last time."""

    sample = serializers.IntegerField(min_value=0, max_value=MOST_SAMPLED, required=False)
    seed = serializers.IntegerField(min_value=0, max_value=LARGEST_SEED, default=0)
    balanced = serializers.ChoiceField(
        choices=[each.value for each in Balance], default=Balance.NONE.value
    )


@may_take_long
class Generate(Doing, WorldRoute):
    """Makes commands and forms of the templates: all, or a sample of them."""

    duties = {"POST": Duty.ANNOTATE}

    @extend_schema(request=WantedCommands, responses={200: DoneSerializer, 202: DoneSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        wanted = WantedCommands(data=request.data)
        wanted.is_valid(raise_exception=True)
        sent = wanted.validated_data
        asked = None
        if "sample" in sent:
            asked = SampleRequest(sent["sample"], sent["seed"], Balance(sent["balanced"]))
        return self.answer(lambda: start_generation(self.world, request.user, asked))


class LanguageSerializer(serializers.Serializer[Any]):
    """``derivations`` is the number of derivations of all templates as text, an upper bound on their distinct
    commands; ``sample`` says what sample of them the commands are now, if any."""

    derivations = serializers.CharField()
    sample = SampleNoteSerializer(allow_null=True)


@may_take_long
class Generation(WorldRoute):
    """Says how many commands the templates can make, without making them."""

    model = SemanticTemplate

    @extend_schema(operation_id="generation", responses={200: LanguageSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        size = min(language_size(self.world), MOST_COUNTED)
        answer = {"derivations": str(size), "sample": self.world.sample or None}
        return Response(LanguageSerializer(answer).data)


@may_take_long
class Archive(WorldRoute):
    """Downloads the whole world as one zip archive, packed while it is sent."""

    model = Job
    content_negotiation_class = AnyType

    @extend_schema(responses={(200, "application/zip"): OpenApiTypes.BINARY})
    def get(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        return archive_of(self.world, request.user)


@may_take_long
class ArchivePart(WorldRoute):
    """Downloads one part of a world, as a generator has it: a file, or a zip archive of several."""

    model = Job
    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="download_part",
        parameters=[OpenApiParameter("part", OpenApiTypes.STR, "path", enum=GeneratorPart.values)],
        responses={
            (200, "application/zip"): OpenApiTypes.BINARY,
            (200, "text/plain"): OpenApiTypes.STR,
        },
    )
    def get(self, request: ApiRequest, **kwargs: str) -> HttpResponse:
        return file_of(self.world, kwargs["part"])
