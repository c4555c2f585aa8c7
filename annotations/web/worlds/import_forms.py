"""The forms of the pages that take files."""

from __future__ import annotations

from typing import Any

from django import forms
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.exchange.gathered_files import gather
from annotations.exchange.generator_export import complete
from annotations.exchange.pair_files import Notation
from annotations.language.texts import ENCODINGS, UTF8, LanguageError
from annotations.models import World


class ManyFiles(forms.ClearableFileInput):
    """Takes several files, or a folder: ``paths`` beside them say where each lies in it, in the same order."""

    allow_multiple_selected = True

    def __init__(self) -> None:
        super().__init__(attrs={"data-folder": ""})

    def value_from_datadict(self, data: Any, files: Any, name: str) -> Any:
        sent = super().value_from_datadict(data, files, name)
        paths = data.getlist("paths") if hasattr(data, "getlist") else data.get("paths", ())
        if isinstance(sent, list) and len(sent) == len(paths):
            for upload, path in zip(sent, paths, strict=True):
                upload.sent_path = str(path)[:LONGEST_PATH]
        return sent


LONGEST_PATH = 1_000


class FilesField(forms.FileField):
    """A field for several files; its value is a list of them."""

    widget = ManyFiles

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, allow_empty_file=True)  # the import names the file

    def clean(self, data: Any, initial: Any = None) -> list[Any]:
        files = (data if isinstance(data, list | tuple) else [data]) or [None]
        return [super(FilesField, self).clean(file, initial) for file in files]


class BringsBackField(forms.BooleanField):
    """Whether an import restores what people have deleted."""

    def __init__(self) -> None:
        super().__init__(
            label="Bring back what was deleted here",
            required=False,
            help_text="Without it, what people have deleted stays away, and the report says what that is.",
        )


class EncodingField(forms.ChoiceField):
    """The encoding of files that are not UTF-8."""

    def __init__(self) -> None:
        others = {
            name: f"{each}, where not UTF-8" for name, each in ENCODINGS.items() if name != UTF8
        }
        super().__init__(
            label="Encoding",
            required=False,
            choices=[("", "UTF-8"), *others.items()],
            help_text="A file that is not UTF-8 is refused unless you say what it is. The report shows what "
            "each encoding would read. XML is read as it declares.",
        )


class FilesForm(forms.Form):
    """Files to import. The choices that most imports leave as they are come after the others, folded."""

    FOLDED = ("keeps_others", "encoding", "arena", "brings_back")

    @property
    def first_fields(self) -> list[forms.BoundField]:
        return [field for field in self if field.name not in self.FOLDED]

    @property
    def folded_fields(self) -> list[forms.BoundField]:
        return [field for field in self if field.name in self.FOLDED]

    @property
    def is_unfolded(self) -> bool:
        """Whether one of the folded fields says something already."""
        return any(field.value() or field.errors for field in self.folded_fields)


class PairsForm(FilesForm):
    """The pair files of a published corpus."""

    name = forms.SlugField(
        max_length=60, help_text="The splits are named after it: name-command, name-logical_form."
    )
    archive = FilesField(
        label="Files",
        help_text="A folder or one archive (.zip, .tar.gz) with any of the folders gen, para, gen_logical and "
        "para_logical (train.txt, val.txt, test.txt in each) and paraphrasings.txt.",
    )
    notation = forms.ChoiceField(
        required=False,
        choices=[
            (Notation.OURS, "As published here: ( find ( lambda $1 e …"),
            (
                Notation.LAMBDA,
                "λ-calculus of other corpora: (lambda $0 e (flight $0)), (argmax $0 …",
            ),
        ],
        help_text="For another corpus the folder holds train, dev and test as .txt or .tsv. Forms that cannot be "
        "read are left out, and the report counts them by reason.",
    )
    encoding = EncodingField()
    brings_back = BringsBackField()


class CompetitionForm(FilesForm):
    """The files of a competition's folder, as they are or in one archive."""

    files = FilesField(  # type: ignore[assignment]  # of the same name as those that were sent
        label="Files",
        help_text="The folder with names.md, room_names.md, location_names.md and objects.md, or one archive (.zip, "
        ".tar.gz) with it. Other files in it are ignored.",
    )
    encoding = EncodingField()
    arena = forms.CharField(
        required=False,
        max_length=60,
        help_text="Where the folder has files of several, such as objects_a.md and objects_b.md. Without it you are "
        "asked.",
    )
    brings_back = BringsBackField()


class WorldArchiveForm(forms.Form):
    """The archive of a world, and what the new world is called."""

    name = forms.CharField(
        max_length=60,
        help_text="Of the new world: lower-case letters, digits, _ and -. Used in URLs and commands.",
    )
    archive = forms.FileField(
        allow_empty_file=True,
        help_text="The archive of the whole world, from Settings → Import and export there.",
    )


class ImportForm(FilesForm):
    """The files of a generator, as they are or in one archive."""

    files = FilesField(  # type: ignore[assignment]  # of the same name as those that were sent
        label="Files",
        help_text="The grammar, template and ontology files of one generator: choose all of them, "
        "their folder, or one archive (.zip, .tar.gz).",
    )
    keeps_others = forms.BooleanField(
        label="Keep what these files do not have",
        required=False,
        help_text="Only files of the same name are replaced: a grammar, objects.xml, predicates.json.",
    )
    encoding = EncodingField()
    brings_back = BringsBackField()


def uploads_of(world: World, form: ImportForm) -> list[Any]:
    """Return the files to import: those that were sent and, if asked for, the world's other files."""
    sent: list[Any] = form.cleaned_data["files"]
    if not form.cleaned_data["keeps_others"]:
        return sent
    gathered = gather(sent, form.cleaned_data["encoding"])
    for problem in gathered.problems:
        if problem.is_error:
            raise LanguageError(problem.message, problem.position, problem.hint)
    files = complete(world, gathered.files)
    return [SimpleUploadedFile(name, data) for name, data in files.items()]
