"""Propose error categories for all errors of one run, and print what that takes."""

from __future__ import annotations

import os
import resource
import time

from benchmarks.fresh_site import WORLD


def propose() -> None:
    """Propose for the run with the most errors, which is the first one."""
    from annotations.background.progress import UNWATCHED
    from annotations.models import World
    from parser_service.analysing.attracting import attractors_in
    from parser_service.analysing.findings import findings_of
    from parser_service.reviewing.proposing import propose_for_run

    run = World.objects.get(name=WORLD).runs.order_by("pk")[0]
    attractors = attractors_in(findings_of(run, "test"))
    began, used = time.perf_counter(), time.process_time()
    count = propose_for_run(run, attractors, UNWATCHED)
    wall, processor = time.perf_counter() - began, time.process_time() - used
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"proposing categories for {count:,} errors: {processor:.1f} s of processor time, "
        f"{wall:.1f} s, peak memory {peak:.0f} MiB, load {os.getloadavg()[0]:.1f}"
    )
