"""What keeps somebody from using a page: looked for in the browser, by our own rules and axe-core's."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Page

from tests.browser.arriving import ENHANCED

AXE = Path(__file__).resolve().parents[2] / "node_modules" / "axe-core" / "axe.min.js"

# The modules have taken over what they are for, no fragment is on its way, and two frames have passed,
# so that also what waits for the sizes of things is done.
SETTLED = f"""async () => {{
  const frame = () => new Promise(requestAnimationFrame);
  const isBusy = () =>
    document.querySelector(":is({ENHANCED}):not([data-ready])") ||
    document.querySelector(".htmx-request, .htmx-added") ||
    [...document.querySelectorAll("[aria-busy=true]")].some((each) => each.checkVisibility());
  do await frame(); while (isBusy());
  await frame();
}}"""

CONTROLS = """() => [...document.querySelectorAll("a[href], button, input, select, textarea, summary")]
  .filter((element) => element.type !== "hidden" && element.checkVisibility({visibilityProperty: true}))"""
ENABLED = f"() => ({CONTROLS})().filter((element) => !element.disabled)"
# Controls without a name to call them by.
NAMELESS = f"""() => {{
  const named = (element) => [
    element.getAttribute("aria-label"),
    element.title,
    element.innerText,
    ...[...(element.labels ?? [])].map((label) => label.textContent),
    document.getElementById(element.getAttribute("aria-labelledby") ?? "")?.textContent,
    element.querySelector?.("svg[aria-label], img[alt]") ? "drawn" : "",
  ].some((text) => text?.trim());
  return ({CONTROLS})().filter((element) => !named(element))
    .map((element) => element.outerHTML.slice(0, 160));
}}"""
TWICE = """() => {
  const ids = [...document.querySelectorAll("[id]")].map((element) => element.id);
  return ids.filter((id, place) => ids.indexOf(id) !== place);
}"""
HEADINGS = """() => {
  const titles = document.querySelectorAll("h1");
  return titles.length === 1 ? [] : [`${titles.length} h1`];
}"""
LANGUAGE = """() => document.documentElement.lang === "en" ? [] : [document.documentElement.lang]"""
# Sentences with a blank before a comma or at their end; commands and forms have commas as words of their own.
STRAY_BLANKS = """() => {
  const own = ":is(code, pre, kbd, textarea, .lf, .text, .row-link, .cm-editor, [data-said])";
  const copy = document.body.cloneNode(true);
  for (const each of copy.querySelectorAll(`script, style, ${own}`)) each.replaceWith("…");
  return [...copy.querySelectorAll("p, li, dt, dd, td, th, label, h1, h2, h3, span")]
    .map((each) => each.textContent.replace(/\\s+/g, " ").trim())
    .filter((text) => /\\S [,;.](?: |$)/.test(text)).map((text) => text.slice(0, 160));
}"""
# Controls that Tab passes over, and those that look the same with the focus and without it: they,
# what they stand in and what stands in that.
PASSED_OVER = f"""() => ({ENABLED})()
  .filter((element) => element.tabIndex !== 0)
  .map((element) => element.outerHTML.slice(0, 160))"""
UNMARKED = f"""() => {{
  const look = (element) => [element, element.parentElement, element.parentElement.parentElement]
    .map((each) => getComputedStyle(each))
    .map((style) => [style.outline, style.boxShadow, style.backgroundColor, style.borderColor].join())
    .join();
  const looks_alike = (element) => {{
    document.activeElement.blur();
    const before = look(element);
    element.focus();
    return look(element) === before;
  }};
  return ({ENABLED})().filter(looks_alike).map((element) => element.outerHTML.slice(0, 160));
}}"""
# What is wider than the window. A chart takes its new width some frames late.
BESIDE = """async () => {
  const root = document.documentElement;
  for (let frames = 0; frames < 600 && root.scrollWidth > root.clientWidth; frames += 1)
    await new Promise(requestAnimationFrame);
  if (root.scrollWidth <= root.clientWidth) return [];
  return [...document.querySelectorAll("body *")]
    .filter((element) => element.getBoundingClientRect().right > root.clientWidth + 1)
    .map((element) => element.outerHTML.slice(0, 120)).slice(0, 3);
}"""

# What holds more than it has room for.
CUT = """() => [...document.querySelectorAll(".card, .option-card, .flow-noun")]
  .filter((element) => element.scrollWidth > element.clientWidth + 1)
  .map((element) => element.outerHTML.slice(0, 80))"""

# Steps of the breadcrumb that are shortened, or left out where there are no two rows, beside room for them.
CRUMBS = """() => {
  const list = document.querySelector(".breadcrumb ol");
  if (!list) return [];
  const steps = [...list.children];
  const right = Math.max(...steps.map((each) => each.getBoundingClientRect().right));
  const room = list.getBoundingClientRect().right - right;
  return steps
    .filter((each) => each.scrollWidth > each.clientWidth + 1 || (innerWidth >= 800 && !each.checkVisibility()))
    .filter(() => room > 8)
    .map((each) => `${each.textContent.trim()}: ${room} pixels are free`);
}"""
# What does not begin where it does on every other page: the title, and the tabs below it.
OUT_OF_LINE = """() => {
  const [top, title, tabs] = [".topbar", "h1", "main .tabs"].map((each) => document.querySelector(each));
  const head = title?.closest(".page-head");
  if (!top || !head || (innerWidth < 800 && head.closest(".review"))) return [];  // Review is denser on a phone
  const from = document.querySelector("main").getBoundingClientRect().top;
  const at = (element) => Math.round(element.getBoundingClientRect().top - from);
  const gap = Math.round(tabs && head.contains(tabs) ? at(tabs) - at(title) - title.offsetHeight : 8);
  return at(title) === (innerWidth < 800 ? 16 : 20) && gap === 8 ? [] : [`title at ${at(title)}, tabs ${gap} below`];
}"""
# Fields and cells for what people write that force the direction of our own script on it.
ONE_DIRECTION = """() => [...document.querySelectorAll(
    "main :is(input:is([type=text], [type=search]), textarea, td.text, q, h1)")]
  .filter((each) => each.checkVisibility())
  .filter((each) => !["plaintext", "isolate"].includes(getComputedStyle(each).unicodeBidi))
  .map((each) => each.outerHTML.slice(0, 120))"""
# Chosen options that their field has no room for.
CUT_CHOICES = """() => {
  const pen = new OffscreenCanvas(1, 1).getContext("2d");
  return [...document.querySelectorAll("main select:not([multiple])")]
    .filter((each) => each.checkVisibility() && each.selectedOptions.length)
    .filter((each) => {
      const style = getComputedStyle(each);
      pen.font = style.font;
      const room = each.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
      return pen.measureText(each.selectedOptions[0].text).width > room + 2;
    })
    .map((each) => `${each.name}: ${each.selectedOptions[0].text}`);
}"""
# Tables that go on beyond the screen on which they are read.
CUT_TABLES = """() => [...document.querySelectorAll("main .table-wrap")]
  .filter((each) => each.checkVisibility())
  .map((each) => [each, each.querySelector("table").offsetWidth - each.clientWidth])
  .filter(([, beyond]) => beyond > 1)
  .map(([each, beyond]) => `${beyond} pixels: ${each.innerText.slice(0, 60)}`)"""

# What a printed page shows though only a screen can use it.
OF_A_SCREEN = """() => [...document.querySelectorAll(
    ".rail, .tabs, .topbar, .banner, .sheet-bar, .run-start, .tick, .page-head > .actions, [data-notice]")]
  .filter((each) => each.checkVisibility()).map((each) => each.outerHTML.slice(0, 80))"""
# Ground and ink of a printed page where they are not those of paper.
DARK = """() => {
  const lightness = (colour) => {
    const canvas = new OffscreenCanvas(1, 1).getContext("2d");
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return canvas.getImageData(0, 0, 1, 1).data.slice(0, 3).reduce((sum, each) => sum + each) / 3;
  };
  const { backgroundColor, color } = getComputedStyle(document.body);
  return lightness(backgroundColor) > 250 && lightness(color) < 100 ? [] : [backgroundColor, color];
}"""
UNTITLED = """() => [...document.querySelectorAll("h1")].some((each) => each.checkVisibility()) ? [] : ["no h1"]"""
# Tables, texts and charts that do not end where the paper does. Nothing scrolls there.
CUT_ON_PAPER = """() => [...document.querySelectorAll("main :is(th, td, pre, p, dd, svg, canvas, figure)")]
  .filter((each) => each.checkVisibility({visibilityProperty: true}))
  .filter((each) => !each.closest(".visually-hidden"))
  .filter((each) => each.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
  .map((each) => each.outerHTML.slice(0, 120)).slice(0, 3)"""
A4 = {"width": 688, "height": 1017}  # CSS pixels between margins of 14 mm

OF_PAPER = {
    "on paper": OF_A_SCREEN,
    "dark on paper": DARK,
    "without a heading on paper": UNTITLED,
    "cut off on paper": CUT_ON_PAPER,
}
OF_WIDTH = {"beside the screen": BESIDE, "cut": CUT, "crumbs": CRUMBS, "out of line": OUT_OF_LINE}
OF_STRUCTURE = {
    "of one direction": ONE_DIRECTION,
    "without a name": NAMELESS,
    "ids given twice": TWICE,
    "headings": HEADINGS,
    "language": LANGUAGE,
    "stray blanks": STRAY_BLANKS,
    **OF_WIDTH,
}
OF_DESKTOP = {"cut choices": CUT_CHOICES, "cut tables": CUT_TABLES}
OF_FOCUS = {"passed over by Tab": PASSED_OVER, "focus not to be seen": UNMARKED}

BROKEN_RULES = """async (rules) => {
  const only = rules && {runOnly: {type: "rule", values: rules}};
  const {violations} = await axe.run(document, {resultTypes: ["violations"], selectors: false, ...only});
  return violations
    .filter(({impact}) => ["serious", "critical"].includes(impact))
    .map(({id, nodes}) => `${id}: ` + nodes.map(
      (node) => `${node.html.slice(0, 160)} [${node.any[0]?.message ?? ""}]`).join("; "));
}"""
# The rules whose answers depend on the theme and the width.
COLOUR_AND_SIZE = [
    "color-contrast",
    "link-in-text-block",
    "scrollable-region-focusable",
    "target-size",
]

FOOT = 160  # pixels for what is fixed to the foot of a window

Faults = dict[str, list[str]]


def listen(page: Page, complaints: list[str]) -> None:
    """Add to ``complaints`` whatever the page complains of, scripts refused by its policy included."""
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda message: message.type in ("error", "warning") and complaints.append(message.text),
    )
    page.on(
        "response",
        lambda answer: answer.status >= 400 and complaints.append(f"{answer.status} {answer.url}"),
    )


def look_for(page: Page, scripts: dict[str, str]) -> Faults:
    """Return what each of ``scripts`` lists in ``page``, asked in one go."""
    asked = ", ".join(f"{key!r}: await ({script})()" for key, script in scripts.items())
    return page.evaluate(f"async () => ({{{asked}}})")


def focus_faults(page: Page) -> Faults:
    """Return the controls that a keyboard does not reach, or where nobody sees that it has."""
    page.keyboard.press("Tab")  # from here on the browser shows where the focus is
    return look_for(page, OF_FOCUS)


def broken_rules(page: Page, rules: list[str] | None = None) -> Faults:
    """Return the serious violations that axe-core finds; of ``rules``, where they are given.

    The page needs axe-core as its init script, which its content policy does not stop. The window
    becomes as high as the page, so that what is fixed to its foot covers no half of a link.
    """
    height = page.evaluate("document.documentElement.scrollHeight")
    if height > page.viewport_size["height"]:
        page.set_viewport_size({**page.viewport_size, "height": height + FOOT})
    return {"axe": page.evaluate(BROKEN_RULES, rules)}


def printed(page: Page) -> Faults:
    """Return the faults of a page on a sheet of A4, printed by somebody who reads in the dark."""
    page.set_viewport_size(A4)
    page.emulate_media(media="print", color_scheme="dark")
    page.evaluate(SETTLED)
    faults = look_for(page, OF_PAPER)
    page.emulate_media(media="null")
    return faults


def narrow_and_dark(page: Page) -> Faults:
    """Return the faults of a page that was opened in a narrow and dark window."""
    page.evaluate(SETTLED)
    faults = {**look_for(page, OF_STRUCTURE), **broken_rules(page, COLOUR_AND_SIZE)}
    return {f"{what}, narrow and dark": each for what, each in faults.items()}


def wide_and_light(page: Page) -> Faults:
    """Return the faults of a page in a wide and light window: by all rules of axe-core, and by keyboard."""
    page.evaluate(SETTLED)
    return {
        **look_for(page, {**OF_STRUCTURE, **OF_DESKTOP}),
        **broken_rules(page),
        **focus_faults(page),
    }


def in_place(page: Page) -> Faults:
    """Return the faults of what has opened on a page that is looked at already."""
    page.evaluate(SETTLED)
    return {**look_for(page, OF_STRUCTURE), **broken_rules(page)}


def only_faults(reports: dict[str, Faults]) -> dict[str, Faults]:
    """Return the part of ``reports`` in which something is listed."""
    listed = {
        where: {what: each for what, each in report.items() if each}
        for where, report in reports.items()
    }
    return {where: report for where, report in listed.items() if report}
