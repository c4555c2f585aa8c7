// Gives the text of a form its hues and pairs its brackets, inside whatever marks a diff has put there.
import { TOKEN, classOf } from "./symbols.js";

function span(className, text, dataset = {}) {
  const made = document.createElement("span");
  made.className = className;
  made.textContent = text;
  Object.assign(made.dataset, dataset);
  return made;
}

function pieceOf(match, brackets) {
  const groups = match.groups;
  const text = match[0];
  if (groups.slot || groups.token) return span("lf-slot", text, { class: classOf(text) });
  if (groups.nonterminal) return span("lf-nonterminal", text);
  if (groups.variable || groups.letter) return span("lf-variable", text);
  if (groups.lambda) return span("lf-variable", text);
  if (groups.unknown) return span("lf-unknown", text);
  if (groups.bracket) return span("lf-bracket", text, { pair: brackets.pairOf(text) });
  if (groups.name && brackets.isHead()) return span("lf-head", text);
  return document.createTextNode(text);
}

class Brackets {
  open = [];
  count = 0;
  head = true;

  pairOf(text) {
    if (text === "(" || text === "[") {
      this.open.push(this.count);
      return this.count++;
    }
    return this.open.pop() ?? this.count++;
  }

  // The first name of a form is its head predicate.
  isHead() {
    const was = this.head;
    this.head = false;
    return was;
  }
}

function decorate(node, brackets) {
  const text = node.data;
  const pieces = document.createDocumentFragment();
  let end = 0;
  for (const match of text.matchAll(TOKEN)) {
    pieces.append(text.slice(end, match.index), pieceOf(match, brackets));
    end = match.index + match[0].length;
  }
  pieces.append(text.slice(end));
  node.replaceWith(pieces);
}

export function onFormText(code) {
  const walker = document.createTreeWalker(code, NodeFilter.SHOW_TEXT);
  const nodes = [];
  while (walker.nextNode()) nodes.push(walker.currentNode);
  const brackets = new Brackets();
  nodes.forEach((node) => decorate(node, brackets));
}
