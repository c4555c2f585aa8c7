"""The forms of the pages that take files."""

from __future__ import annotations

from typing import Any

from django import forms


class ManyFiles(forms.ClearableFileInput):
    allow_multiple_selected = True


class FilesField(forms.FileField):
    """A field for several files; its value is a list of them."""

    widget = ManyFiles

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


class PairsForm(forms.Form):
    """The pair files of a published corpus, in one archive."""

    name = forms.SlugField(
        max_length=60, help_text="The splits are named after it: name-command, name-logical_form."
    )
    archive = forms.FileField(
        help_text="A zip archive with any of the folders gen, para, gen_logical and para_logical "
        "(train.txt, val.txt, test.txt in each) and paraphrasings.txt."
    )
    brings_back = BringsBackField()


class WorldArchiveForm(forms.Form):
    """The archive of a world, and what the new world is called."""

    name = forms.CharField(
        max_length=60,
        help_text="Of the new world: lower-case letters, digits, _ and -. Used in URLs and commands.",
    )
    archive = forms.FileField(help_text="The zip archive from “Download” on a world's import page.")


class ImportForm(forms.Form):
    """The files of a generator, as they are or in one zip archive."""

    files = FilesField(
        label="Files",
        help_text="The grammar, template and ontology files of one generator: choose all of them, "
        "or one zip archive with them.",
    )
    keeps_others = forms.BooleanField(
        label="Keep what these files do not have",
        required=False,
        help_text="Only files of the same name are replaced: a grammar, objects.xml, predicates.json.",
    )
    brings_back = BringsBackField()
