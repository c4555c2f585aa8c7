"""``audit_labels --world W``: the labels of a world that may be wrong, the most suspect first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandParser

from annotations.language.corpus import Reason, Suspect
from annotations.language.texts import Refusal
from annotations.management.base import ReportingCommand, find_world
from parser_service.labelling.audit_job import audit_labels
from parser_service.labelling.out_of_fold import AUDITORS


class Command(ReportingCommand):
    help = (
        "List the paraphrases and labelled utterances whose label disagrees with the form of the command "
        "behind them, with a parser that was trained without them, or with their words. Changes nothing."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("--world", required=True)
        parser.add_argument(
            "--parser", choices=AUDITORS, default=AUDITORS[0], help=f"default: {AUDITORS[0]}"
        )
        parser.add_argument(
            "--folds", type=int, default=5, help="parts of the pairs, each answered for in turn"
        )
        parser.add_argument("--seed", type=int, default=0, help="what goes into which fold")
        parser.add_argument("--most", type=int, help="labels to list (default: all)")

    def report(
        self, *, world: str, parser: str, folds: int, seed: int, most: int | None, **options: Any
    ) -> Mapping[str, Any]:
        if most is not None and most < 1:
            raise Refusal(f"--most is {most}; it has to be 1 or more.", "option_out_of_range")
        audit = audit_labels(find_world(world), parser, folds, seed)
        counts = Counter(reason for each in audit.suspects for reason in each.reasons)
        return {
            "world": world,
            "pairs": audit.pairs,
            "suspects": len(audit.suspects),
            "reasons": {str(reason): counts[reason] for reason in Reason},
            "labels": [_row(each) for each in audit.suspects[:most]],
        }

    def describe(self, report: Mapping[str, Any]) -> str:
        reasons = ", ".join(f"{name} {count}" for name, count in report["reasons"].items())
        lines = [f"{report['suspects']} of {report['pairs']} labels are in doubt ({reasons})."]
        for number, row in enumerate(report["labels"], start=1):
            lines += ["", f"{number}. {row['utterance']}   [{row['pair']}, {row['score']:.2f}]"]
            lines += [f"   {finding['sentence']}" for finding in row["findings"]]
            lines += [f"   label:     {row['form']}", f"   suggested: {row['suggested_form']}"]
        return "\n".join(lines)


def _row(suspect: Suspect) -> dict[str, Any]:
    pair = suspect.pair
    return {
        "pair": pair.key,
        "utterance": pair.utterance,
        "source_command": pair.source_command,
        "form": pair.form,
        "suggested_form": suspect.suggested_form,
        "score": round(suspect.score, 4),
        "findings": [
            {
                "reason": str(finding.reason),
                "sentence": finding.sentence,
                "suggested_form": finding.suggested_form,
                "score": round(finding.score, 4),
            }
            for finding in suspect.findings
        ],
    }
