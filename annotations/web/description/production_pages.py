"""The command grammar: its lines checked as one types."""

from __future__ import annotations

from django.http import JsonResponse

from annotations.generation.production_check import assist_production
from annotations.models import Duty, World
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.web.description.production_forms import ProductionForm
from annotations.web.description.production_noun import PRODUCTIONS, edit_typed


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def production_check(request: WorldRequest, world: World) -> JsonResponse:
    """Check what is typed, for the editor."""
    edit = edit_typed(ProductionForm(world, PRODUCTIONS.row_in(request, world), request.POST))
    return JsonResponse(assist_production(edit) if edit else {"problems": [], "slots": []})
