// Completes nonterminals, wildcards and predicates. What there is the server says once for each task
// category; what the other side of the template has comes first.
import { autocompletion } from "@codemirror/autocomplete";

const SLOT = /\$[A-Za-z]\w*|\{[^{}]*\}/g;
const answers = new Map(); // address → promise of the answer

/** Ask again for what there is: something was declared. */
export const forgetOffers = () => answers.clear();

function offers(field) {
  const form = field.form;
  const category = form?.elements.namedItem("task_category")?.value;
  const address = form?.dataset.completionUrl?.replace("/0/", `/${category}/`);
  if (!address || !category) return Promise.resolve(null);
  if (!answers.has(address)) {
    const answer = fetch(address, { headers: { Accept: "application/json" } })
      .then((response) => (response.ok && !response.redirected ? response.json() : null))
      .catch(() => null);
    answers.set(address, answer);
    answer.then((got) => got || answers.delete(address)); // ask again next time
  }
  return answers.get(address);
}

function otherSlots(field, checker) {
  const other = checker.editors.find((editor) => editor.field !== field);
  return new Set(other?.view.state.doc.toString().match(SLOT) ?? []);
}

// A bracket that was closed by itself is written over.
const writing = (text, closing) => (view, completion, from, to) => {
  const next = view.state.doc.sliceString(to, to + 1);
  const end = closing && next === closing ? to + 1 : to;
  view.dispatch({
    changes: { from, to: end, insert: text },
    selection: { anchor: from + text.length },
    userEvent: "input.complete",
  });
};

function option(each, type, slots, text = each.text) {
  return {
    label: each.text,
    detail: each.detail,
    info: each.info || undefined,
    type,
    boost: slots.has(each.text) ? 50 : 0,
    apply: writing(text, type === "wildcard" ? "}" : ""),
  };
}

// People type the word for a sign that no keyboard has.
const lambda = {
  label: "lambda",
  displayLabel: "λ$1:e",
  detail: "what is described by the conditions in it",
  boost: 60,
  apply: writing("λ$1:e "),
};

const variable = (text) => ({ label: text, detail: "the variable of a λ", boost: 60 });

const bound = (text) => [...new Set([...text.matchAll(/(?:λ|lambda)\s*(\$\d+)/g)].map((match) => match[1]))];

function optionsAt(isForm, before, doc, offered, slots) {
  const nonterminals = offered.nonterminals.map((each) => option(each, "nonterminal", slots));
  const braces = isForm ? offered.wildcards : [...offered.wildcards, ...offered.conditions];
  const wildcards = braces.map((each) => option(each, "wildcard", slots));
  const variables = isForm ? bound(doc).map(variable) : [];
  const heads = offered.predicates.map((each) => option(each, "predicate", slots, `${each.text} `));
  const predicates = isForm ? [lambda, ...heads] : [];
  if (before.startsWith("$")) return [...variables, ...nonterminals];
  if (before.startsWith("{")) return wildcards;
  if (before.startsWith("(") && isForm) return predicates;
  return [...variables, ...wildcards, ...nonterminals, ...predicates];
}

function sourceFor(field, checker) {
  const isForm = field.dataset.editor === "form";
  return async (context) => {
    const word = context.matchBefore(isForm ? /\$\w*|\{[\w ]*|\([\w-]*/ : /\$\w*|\{[\w ]*/);
    const name = context.matchBefore(/\w*/);
    if (!word && !context.explicit) return null;
    const offered = await offers(field);
    if (!offered) return null;
    const before = word?.text ?? "";
    const from = word ? word.from + (before.startsWith("(") ? 1 : 0) : name?.from ?? context.pos;
    const options = optionsAt(isForm, before, context.state.doc.toString(), offered, otherSlots(field, checker));
    return { from, options, validFor: /^[\w$ {-]*$/ };
  };
}

export function completion(field, checker) {
  offers(field); // so that the first list is there at once
  return autocompletion({ override: [sourceFor(field, checker)], icons: false });
}
