"""Jobs that take the results of a crowd market in: one checks a file and asks, the next one imports it."""

from __future__ import annotations

from typing import Any

from annotations.background.job_files import kept_uploads
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.campaigns.crowd_results import new_campaign, plan_results, store_results
from annotations.campaigns.launching import name_taken
from annotations.exchange.source_files import UploadedFile, read_one_file
from annotations.labelling.upload_reading import decode_upload
from annotations.language.corpus import CrowdTable, read_crowd_results
from annotations.language.texts import LanguageError
from annotations.models import Campaign, Job, JobKind, User, World
from annotations.models.corpus import MOST_CHARACTERS

MOST_BYTES = 60_000_000  # of a table, out of its archive
_TABLES = (".csv", ".tsv")


def start_results_import(
    world: World,
    upload: UploadedFile,
    by: User,
    campaign: Campaign | None = None,
    name: str = "",
    encoding: str = "",
) -> Job:
    """Queue the check of a table of results; nothing is imported before somebody confirms its report.

    Args:
        upload: a table, or an archive with one in it.
        campaign: whose prompts were answered; without one a new campaign is made, called ``name``.
        encoding: of the file; without one it is recognised.

    Raises:
        Refusal: the world has a campaign called ``name``.
    """
    if campaign is None and world.campaigns.filter(name=name).exists():
        raise name_taken(name)
    arguments = {
        "campaign": campaign.pk if campaign else None,
        "name": "" if campaign else name,
        "encoding": encoding,
    }
    return request_job(JobKind.IMPORT_RESULTS, world.name, by, arguments, [upload])


def import_results_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    """Check a table, and ask; import it where somebody has confirmed."""
    if job.world is None:
        raise LanguageError(f"there is no world “{job.world_name}” any more")
    progress.report(0, "reading the table")
    with kept_uploads(job) as (upload,):
        source = upload.name
        chosen = _chosen(job, job.world)
        parameter = chosen.worker_parameter if chosen else ""
        table, encoding = read_results(upload, job.arguments["encoding"], parameter)
    campaign = chosen or new_campaign(job.world, job.arguments["name"], table, job.created_by)
    plan = plan_results(campaign, table, source, progress)
    if plan.is_refused or not plan.contributors:
        return {**plan.report(table), "encoding": encoding}
    if not job.arguments.get("is_confirmed"):
        shown = {"examples": plan.examples(), "is_waiting": True}
        return {**plan.report(table), "encoding": encoding, **shown}
    return store_results(plan, table, job.created_by, progress)


def read_results(
    upload: UploadedFile, encoding: str = "", worker_parameter: str = ""
) -> tuple[CrowdTable, str]:
    """Return the table of an upload, with its problems, and the encoding that it was read in.

    Raises:
        LanguageError: it is too large, no text, or an archive without one table.
    """
    data = read_one_file(upload, _is_table, MOST_BYTES)
    text, encoding = decode_upload(data, upload.name, encoding)
    return read_crowd_results(text, upload.name, MOST_CHARACTERS, worker_parameter), encoding


def _is_table(path: str) -> bool:
    return path.lower().endswith(_TABLES)


def _chosen(job: Job, world: World) -> Campaign | None:
    """Return the campaign that the results are of; None where they get a new one."""
    key = job.arguments["campaign"]
    if key is None:
        return None
    campaign = world.campaigns.filter(pk=key).first()
    if campaign is None:
        raise LanguageError("the campaign is no longer here", hint="choose another one")
    return campaign
