// What every page needs; the large pieces are fetched where a page holds something for them.
import "./requests.js";
import "./keys.js";
import "./selection.js";
import "./sheet.js";
import "./menus.js";
import "./drafts.js";
import { onContent } from "./content.js";
import { enhanceForms } from "./forms.js";
import { loadModule } from "./modules.js";

onContent((root) => {
  enhanceForms(root);
  for (const [selector, name] of [
    ["[data-chart]", "charts"],
    ["[data-tree]", "tree"],
    ["[data-editor]", "editor"],
  ]) {
    const found = [...root.querySelectorAll(selector)];
    if (root.matches?.(selector)) found.push(root);
    if (found.length) loadModule(name).then((module) => found.forEach(module.enhance));
  }
});
