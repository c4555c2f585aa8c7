// Tells the server the world of this page, so that the rail keeps it on pages outside of any world (gpsr_site/pages/frame.py),
// until the browser is closed.
const { world } = document.body.dataset;
if (world) document.cookie = `last_world=${encodeURIComponent(world)}; path=/; samesite=lax`;
