// Logical forms on the page: hues and brackets, the notation, copying, the tree.
import { copyText, noteBeside } from "./copying.js";
import { enhanceBy } from "./modules.js";
import { onFormText } from "./notation.js";

const NOTATIONS = ["reading", "corpus", "template"];
const preferred = () => document.documentElement.dataset.notation || "reading";
const codeOf = (form) =>
  form.querySelector(`code[data-notation="${form.dataset.notation}"]`) ?? form.querySelector("code");

function setNotation(form, notation) {
  const has = form.querySelector(`code[data-notation="${notation}"]`);
  form.dataset.notation = has ? notation : form.querySelector("code")?.dataset.notation ?? "reading";
  mark(form, form.dataset.notation);
}

function mark(scope, notation) {
  scope.querySelectorAll("button[data-notation]").forEach((button) => {
    button.setAttribute("aria-pressed", String(button.dataset.notation === notation));
  });
}

function setPreferred(notation) {
  document.documentElement.dataset.notation = notation;
  try {
    localStorage.setItem("notation", notation);
  } catch {
    // then it lasts for this page
  }
  document.querySelectorAll("[data-form]:not([data-tools])").forEach((form) => setNotation(form, notation));
  document.querySelectorAll("[data-notation-toggle]").forEach((group) => mark(group, notation));
}

/** Put the text of a form into the clipboard and say so on it. */
export async function copyForm(form) {
  if (!form) return;
  const code = codeOf(form);
  const note = noteBeside(form.lastElementChild);
  await copyText(code.textContent, note, () => getSelection().selectAllChildren(code));
}

function button(text, dataset) {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "small-button";
  made.textContent = text;
  Object.assign(made.dataset, dataset);
  return made;
}

function addTools(form) {
  const tools = document.createElement("div");
  tools.className = "lf-tools";
  const notations = NOTATIONS.filter((name) => form.querySelector(`code[data-notation="${name}"]`));
  if (notations.length > 1) {
    const group = document.createElement("div");
    group.className = "segments";
    group.role = "group";
    group.ariaLabel = "Notation of this form";
    notations.forEach((name) => {
      const one = button(name, { notation: name });
      one.className = "";
      group.append(one);
    });
    tools.append(group);
  }
  tools.append(button("Copy", { copy: "" }));
  if (form.querySelector('code[data-notation="corpus"]')) {
    const toggle = button("Tree", { treeToggle: "" });
    toggle.setAttribute("aria-expanded", String(Boolean(form.querySelector(".tree"))));
    tools.append(toggle);
  }
  const tree = form.querySelector(".tree");
  if (tree) tree.before(tools);
  else form.append(tools);
}

async function toggleTree(form, toggle) {
  const shown = form.querySelector(".tree");
  toggle.setAttribute("aria-expanded", String(!shown));
  if (shown) return shown.remove();
  const figure = document.createElement("div");
  figure.className = "tree";
  figure.dataset.tree = form.querySelector('code[data-notation="corpus"]').textContent;
  form.append(figure);
  await enhanceBy("tree", figure);
}

function lightPair(bracket, isLit) {
  const code = bracket.closest("code");
  code.querySelectorAll(".is-lit").forEach((each) => each.classList.remove("is-lit"));
  if (!isLit) return;
  code.querySelectorAll(`[data-pair="${bracket.dataset.pair}"]`).forEach((each) => each.classList.add("is-lit"));
}

export function enhanceForms(root) {
  const forms = [...root.querySelectorAll("[data-form]:not(.lf-ready)")];
  if (root.matches?.("[data-form]:not(.lf-ready)")) forms.push(root);
  forms.forEach((form) => {
    form.classList.add("lf-ready");
    form.querySelectorAll("code").forEach(onFormText);
    if (form.hasAttribute("data-tools")) addTools(form);
    setNotation(form, preferred());
  });
  root.querySelectorAll("[data-notation-toggle]").forEach((group) => mark(group, preferred()));
}

document.addEventListener("click", (event) => {
  const notation = event.target.closest("button[data-notation]");
  const form = event.target.closest("[data-form]");
  if (notation && form) setNotation(form, notation.dataset.notation);
  else if (notation) setPreferred(notation.dataset.notation);
  else if (event.target.closest("[data-copy]")) copyForm(form);
  else if (event.target.closest("[data-tree-toggle]")) toggleTree(form, event.target);
  else if (form && event.target.closest("code") && getSelection().isCollapsed) copyForm(form);
});

document.addEventListener("mouseover", (event) => {
  const bracket = event.target.closest?.(".lf-bracket");
  if (bracket) lightPair(bracket, true);
});

document.addEventListener("mouseout", (event) => {
  const bracket = event.target.closest?.(".lf-bracket");
  if (bracket) lightPair(bracket, false);
});
