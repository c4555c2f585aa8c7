"""Hyperparameters, declared on a frozen dataclass, read from JSON and shown in a form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import Field, dataclass, field, fields
from typing import Any, TypeAlias, TypeVar

from annotations.language.texts import Refusal

C = TypeVar("C")
Value: TypeAlias = "bool | int | float | str"


@dataclass(frozen=True, slots=True)
class ConfigField:
    """One hyperparameter as a form shows it. ``type`` is bool, int, float or str.

    ``is_required`` marks a text that has no default and has to be given before a parser can be trained;
    ``longest`` is the most characters of a text. ``finds`` marks a text that names pretrained weights: it is called
    with the name, the installation's folder of encoders, and whether other places may be looked at, and raises
    Refusal where there are none.
    """

    name: str
    type: type
    default: Value
    description: str
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    is_required: bool = False
    longest: int | None = None
    finds: Callable[..., Any] | None = None


def hyperparameter(
    default: Value,
    description: str,
    minimum: float | None = None,
    maximum: float | None = None,
    choices: tuple[str, ...] = (),
    is_required: bool = False,
    longest: int | None = None,
    finds: Callable[..., Any] | None = None,
) -> Any:
    """Declare a dataclass field with its description and its bounds (both included)."""
    bounds = {"minimum": minimum, "maximum": maximum, "choices": choices}
    demands = {"is_required": is_required, "longest": longest, "finds": finds}
    return field(default=default, metadata={"description": description, **bounds, **demands})


def describe(config_class: type) -> tuple[ConfigField, ...]:
    """Return the hyperparameters of a config dataclass, in order."""
    described = []
    for item in _declared_fields(config_class):
        default: Any = item.default
        described.append(ConfigField(item.name, type(default), default, **item.metadata))
    return tuple(described)


def validate(config: Any) -> None:
    """Check every field of ``config`` against its declaration, for ``__post_init__``.

    Where a fraction is expected, a whole number is taken, and stored as a fraction.
    Raises Refusal naming the field, the value and what is allowed.
    """
    for declared in describe(type(config)):
        value = getattr(config, declared.name)
        if declared.type is float and type(value) is int:
            value = float(value)
            object.__setattr__(config, declared.name, value)
        if fault := _fault(declared, value):
            raise Refusal(
                f"{declared.name} is {value!r}, but {fault}.", "hyperparameter_out_of_range"
            )


def refuse_empty(config: Any, field: str) -> None:
    """Refuse a configuration without weights that the parser needs: without them it would be another
    parser of the same name. Raises Refusal."""
    if not getattr(config, field).strip():
        raise Refusal(
            f"{field} is empty, but this parser needs it. Name the weights to read.",
            "hyperparameter_missing",
        )


def refuse_unnamed(config: Any) -> None:
    """Refuse a configuration that lacks a required hyperparameter. Raises Refusal."""
    for declared in describe(type(config)):
        if declared.is_required and not getattr(config, declared.name).strip():
            raise Refusal(
                f"{declared.name} is empty. {declared.description}", "hyperparameter_missing"
            )


def read_config(config_class: type[C], values: Mapping[str, Any]) -> C:
    """Make a config from JSON ``values``, with defaults. Raises Refusal."""
    known = [item.name for item in _declared_fields(config_class)]
    if unknown := sorted(set(values) - set(known)):
        names = ", ".join(unknown)
        raise Refusal(
            f"No hyperparameter is called {names}; there are: {', '.join(known)}.",
            "unknown_hyperparameter",
        )
    return config_class(**values)


def _declared_fields(config_class: type) -> list[Field[Any]]:
    return [item for item in fields(config_class) if "description" in item.metadata]


def _fault(declared: ConfigField, value: Value) -> str:
    """Return what is wrong with ``value``, as the end of a sentence; empty where it is allowed."""
    if type(value) is not declared.type:
        kinds = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
        return f"it has to be {kinds[declared.type]}"
    if declared.choices and value not in declared.choices:
        return f"it has to be one of {', '.join(declared.choices)}"
    if isinstance(value, str):
        if declared.longest is not None and len(value) > declared.longest:
            return f"it may have at most {declared.longest} characters"
        return ""
    # Written this way round, NaN is outside every bound.
    if declared.minimum is not None and not value >= declared.minimum:
        return f"it has to be at least {declared.minimum:g}"
    if declared.maximum is not None and not value <= declared.maximum:
        return f"it has to be at most {declared.maximum:g}"
    return ""
