"""Turn a form with entities into a plan: actions as data, as JSON and as a behaviour tree."""

from __future__ import annotations

from annotations.language.plans.behavior_tree import (
    TAKEN_NAMES,
    Robust,
    node_name,
    port_name,
    to_behavior_tree,
)
from annotations.language.plans.descriptions import AT
from annotations.language.plans.lookup import Lookup
from annotations.language.plans.plan import (
    ASK,
    ActionName,
    Condition,
    Described,
    Named,
    Number,
    OpenValue,
    Operator,
    Plan,
    PlanOf,
    PlanProblem,
    Referred,
    Step,
    StepResult,
    Trouble,
    Value,
    Words,
    behavior_tree_schema_text,
    plan_schema,
    plan_schema_text,
)
from annotations.language.plans.planning import (
    NOT_UNDERSTOOD,
    argument_names,
    doubts_about,
    make_plan,
)

__all__ = [
    "ASK",
    "AT",
    "NOT_UNDERSTOOD",
    "TAKEN_NAMES",
    "ActionName",
    "Condition",
    "Described",
    "Lookup",
    "Named",
    "Number",
    "OpenValue",
    "Operator",
    "Plan",
    "PlanOf",
    "PlanProblem",
    "Referred",
    "Robust",
    "Step",
    "StepResult",
    "Trouble",
    "Value",
    "Words",
    "argument_names",
    "behavior_tree_schema_text",
    "doubts_about",
    "make_plan",
    "node_name",
    "plan_schema",
    "plan_schema_text",
    "port_name",
    "to_behavior_tree",
]
