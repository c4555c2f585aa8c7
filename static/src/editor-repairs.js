// The repairs that the checker offers: buttons beside a problem, and the edits they make.

/** Make the edits of a repair in the editors of their fields, and go to the first of them. */
export function applyRepair(editors, repair) {
  let first = null;
  for (const { field, view } of editors) {
    const changes = repair.edits
      .filter((edit) => edit.field === field.name)
      .map(({ from, to, text }) => ({ from, to, insert: text }));
    if (!changes.length) continue;
    const last = changes.reduce((a, b) => (a.from > b.from ? a : b));
    view.dispatch({ changes, userEvent: "input.repair" });
    if (!first) {
      const shift = changes.reduce((sum, each) => sum + each.insert.length - (each.to - each.from), 0);
      view.dispatch({ selection: { anchor: last.to + shift } });
      first = view;
    }
  }
  first?.focus();
}

/** One button for each repair of a problem; `take` is called with the repair. */
export function repairButtons(problem, take) {
  return problem.repairs.map((repair, number) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "small-button repair";
    button.textContent = repair.label;
    if (number === 0) button.title = "Ctrl+.";
    button.addEventListener("click", () => take(repair));
    return button;
  });
}
