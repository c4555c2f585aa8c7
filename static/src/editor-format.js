// Puts both sides of a template into the canonical layout, which the server's printer gives.

// The place in `next` behind as many characters other than spaces as `at` has before it in `text`.
function placeIn(next, text, at) {
  let left = text.slice(0, at).replace(/\s/g, "").length;
  let index = 0;
  while (index < next.length && left > 0) {
    if (/\S/.test(next[index])) left -= 1;
    index += 1;
  }
  return index;
}

/** Ask for the layout of what is there now and take it over. */
export async function format(checker) {
  const answer = await checker.send();
  for (const { field, view } of checker.editors) {
    const text = view.state.doc.toString();
    const next = answer?.formatted?.[field.name] ?? text;
    if (next === text) continue;
    view.dispatch({
      changes: { from: 0, to: text.length, insert: next },
      selection: { anchor: placeIn(next, text, view.state.selection.main.head) },
      userEvent: "input.format",
    });
  }
}
