"""``benchmark DIR --parsers a,b --json FILE``: the accuracy table over a folder of pairs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from tqdm import tqdm

from annotations.background.failures import disk_trouble, file_sentence
from annotations.language.corpus import Criterion
from annotations.language.texts import Refusal
from annotations.management.base import find_world
from annotations.models import World
from parser_service.benchmarking.benchmark_cells import CellFile, TrialGroup
from parser_service.benchmarking.missing_cells import find_missing, measure_all
from parser_service.benchmarking.paraphrase_sources import find_sources
from parser_service.benchmarking.trials import trials
from parser_service.management.options import (
    read_columns,
    read_configurations,
    read_names,
    read_seeds,
)
from parser_service.parsers.conditions import PAPERS_SETTINGS, Protocol
from parser_service.parsers.registry import parsers


class Command(BaseCommand):
    help = (
        "Train and test parsers on a folder of pair files (gen, para, gen_logical, para_logical, "
        "paraphrasings.txt). Cells that the JSON file has already are not measured again."
    )
    requires_system_checks: list[str] = []

    def create_parser(self, *args: Any, **options: Any) -> CommandParser:
        return super().create_parser(*args, allow_abbrev=False, **options)

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path)
        _add_choice_of_cells(parser)
        parser.add_argument(
            "--world", help="the world whose predicates, ontology and grammar may be known"
        )
        parser.add_argument(
            "--config",
            nargs="*",
            default=[],
            metavar="PARSER.KEY=VALUE",
            help="hyperparameters to change from their defaults",
        )
        parser.add_argument(
            "--jobs",
            type=int,
            default=1,
            metavar="N",
            help="number of trainings at a time (default: 1)",
        )
        parser.add_argument(
            "--json", type=Path, required=True, help="file of cells, extended by the new ones"
        )

    def handle(self, *args: Any, folder: Path, world: str | None, **options: Any) -> None:
        try:
            failures = self._run(folder, find_world(world) if world else None, options)
        except Refusal as error:
            raise CommandError(str(error)) from error
        except OSError as error:
            said = (
                f"“{error.filename}” cannot be read or written: {error.strerror}. Check the path."
            )
            raise CommandError(file_sentence(error) if disk_trouble(error) else said) from error
        except KeyboardInterrupt:
            raise CommandError(
                f"Stopped. {options['json']} keeps the cells that were finished; the same command "
                "measures the others."
            ) from None
        if failures:
            raise CommandError("\n".join(dict.fromkeys(failures)))

    def _run(self, folder: Path, world: World | None, options: dict[str, Any]) -> list[str]:
        """Measure what is missing; return sentences for what could not be measured."""
        at_once = options["jobs"]
        if at_once < 1:
            raise Refusal(f"--jobs is {at_once}; it has to be 1 or more.", "option_out_of_range")
        todo = list(
            trials(
                read_names(options["parsers"], list(parsers())),
                read_columns(
                    options["columns"],
                    options["train_test"],
                    options["criteria"],
                    options["protocols"],
                ),
                read_seeds("--seeds", options["seeds"], at_least=1),
                read_configurations(options["config"]),
                read_seeds("--new-splits", options["new_splits"]),
                read_names(options["new_splits_by"], list(Criterion)),
            )
        )
        is_by_source = any(trial.criterion == Criterion.SOURCE_COMMAND for trial in todo)
        can_be_resolved = is_by_source and world is not None and folder.is_dir()
        if can_be_resolved and (sentence := find_sources(folder, world).sentence):
            self.stderr.write(sentence)
        cells = CellFile(options["json"])
        groups, failures = find_missing(todo, cells, folder, world)
        done = len(todo) - sum(len(group.trials) for group in groups)
        with (
            tqdm(total=len(todo), initial=done, disable=None, unit="cell") as bar,
            closing(measure_all(_announce(groups, bar), at_once)) as answers,
        ):
            for answer in answers:
                if isinstance(answer, str):
                    failures.append(answer)
                else:
                    cells.append(answer)
                bar.update()
        return failures


def _add_choice_of_cells(parser: CommandParser) -> None:
    """Add the options that choose what the table has: parsers, columns, seeds and splits."""
    for name, known in (
        ("--parsers", parsers()),
        ("--train-test", [str(setting) for setting in PAPERS_SETTINGS]),
        ("--criteria", list(Criterion)),
        ("--protocols", list(Protocol)),
    ):
        names = ", ".join(known)
        parser.add_argument(name, metavar="A,B", help=f"some of {names} (default: all)")
    parser.add_argument(
        "--columns",
        metavar="A,B",
        help="instead of --train-test, --criteria and --protocols: some of their combinations, each "
        "TRAIN-TEST:CRITERION:PROTOCOL, under domain also with :training where only forms of training "
        "pairs declare predicates",
    )
    parser.add_argument(
        "--seeds",
        default="1",
        metavar="N|A-B",
        help="train with the seeds 0 to N - 1, or A to B",
    )
    parser.add_argument(
        "--new-splits",
        default="0",
        metavar="N|A-B",
        help="use new splits of the train and validation pairs, 70/10/20: N of them, or those with "
        "the seeds A to B (default: the published split, or by source command the new one of seed 0)",
    )
    parser.add_argument(
        "--new-splits-by",
        metavar="A,B",
        help=f"the criteria that have new splits, some of {', '.join(Criterion)} (default: all)",
    )


def _announce(groups: Iterable[TrialGroup], bar: tqdm) -> Iterator[TrialGroup]:
    """Yield the groups, naming each on the bar when its turn comes."""
    for group in groups:
        bar.set_description(str(group))
        yield group
