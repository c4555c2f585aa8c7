"""The files of a generator: from a folder or an upload, bounded, each by its name alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from posixpath import dirname, join, normpath

from django.conf import settings

from annotations.importing.predicates_file import PREDICATES_FILE
from annotations.language.corpus import foreign_part, is_corpus_path
from annotations.language.decoding import MAX_LINKS, link_target, read_tree, to_utf8
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.grammar import TRIPLE_FILES, is_grammar_name, is_prose
from annotations.language.ontology import ONTOLOGY_FILES
from annotations.language.templates import is_template_name
from annotations.language.text import normalise_record


@dataclass(frozen=True)
class GatheredFiles:
    """Files by name, and what was wrong with their places."""

    files: Mapping[str, bytes]
    problems: tuple[Problem, ...] = ()


def gather(
    source: Path | str | Mapping[str, bytes] | GatheredFiles, encoding: str = ""
) -> GatheredFiles:
    """Return the files to read. Hidden files are left out.

    Args:
        source: a folder, whose own subfolders are looked into; files as name → bytes; or what
            ``flatten`` made of an upload.
        encoding: of the files that are not UTF-8; without one, they are errors where they are read.

    Raises:
        LanguageError: there is no such folder, there are too many files or bytes, or a name is a path.
    """
    if isinstance(source, GatheredFiles):
        gathered = source
    elif isinstance(source, Mapping):
        for name in source:
            if "/" in name or "\\" in name:
                raise LanguageError(
                    "a file name may not be a path", Position(name), "rename the file"
                )
        gathered = GatheredFiles(source)
    else:
        files, problems = read_tree(Path(source), is_generator_path)
        flat = flatten(files)
        gathered = GatheredFiles(flat.files, (*problems, *flat.problems))
    count = sum(map(is_generator_path, gathered.files))
    if count > settings.UPLOAD_MAX_FILES:
        raise LanguageError(
            f"there are {count} files; {settings.UPLOAD_MAX_FILES} is the limit",
            hint="import the files of one generator at a time",
        )
    total = sum(map(len, gathered.files.values()))
    if total > settings.UPLOAD_MAX_BYTES:
        raise LanguageError(
            f"the files hold {total:,} bytes; {settings.UPLOAD_MAX_BYTES:,} is the limit"
        )
    visible = {name: data for name, data in gathered.files.items() if not name.startswith(".")}
    return convert(GatheredFiles(visible, gathered.problems), encoding)


def convert(gathered: GatheredFiles, encoding: str) -> GatheredFiles:
    """Return the files in UTF-8. Files in another encoding are read as ``encoding``, with a warning for each."""
    if not encoding:
        return gathered
    files: dict[str, bytes] = {}
    problems = list(gathered.problems)
    for name, data in gathered.files.items():
        files[name] = data
        is_text = is_generator_path(name) or name.lower() in TRIPLE_FILES
        if not (is_text or is_corpus_path(name) or foreign_part(name)):
            continue
        try:
            files[name] = to_utf8(data, encoding, name)
        except LanguageError as error:
            problems.append(error.problem)
        else:
            if files[name] is not data:
                sentence = f"read as {encoding}; an export writes UTF-8"
                problems.append(warning_at(Position(name), sentence))
    return GatheredFiles(files, tuple(problems))


def is_generator_path(path: str) -> bool:
    """Return whether a file may be one of a generator, by its name. Pairs have an import of their own."""
    name = path.rsplit("/", 1)[-1]
    is_known = name.lower() in (*ONTOLOGY_FILES, PREDICATES_FILE)
    return (is_known or is_grammar_name(name) or is_template_name(name)) and not is_corpus_path(
        path
    )


def flatten(paths: Mapping[str, bytes]) -> GatheredFiles:
    """Drop the folders of files given as path → bytes, and normalise their names.

    Of several files with one name, whatever the case of its letters, the one nearest to the top is taken.
    Another one there with other content is an error, unless neither of the two has a production; one further
    down is left out, with a warning. A link that was stored as a file stands for the file that it points to,
    if that is among ``paths``.
    """
    problems: list[Problem] = []
    same_name: dict[str, list[str]] = defaultdict(list)
    for path in sorted(paths, key=lambda path: (path.count("/"), path)):
        if is_corpus_path(path):
            hint = "import pairs on the page for pairs"
            problems.append(warning_at(Position(path), "these are pairs; left out here", hint))
        else:
            same_name[_name_of(path).lower()].append(path)
    files: dict[str, bytes] = {}
    for first, *others in same_name.values():
        data = _follow(first, paths, problems)
        if data is None:
            continue
        files[_name_of(first)] = data
        different = [
            (path, other)
            for path in others
            if (other := _follow(path, paths, problems)) not in (data, None)
        ]
        may_differ = bool(different) and is_prose(data, first)
        for path, other in different:
            if may_differ and is_prose(other, path):
                continue
            if path.count("/") > first.count("/"):
                sentence = f"{first} has this name too, and is nearer to the top; left out"
                problems.append(warning_at(Position(path), sentence, "import one folder at a time"))
            else:
                sentence = f"two of the files have this name; the other is {first}"
                problems.append(error_at(Position(path), sentence, "rename one"))
    return GatheredFiles(files, tuple(problems))


def _name_of(path: str) -> str:
    """Return the name of a file without its folders, normalised as the imports of grammars are."""
    return normalise_record(path.rsplit("/", 1)[-1])


def _follow(path: str, paths: Mapping[str, bytes], problems: list[Problem]) -> bytes | None:
    """Return the content of a file, following a link; None where its target is missing."""
    at = path
    for _ in range(MAX_LINKS):
        if at not in paths:
            break
        target = link_target(paths[at], at)
        if target is None:
            return paths[at]
        at = normpath(join(dirname(at), target))
    hint = "send that file as well, or the file itself in the place of the link"
    problems.append(error_at(Position(path), f"this is a link to {at}, which is not here", hint))
    return None
