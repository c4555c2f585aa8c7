// Asks the server what it thinks of a form's fields and shows the answer under each editor.
import { setDiagnostics } from "@codemirror/lint";
import { EditorView } from "@codemirror/view";

const WAIT = 350;
const checkers = new WeakMap();

/** The checker of a form; its editors share one question to the server. */
export function checkerOf(form) {
  if (!checkers.has(form)) checkers.set(form, new Checker(form));
  return checkers.get(form);
}

function offsetOf(doc, line, column) {
  const found = doc.line(Math.min(Math.max(line ?? 1, 1), doc.lines));
  return Math.min(found.from + Math.max((column ?? 1) - 1, 0), found.to);
}

function diagnosticOf(doc, problem) {
  const from = offsetOf(doc, problem.line, problem.column);
  const end = problem.end_column ? offsetOf(doc, problem.line, problem.end_column) : from + 1;
  const to = Math.min(Math.max(end, from), doc.length);
  return { from: Math.min(from, to), to, severity: problem.severity, message: problem.message };
}

function piece(text, className) {
  const made = document.createElement("span");
  made.className = className;
  made.textContent = text;
  return made;
}

function lineOf(problem) {
  const line = document.createElement("li");
  line.append(piece(`${problem.line ?? 1}:${problem.column ?? 1} ${problem.message}`, problem.severity));
  if (problem.hint) line.append(" ", piece(problem.hint, "hint"));
  if (problem.repair) line.append(" ", piece(`Alt+Enter: ${problem.repair.label}`, "hint"));
  return line;
}

class Checker {
  constructor(form) {
    this.form = form;
    this.address = form.closest("[data-check-url]")?.dataset.checkUrl;
    this.editors = [];
    this.timer = 0;
    this.asked = 0;
  }

  extension(field) {
    return EditorView.updateListener.of((update) => update.docChanged && this.ask(field));
  }

  add(field, view, place) {
    const report = document.createElement("div");
    report.className = "editor-report";
    report.setAttribute("aria-live", "polite");
    place.append(report);
    this.editors.push({ field, view, report, problems: [] });
    this.ask(field);
  }

  ask() {
    if (!this.address) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send(), WAIT);
  }

  async send() {
    const asked = ++this.asked;
    const answer = await this.fetch();
    if (asked !== this.asked) return; // an older answer than the text
    this.editors.forEach((editor) => this.show(editor, answer));
  }

  async fetch() {
    try {
      const answer = await fetch(this.address, {
        method: "POST",
        body: new FormData(this.form),
        headers: { Accept: "application/json" },
      });
      return answer.ok && !answer.redirected ? await answer.json() : null;
    } catch {
      return null;
    }
  }

  show(editor, answer) {
    const { field, view, report } = editor;
    if (!answer) {
      report.textContent = "The checker does not answer. What you typed is kept here.";
      return;
    }
    editor.problems = answer.problems.filter((problem) => (problem.field ?? field.name) === field.name);
    const diagnostics = editor.problems.map((problem) => diagnosticOf(view.state.doc, problem));
    view.dispatch(setDiagnostics(view.state, diagnostics));
    const list = document.createElement("ul");
    list.append(...editor.problems.map(lineOf));
    const isForm = field.dataset.editor === "form";
    const gloss = isForm && !editor.problems.length ? [answer.gloss ?? ""] : [];
    report.replaceChildren(list, ...gloss);
  }

  /** Take the repair of the problem nearest to the caret; false where there is none. */
  repair(field, view) {
    const editor = this.editors.find((each) => each.field === field);
    const caret = view.state.selection.main.head;
    const distance = (problem) => Math.abs(offsetOf(view.state.doc, problem.line, problem.column) - caret);
    const offered = editor.problems.filter((problem) => problem.repair).sort((a, b) => distance(a) - distance(b));
    if (!offered.length) return false;
    const insert = offered[0].repair.text;
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert }, userEvent: "input.repair" });
    return true;
  }
}
