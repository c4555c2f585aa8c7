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
    OpenArgument,
    OpenValue,
    Operator,
    Plan,
    PlanOf,
    PlanProblem,
    Referred,
    SaidWords,
    Step,
    StepResult,
    TaskValue,
    Trouble,
    Unresolved,
    Value,
    Words,
    behavior_tree_schema_text,
    plan_schema,
    plan_schema_text,
)
from annotations.language.plans.planning import argument_names, make_plan
from annotations.language.plans.unresolved import COMMAND, said_words

__all__ = [
    "ASK",
    "AT",
    "COMMAND",
    "TAKEN_NAMES",
    "ActionName",
    "Condition",
    "Described",
    "Lookup",
    "Named",
    "Number",
    "OpenArgument",
    "OpenValue",
    "Operator",
    "Plan",
    "PlanOf",
    "PlanProblem",
    "Referred",
    "Robust",
    "SaidWords",
    "Step",
    "StepResult",
    "TaskValue",
    "Trouble",
    "Unresolved",
    "Value",
    "Words",
    "argument_names",
    "behavior_tree_schema_text",
    "make_plan",
    "node_name",
    "plan_schema",
    "plan_schema_text",
    "port_name",
    "said_words",
    "to_behavior_tree",
]
