// The symbols of forms and patterns as the eye reads them. For display only: what is right or wrong
// the checker says.
const NO_ENTITY = new Set(["void", "pron"]);
// Other names of a class. What classes a world has, its style sheet says: others have no colour.
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
  return NO_ENTITY.has(word) ? "" : (ALIASES[word] ?? word);
}

// What comes first in this list wins where two could begin at one place.
const PARTS = [
  /(?<slot>\{[^{}]*\}|<\w+>|⟨\w+⟩)/,
  /(?<token>"\s*<\w+>\s*")/, // a class token as corpus notation writes it
  /(?<nonterminal>\$[A-Za-z]\w*)/,
  /(?<variable>\$\d+)/,
  /(?<lambda>λ|\blambda\b)/,
  /(?<unknown>\bUNKNOWN\b)/,
  /(?<bracket>[()[\]])/,
  /(?<quoted>"[^"]*"|“[^“”]*”)/,
  /(?<letter>\b[a-z]\d?\b(?!\s*\())/, // a variable of the reading notation
  /(?<name>[A-Za-z_][\w-]*)/,
];

export const TOKEN = new RegExp(PARTS.map((part) => part.source).join("|"), "g");

/** Where the symbol that begins at `from` ends; at least one character further. */
export function tokenEnd(text, from) {
  const match = text.slice(from).match(new RegExp(`^(?:${TOKEN.source})`));
  return from + Math.max(match?.[0].length ?? 1, 1);
}
