// The tree of a form, drawn from its corpus notation: ( find ( lambda $1 e ( is_a $1 " <object> " ) ) ).
import { hierarchy, tree as layOut } from "d3-hierarchy";
import { classOf } from "./symbols.js";

const SVG = "http://www.w3.org/2000/svg";
const NODE_HEIGHT = 22;
const ROW_HEIGHT = 52;
const GAP = 14;
const CHARACTER = 7.4;

function tokensOf(text) {
  return text.match(/"[^"]*"|\{[^{}]*\}|[()]|[^\s()"]+/g) ?? [];
}

function leaf(token) {
  if (token.startsWith('"')) {
    const text = token.slice(1, -1).trim();
    return { label: text, kind: "constant", entityClass: text.startsWith("<") ? classOf(text) : "", children: [] };
  }
  if (token.startsWith("{")) return { label: token, kind: "slot", entityClass: classOf(token), children: [] };
  const kind = /^\$\d/.test(token) ? "variable" : token.startsWith("$") ? "nonterminal" : "name";
  return { label: token, kind, entityClass: "", children: [] };
}

function branch(children) {
  const [head, ...rest] = children;
  if (!head) return leaf("()");
  if (head.label === "lambda") {
    const [variable, , ...bodies] = rest;
    return { label: `λ${variable?.label ?? ""}`, kind: "lambda", entityClass: "", children: bodies };
  }
  return { label: head.label, kind: "predicate", entityClass: "", children: [...head.children, ...rest] };
}

/** The form as nested nodes; a text with unbalanced brackets gives what could be read of it. */
function readTree(text) {
  const stack = [[]];
  for (const token of tokensOf(text)) {
    if (token === "(") stack.push([]);
    else if (token === ")" && stack.length > 1) {
      const children = stack.pop();
      stack.at(-1).push(branch(children));
    } else if (token !== ")") stack.at(-1).push(leaf(token));
  }
  while (stack.length > 1) {
    const children = stack.pop();
    stack.at(-1).push(branch(children));
  }
  return stack[0][0] ?? leaf("()");
}

function element(name, attributes, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const widthOf = (node) => node.data.label.length * CHARACTER + 14;

function drawEdge({ source, target }) {
  const [top, bottom] = [source.y + NODE_HEIGHT / 2, target.y - NODE_HEIGHT / 2];
  const middle = (top + bottom) / 2;
  return element("path", {
    class: "edge",
    d: `M${source.x},${top}C${source.x},${middle} ${target.x},${middle} ${target.x},${bottom}`,
  });
}

function drawNode(node) {
  const width = widthOf(node);
  const attributes = { class: `node node--${node.data.kind}`, transform: `translate(${node.x},${node.y})` };
  if (node.data.entityClass) attributes["data-class"] = node.data.entityClass;
  if (node.data.change) attributes["data-change"] = node.data.change;
  return element(
    "g",
    attributes,
    element("rect", { x: -width / 2, y: -NODE_HEIGHT / 2, width, height: NODE_HEIGHT, rx: 4 }),
    element("text", {}, node.data.label),
  );
}

function draw(root) {
  const placed = layOut()
    .nodeSize([1, ROW_HEIGHT])
    .separation((a, b) => (widthOf(a) + widthOf(b)) / 2 + GAP)(root);
  const nodes = placed.descendants();
  const left = Math.min(...nodes.map((node) => node.x - widthOf(node) / 2)) - 1;
  const right = Math.max(...nodes.map((node) => node.x + widthOf(node) / 2)) + 1;
  const height = placed.height * ROW_HEIGHT + NODE_HEIGHT + 2;
  const width = right - left;
  return element(
    "svg",
    { width, height, viewBox: `${left} ${-NODE_HEIGHT / 2 - 1} ${width} ${height}`, "aria-hidden": "true" },
    ...placed.links().map(drawEdge),
    ...nodes.map(drawNode),
  );
}

// Nodes that the server has compared already: each says what happened to it.
function readNodes(node) {
  const isToken = node.kind === "constant" && node.label.startsWith("<");
  return { ...node, entityClass: isToken ? classOf(node.label) : "", children: node.children.map(readNodes) };
}

export function enhance(figure) {
  const { tree, treeNodes } = figure.dataset;
  figure.append(draw(hierarchy(treeNodes ? readNodes(JSON.parse(treeNodes)) : readTree(tree))));
}
