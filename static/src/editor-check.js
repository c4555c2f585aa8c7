// Asks the server what it thinks of a form's fields and shows the answer under each editor.
import { setDiagnostics } from "@codemirror/lint";
import { declareButton } from "./editor-declare.js";
import { format } from "./editor-format.js";
import { applyRepair, repairButtons } from "./editor-repairs.js";
import { lightSlot, showSlots } from "./editor-slots.js";
import { tokenEnd } from "./symbols.js";

const WAIT = 350;
const checkers = new WeakMap();

/** The checker of a form; its editors share one question to the server. */
export function checkerOf(form) {
  if (!checkers.has(form)) checkers.set(form, new Checker(form));
  return checkers.get(form);
}

function piece(text, className) {
  const made = document.createElement("span");
  made.className = className;
  made.textContent = text;
  return made;
}

class Checker {
  constructor(form) {
    this.form = form;
    this.address = form.closest("[data-check-url]")?.dataset.checkUrl;
    this.editors = [];
    this.timer = 0;
    this.asked = 0;
    this.answer = null; // of the texts that are there now; null while the server is being asked
    // Every field counts, the task category too: what is right depends on its grammar.
    form.addEventListener("input", () => this.ask());
    form.querySelector("[data-format]")?.addEventListener("click", () => format(this));
  }

  add(field, view, place) {
    const report = document.createElement("div");
    report.className = "editor-report";
    report.setAttribute("aria-live", "polite");
    place.append(report);
    this.editors.push({ field, view, report });
    this.ask();
  }

  ask() {
    if (!this.address) return;
    this.answer = null;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send(), WAIT);
  }

  /** Ask at once. Returns the answer, or null where there is none or the text has changed meanwhile. */
  async send() {
    clearTimeout(this.timer);
    const asked = ++this.asked;
    const answer = await this.fetch();
    if (asked !== this.asked) return null; // an older answer than the text
    this.answer = answer;
    this.editors.forEach((editor) => this.show(editor, answer));
    this.editors.forEach(({ view }) => view.requestMeasure()); // the lines above may have moved it
    return answer;
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

  /** Make the edits of a repair, if they are about the texts as they are now. */
  repair(repair) {
    if (this.answer) applyRepair(this.editors, repair);
  }

  /** Take the first repair of the problems of `field`, or else of any other. */
  async repairFirst(field) {
    const answer = this.answer ?? (await this.send());
    const problems = (answer?.problems ?? []).filter((problem) => problem.repairs.length);
    const problem = problems.find((each) => each.field === field.name) ?? problems[0];
    if (problem) this.repair(problem.repairs[0]);
  }

  /** Everything that looks at the form looks again: something outside of it has changed. */
  look() {
    this.form.dispatchEvent(new Event("input", { bubbles: true }));
  }

  /** Light a slot (its number in the answer, -1 for none) in every editor. */
  light(slot) {
    this.editors.forEach(({ view }) => lightSlot(view, slot));
  }

  show({ field, view, report }, answer) {
    if (!answer) {
      report.textContent = "The checker does not answer. What you typed is kept here.";
      return;
    }
    const problems = answer.problems.filter((problem) => problem.field === field.name);
    view.dispatch(setDiagnostics(view.state, problems.map((problem) => this.diagnostic(view, problem))));
    showSlots(view, (answer.slots ?? []).map((slot) => slot[field.name]));
    const list = document.createElement("ul");
    list.append(...problems.map((problem) => this.line(problem)));
    const isForm = field.dataset.editor === "form";
    const gloss = isForm && !problems.length ? [answer.gloss ?? ""] : [];
    report.replaceChildren(list, ...gloss);
  }

  diagnostic(view, problem) {
    const text = view.state.doc.toString();
    const from = Math.min(problem.at, text.length);
    const actions = problem.repairs.map((repair) => ({ name: repair.label, apply: () => this.repair(repair) }));
    const { severity, message } = problem;
    return { from, to: Math.min(tokenEnd(text, from), text.length), severity, message, actions };
  }

  /** The hint; a link where it is about the productions of a task category. */
  hint({ hint, task_category: category }) {
    const url = this.form.dataset.productionsUrl;
    const made = piece(hint, "hint");
    if (!category || !url) return made;
    const link = document.createElement("a");
    link.href = `${url}?${new URLSearchParams({ task_category: category })}`;
    link.textContent = hint;
    made.replaceChildren(link);
    return made;
  }

  line(problem) {
    const line = document.createElement("li");
    line.append(piece(`${problem.line}:${problem.column} ${problem.message}`, problem.severity));
    if (problem.hint) line.append(" ", this.hint(problem));
    line.append(...repairButtons(problem, (repair) => this.repair(repair)));
    if (problem.declaration) line.append(declareButton(this.form, problem.declaration, () => this.look()));
    return line;
  }
}
