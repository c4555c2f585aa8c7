// A form that was sent is not sent again while its answer is on its way.

const AGAIN_AFTER = 10_000; // milliseconds; the answer may be a file, and the page stays

document.addEventListener("submit", (event) => {
  const form = event.target;
  // After this, what the form sends has been read: a disabled button would not be in it.
  setTimeout(() => {
    if (event.defaultPrevented || form.getAttribute("method") !== "post") return;
    form.setAttribute("aria-busy", "true");
    const buttons = [...form.querySelectorAll("button:not([type=button])")].filter((each) => !each.disabled);
    buttons.forEach((button) => (button.disabled = true));
    const release = () => {
      form.removeAttribute("aria-busy");
      buttons.forEach((button) => (button.disabled = false));
    };
    setTimeout(release, AGAIN_AFTER);
    // Back to a page that the browser has kept as it was.
    window.addEventListener("pageshow", release, { once: true });
  });
});
