"""The files of a generator, each by its name alone."""

from __future__ import annotations

from posixpath import commonpath, dirname

from annotations.exchange.predicates_file import PREDICATES_FILE
from annotations.exchange.source_files import FileSource, GatheredFiles, by_place, read_files
from annotations.language.corpus import is_corpus_path
from annotations.language.grammar import is_grammar_name, is_prose
from annotations.language.templates import is_template_name
from annotations.language.texts import LanguageError, Position, to_utf8, warning_at
from annotations.language.world import ONTOLOGY_FILES


def gather(source: FileSource | GatheredFiles, encoding: str = "") -> GatheredFiles:
    """Return the files to read. Hidden files are left out.

    Args:
        source: what ``read_files`` takes, or files that were gathered before.
        encoding: of the files that are not UTF-8; without one, they are errors where they are read.

    Raises:
        LanguageError: there is no such folder, there are too many files or bytes, or an archive cannot be read.
    """
    if not isinstance(source, GatheredFiles):
        source = flatten(read_files(source, is_generator_path))
    return convert(source, encoding)


def convert(gathered: GatheredFiles, encoding: str) -> GatheredFiles:
    """Return the files in UTF-8. Files in another encoding are read as ``encoding``, with a warning for each."""
    if not encoding:
        return gathered
    files: dict[str, bytes] = {}
    problems = list(gathered.problems)
    for name, data in gathered.files.items():
        files[name] = data
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


def flatten(gathered: GatheredFiles) -> GatheredFiles:
    """Drop the folders of files (``by_place``); files of one name may differ where none has a production.

    Of the files that are not read those directly in the topmost folder are named, without their content. Pairs get a
    warning wherever they are.
    """
    flat = by_place(gathered, _name_of, is_prose)
    folders = [f"/{dirname(path)}" for path in (*gathered.files, *gathered.others)]
    top = commonpath(folders) if folders else ""
    files, problems = dict(flat.files), list(flat.problems)
    for path in gathered.others:
        if is_corpus_path(path):
            hint = "import pairs on the page for pairs"
            problems.append(warning_at(Position(path), "these are pairs; left out here", hint))
        elif f"/{dirname(path)}" == top:
            files.setdefault(_name_of(path), b"")
    return GatheredFiles(files, tuple(problems))


def _name_of(path: str) -> str:
    return path.rsplit("/", 1)[-1]
