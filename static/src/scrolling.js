// A table that scrolls and holds nothing to step to takes the focus itself, so that arrow keys move it.
const CONTROLS = "a[href], button, input, select, textarea, summary";

function markScrolling(wrap) {
  const scrolls = wrap.scrollWidth > wrap.clientWidth || wrap.scrollHeight > wrap.clientHeight;
  if (scrolls && !wrap.querySelector(CONTROLS)) {
    wrap.tabIndex = 0;
    wrap.setAttribute("role", "group");
    wrap.setAttribute("aria-label", "Table that scrolls");
  } else {
    ["tabindex", "role", "aria-label"].forEach((name) => wrap.removeAttribute(name));
  }
}

const sizes = new ResizeObserver((entries) => entries.forEach(({ target }) => markScrolling(target)));

export function watchScrolling(wrap) {
  sizes.observe(wrap);
}

// A tab that can be seen in part takes the focus where it stands; all of it comes into view.
document.addEventListener("focusin", ({ target }) => {
  if (target.closest(".tabs")) target.scrollIntoView({ block: "nearest", inline: "nearest" });
});
