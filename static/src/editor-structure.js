// Grows and shrinks the selection by what stands together: a token, a subterm, the whole text. It counts
// brackets alone, so that it works in a text that is not finished.
import { TOKEN } from "./symbols.js";

const PAIRS = { "(": ")", "[": "]" };
const earlier = new WeakMap(); // view → the selections that were grown from

function partsOf(text) {
  const parts = [{ from: 0, to: text.length }];
  const open = [];
  for (const match of text.matchAll(TOKEN)) {
    const [from, to] = [match.index, match.index + match[0].length];
    if (PAIRS[match[0]]) open.push(from);
    else if (match.groups.bracket) {
      if (open.length) parts.push({ from: open.pop(), to });
    } else parts.push({ from, to });
  }
  return parts;
}

function select(view, { from, to }) {
  view.dispatch({ selection: { anchor: from, head: to }, userEvent: "select" });
}

export function grow(view) {
  const { from, to } = view.state.selection.main;
  const around = partsOf(view.state.doc.toString()).filter(
    (part) => part.from <= from && to <= part.to && part.to - part.from > to - from,
  );
  if (!around.length) return true;
  const smallest = around.reduce((a, b) => (b.to - b.from < a.to - a.from ? b : a));
  const stack = earlier.get(view)?.filter((each) => from <= each.from && each.to <= to) ?? [];
  earlier.set(view, [...stack, { from, to }]);
  select(view, smallest);
  return true;
}

export function shrink(view) {
  const { from, to } = view.state.selection.main;
  const stack = earlier.get(view) ?? [];
  const inner = stack.pop();
  if (inner && from <= inner.from && inner.to <= to) select(view, inner);
  return true;
}
