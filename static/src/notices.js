// A notice (`[data-notice]`) has a button that closes it. One that every page would show again is named in a
// cookie, which the server reads: it stays closed from page to page until the browser is closed.
document.addEventListener("click", (event) => {
  const button = event.target.closest?.("[data-notice-close]");
  if (!button) return;
  const name = button.dataset.noticeClose;
  if (name) document.cookie = `closed_notice=${encodeURIComponent(name)}; path=/; samesite=lax`;
  button.closest("[data-notice]").remove();
  document.getElementById("main")?.focus({ preventScroll: true });
});
