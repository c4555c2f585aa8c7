// The symbols of forms and patterns as the eye reads them. For display only: what is right or wrong
// the checker says.
const CLASSES = new Set(["object", "category", "name", "location", "room", "gesture", "question", "whattosay"]);
const ALIASES = {
  kobject: "object",
  aobject: "object",
  sobject: "object",
  placement: "location",
  beacon: "location",
  male: "name",
  female: "name",
};

/** The entity class of a slot such as `{placement 1}`, `<object>` or `⟨room⟩`; "" where it has none. */
export function classOf(slot) {
  const [word, type] = slot.replace(/^[{<⟨"\s]+/, "").split(/[\s?:}>⟩\d"]+/);
  if (word === "location" && type === "room") return "room";
  const name = ALIASES[word] ?? word;
  return CLASSES.has(name) ? name : "";
}

// In order: a slot, a class token in quotes (corpus notation), a nonterminal, a numbered variable, a λ, the unknown form, a bracket, a quoted
// constant, a variable of the reading notation, any other name.
export const TOKEN =
  /(?<slot>\{[^{}]*\}|<\w+>|⟨\w+⟩)|(?<token>"\s*<\w+>\s*")|(?<nonterminal>\$[A-Za-z]\w*)|(?<variable>\$\d+)|(?<lambda>λ|\blambda\b)|(?<unknown>\bUNKNOWN\b)|(?<bracket>[()[\]])|(?<quoted>"[^"]*"|“[^”]*”)|(?<letter>\b[a-z]\d?\b(?!\s*\())|(?<name>[A-Za-z_][\w-]*)/g;
