// One line of a pattern, or a form: CodeMirror in the place of a textarea, which stays the field that
// is sent. The server's checker is asked, debounced, and is the only authority.
import { closeBrackets, closeBracketsKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { bracketMatching } from "@codemirror/language";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, keymap, placeholder } from "@codemirror/view";
import { lintKeymap } from "@codemirror/lint";
import { checkerOf } from "./editor-check.js";
import { completion } from "./editor-completion.js";
import { format } from "./editor-format.js";
import { highlighting } from "./editor-highlight.js";
import { slotLighting } from "./editor-slots.js";
import { grow, shrink } from "./editor-structure.js";
import { pressSend } from "./sending.js";

const nonce = () => document.querySelector('meta[name="csp-nonce"]')?.nonce ?? "";

// Blanks that only look like one, and what shows nothing: the server writes a plain blank, or nothing, too.
const ODD_BLANK = /[\u00a0\u1680\u2000-\u200a\u202f\u205f\u2800\u3000]/g;
const INVISIBLE = /[\u00ad\u200b-\u200f\u202a-\u202e\u2060-\u2064\ufeff]/g;
const plain = (text) => text.replace(ODD_BLANK, " ").replace(INVISIBLE, "");

const plainBlanks = EditorState.transactionFilter.of((transaction) => {
  const text = transaction.docChanged ? transaction.newDoc.toString() : "";
  if (plain(text) === text) return transaction;
  return {
    changes: { from: 0, to: transaction.startState.doc.length, insert: plain(text) },
    selection: { anchor: plain(text.slice(0, transaction.newSelection.main.head)).length },
  };
});

// A pattern is one line: a line break in what is pasted becomes a space.
const oneLine = EditorState.transactionFilter.of((transaction) => {
  if (transaction.newDoc.lines === 1) return transaction;
  const lines = transaction.newDoc.toString().split("\n");
  const text = lines.map((line) => line.trim()).filter(Boolean).join(" ");
  return {
    changes: { from: 0, to: transaction.startState.doc.length, insert: text },
    selection: { anchor: Math.min(transaction.newSelection.main.head, text.length) },
  };
});

function send(field, hasShift) {
  if (!pressSend(field.form, hasShift)) field.form?.requestSubmit();
  return true;
}

// No keyboard has a λ; a backslash means nothing in a form.
const lambdaKey = EditorView.inputHandler.of((view, from, to, text) => {
  if (text !== "\\") return false;
  view.dispatch({ changes: { from, to, insert: "λ" }, selection: { anchor: from + 1 }, userEvent: "input.type" });
  return true;
});

const BRACKETS = EditorState.languageData.of(() => [{ closeBrackets: { brackets: ["(", "{", '"'] } }]);

function keysFor(field, checker) {
  return [
    { key: "Mod-Enter", run: () => send(field, false) },
    { key: "Mod-Shift-Enter", run: () => send(field, true) },
    { key: "Mod-.", run: () => Boolean(checker.repairFirst(field)) },
    { key: "Mod-i", run: grow, preventDefault: true },
    { key: "Alt-ArrowUp", run: grow, preventDefault: true },
    { key: "Alt-ArrowDown", run: shrink, preventDefault: true },
    { key: "Alt-Shift-f", run: () => Boolean(format(checker)), preventDefault: true },
  ];
}

function extensionsFor(field, checker) {
  const isPattern = field.dataset.editor === "pattern";
  return [
    EditorView.cspNonce.of(nonce()),
    EditorView.lineWrapping,
    EditorView.contentAttributes.of({
      "aria-label": field.labels[0]?.textContent.trim() ?? field.name,
      spellcheck: "false",
      autocapitalize: "off",
    }),
    history(),
    drawSelection(),
    bracketMatching(),
    closeBrackets(),
    BRACKETS,
    highlighting,
    placeholder(field.placeholder),
    plainBlanks,
    isPattern ? oneLine : lambdaKey,
    completion(field, checker),
    slotLighting((slot) => checker.light(slot)),
    // Tab is left alone: it leaves the editor, as in any field.
    keymap.of([
      ...keysFor(field, checker),
      { key: "Enter", run: () => isPattern }, // one line, and a half-filled form is not sent
      ...closeBracketsKeymap,
      ...lintKeymap,
      ...historyKeymap,
      ...defaultKeymap,
    ]),
    EditorView.updateListener.of((update) => {
      if (!update.docChanged) return;
      field.value = update.state.doc.toString();
      field.dispatchEvent(new Event("input", { bubbles: true }));
    }),
  ];
}

function replaceText(view, text) {
  if (view.state.doc.toString() === text) return;
  view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
}

export function enhance(field) {
  const checker = checkerOf(field.form ?? field);
  const view = new EditorView({
    state: EditorState.create({ doc: field.value, extensions: extensionsFor(field, checker) }),
  });
  const place = document.createElement("div");
  place.className = "editor";
  place.append(view.dom);
  const hasFocus = document.activeElement === field;
  field.after(place);
  field.hidden = true;
  if (hasFocus) view.focus(); // somebody was quicker than this module
  field.required = false; // a hidden field cannot be pointed at; the server says that it is missing
  field.addEventListener("draft:restored", () => replaceText(view, field.value));
  field.labels.forEach((label) => label.addEventListener("click", () => view.focus()));
  checker.add(field, view, place);
}
