"""Work that a worker carries out: claimed by one, fenced, leased, cancelled, resumed.

A kind of work is a model that extends ``BackgroundWork`` and names a function ``(work, give_up)``, which
brings the work to its end inside ``while_held``. Whoever wants some creates a queued row and calls ``wake``.
"""

from annotations.background.carrying_out import while_held
from annotations.background.failures import failure_sentence, is_out_of_memory
from annotations.background.fencing import (
    Fenced,
    acknowledge_cancel,
    cancel,
    claim,
    extend,
    fail,
    finish,
    held,
    is_cancel_requested,
    log,
    record_progress,
)
from annotations.background.kinds import carry_out, claim_in_turn, kinds
from annotations.background.lease_watch import LeaseWatch
from annotations.background.leasing import Lease, Stopped
from annotations.background.outages import DatabaseAway, outlasting
from annotations.background.recovery import MOST_RESUMES, hand_back, requeue_expired
from annotations.background.waking import (
    TASK,
    message_queue,
    queue_app,
    send_wake_up,
    wake,
    wake_for_forgotten,
    wake_for_next,
)
from annotations.models.background import LEASE
