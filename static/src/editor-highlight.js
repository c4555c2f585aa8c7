// Hues for λ, nonterminals, wildcards and class tokens, line by line.
import { Decoration, ViewPlugin } from "@codemirror/view";
import { RangeSetBuilder } from "@codemirror/state";
import { TOKEN, classOf } from "./symbols.js";

const marks = Object.fromEntries(
  ["bracket", "lambda", "variable", "nonterminal", "unknown"].map((name) => [
    name,
    Decoration.mark({ class: `tok-${name}` }),
  ]),
);

function slotMark(text) {
  const attributes = { "data-class": classOf(text) };
  return Decoration.mark({ class: "tok-slot", attributes });
}

function markOf(groups, text) {
  if (groups.slot || groups.token) return slotMark(text);
  const name = Object.keys(marks).find((key) => groups[key]);
  return name && marks[name];
}

function decorationsOf(view) {
  const builder = new RangeSetBuilder();
  for (const { from, to } of view.visibleRanges) {
    const text = view.state.doc.sliceString(from, to);
    for (const match of text.matchAll(TOKEN)) {
      const mark = markOf(match.groups, match[0]);
      if (mark) builder.add(from + match.index, from + match.index + match[0].length, mark);
    }
  }
  return builder.finish();
}

export const highlighting = ViewPlugin.fromClass(
  class {
    constructor(view) {
      this.decorations = decorationsOf(view);
    }

    update(update) {
      if (update.docChanged || update.viewportChanged) this.decorations = decorationsOf(update.view);
    }
  },
  { decorations: (plugin) => plugin.decorations },
);
