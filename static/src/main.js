// What every page needs; the large pieces are fetched where a page holds something for them.
import "./requests.js";
import "./submitted.js";
import "./going-on.js";
import "./keys.js";
import "./sheet.js";
import "./time-zone.js";
import "./last-world.js";
import "./remembered.js";
import "./guidelines.js";
import "./menus.js";
import "./notices.js";
import "./drafts.js";
import "./merge.js";
import "./mentions.js";
import "./copying.js";
import "./suggestions.js";
import "./row-search.js";
import "./search-box.js";
import "./filter-addresses.js";
import "./folders.js";
import { onContent } from "./content.js";
import { focusFirstError } from "./first-error.js";
import { enhanceForms } from "./forms.js";
import { enhanceBy } from "./modules.js";
import { watchScrolling } from "./scrolling.js";

onContent((root) => {
  enhanceForms(root);
  focusFirstError(root);
  const within = (selector) =>
    [root, ...root.querySelectorAll(selector)].filter((element) => element.matches?.(selector));
  within(".table-wrap").forEach(watchScrolling);
  for (const [selector, name] of [
    ["[data-chart]", "charts"],
    ["[data-tree]", "tree"],
    ["[data-editor]", "editor"],
    ["[data-label-page]", "label"],
    ["[data-examples]", "examples"],
    ["[data-audit-page]", "audit"],
    ["[data-refusal]", "refusal"],
    ["[data-case]", "review"],
    ["[data-my-drafts]", "my-drafts"],
  ]) {
    within(selector).forEach((element) => enhanceBy(name, element));
  }
});
