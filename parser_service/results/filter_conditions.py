"""What a filter demands: of rows of predictions, and of columns of values where these say it."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from django.db.models import Q
from numpy.typing import NDArray

from parser_service.analysis.arrays import Bools
from parser_service.analysis.encoded_labels import EncodedLabels

OF_EXAMPLE = "example__"
OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "exact": operator.eq,
    "gte": operator.ge,
    "lte": operator.le,
    "gt": operator.gt,
}
Columns = Mapping[str, "NDArray[Any] | EncodedLabels[str]"]


class NoColumn(Exception):
    """Columns do not have what a condition is about; the rows have to be asked."""


@dataclass(frozen=True, slots=True)
class FilterCondition:
    """``rows`` is the condition on predictions. ``columns`` says the same with names of columns; the paths of
    ``rows`` are such names already unless it is given."""

    rows: Q
    columns: Q | None = None

    def mask(self, columns: Columns) -> Bools:
        """Return for which examples it holds, [examples].

        Args:
            columns: path of ``Prediction`` or, without ``example__``, of ``Example`` → values or texts, [examples].

        Raises:
            NoColumn: no column tells.
        """
        return mask_of(self.rows if self.columns is None else self.columns, columns)


def mask_of(condition: Q, columns: Columns) -> Bools:
    """Return where a condition of plain comparisons holds, [examples]. Raises NoColumn."""
    masks = [_mask_of_child(child, columns) for child in condition.children]
    if condition.connector not in (Q.AND, Q.OR) or not masks:
        raise NoColumn(str(condition))
    joined: Bools = (np.logical_and if condition.connector == Q.AND else np.logical_or).reduce(
        masks
    )
    return ~joined if condition.negated else joined


def _mask_of_child(child: Any, columns: Columns) -> Bools:
    if isinstance(child, Q):
        return mask_of(child, columns)
    if not isinstance(child, tuple):
        raise NoColumn(str(child))
    path, value = child
    name, _, lookup = path.removeprefix(OF_EXAMPLE).partition("__")
    column = columns.get(name)
    compare = OPERATORS.get(lookup or "exact")
    if column is None or compare is None:
        raise NoColumn(path)
    if isinstance(column, EncodedLabels):
        code = column.values.index(value) if value in column.values else -1
        return np.asarray(column.codes == code)
    return np.asarray(compare(column, value), dtype=bool)
