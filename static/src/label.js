// Labelling by keyboard: an answer is sent behind the scenes while the next utterance, fetched before, is
// shown at once. Answers are sent one after another and kept in this browser until the server has them.
import { enhanceBy } from "./modules.js";
import { onFormText } from "./notation.js";
import { readDraft } from "./draft-storage.js";
import { AnswerQueue } from "./label-queue.js";
import { actionOf, keyOf, READING, sayIgnored, TYPING } from "./typing.js";

// The page's other modules look at what came in, as they do after a swap of htmx.
function fill(place, html) {
  place.innerHTML = html;
  tellOthers(place);
}

function tellOthers(place) {
  place.dispatchEvent(new CustomEvent("content:added", { bubbles: true }));
  place.dispatchEvent(new CustomEvent("htmx:load", { bubbles: true, detail: { elt: place } }));
}

// Panels whose fields are kept as drafts, by the names of their templates.
const hasDraft = (template) => readDraft(template.content.querySelector("form")) !== null;

export function enhance(page) {
  new LabelPage(page);
}

class LabelPage {
  constructor(page) {
    this.page = page;
    this.place = page.querySelector("[data-label-place]");
    this.strip = page.querySelector("[data-label-strip]");
    this.notices = page.querySelector("[data-label-notices]");
    this.since = performance.now();
    this.queue = new AnswerQueue(
      page.dataset.answersOf,
      (reply, sent) => this.onReply(reply, sent),
      (sentence) => this.notice(sentence),
    );
    page.addEventListener("submit", (event) => this.onSubmit(event));
    page.addEventListener("click", (event) => this.onClick(event));
    document.addEventListener("keydown", (event) => this.onKey(event), true); // before the keys of all pages
    document.addEventListener("keydown", (event) => this.onEscape(event));
    this.begin();
    this.fetchNext();
  }

  get item() {
    return this.place.querySelector("[data-item]");
  }

  // Whether the utterance on the page waits for an answer: the next one may still be on its way, or have come
  // so soon after the last press that nobody has read it.
  get isAsking() {
    return this.item?.hasAttribute("data-asks") ?? false;
  }

  // The utterance on the page is looked at from now on, and answered once somebody can have read it.
  begin(reading = 0) {
    const { item } = this;
    if (reading) setTimeout(() => item?.setAttribute("data-asks", ""), reading);
    else item?.setAttribute("data-asks", "");
    if (reading) this.since = performance.now();
    this.place.querySelectorAll(".label-choice code").forEach(onFormText);
    const begun = [...this.place.querySelectorAll("template[data-label-panel]")].find(hasDraft);
    if (begun) this.openPanel(begun.dataset.labelPanel);
  }

  fetchNext() {
    const here = this.item ? [this.item.dataset.item] : [];
    this.next = this.fetchItem({ without: [...here, ...this.queue.utterances].join(",") });
  }

  async fetchItem(parameters) {
    const query = new URLSearchParams(location.search);
    query.delete("utterance");
    for (const [name, value] of Object.entries(parameters)) query.set(name, value);
    try {
      const answer = await fetch(`${this.page.dataset.itemUrl}?${query}`);
      return answer.ok && !answer.redirected ? await answer.text() : null;
    } catch {
      return null;
    }
  }

  async show(item) {
    const text = await item;
    if (text === null) {
      this.notice("The next utterance could not be fetched. Your answers are kept here; reload the page.");
      return;
    }
    const before = this.item?.dataset.item;
    fill(this.place, text);
    this.begin(this.item?.dataset.item === before ? 0 : READING);
  }

  async goOn() {
    const next = this.next;
    this.item.removeAttribute("data-asks");
    this.clearNotices();
    await this.show(next);
    this.fetchNext();
    if (!this.item) this.lookAgain();
  }

  // What was fetched before the last answer arrived does not know of it: that it was a skip, say.
  async lookAgain() {
    await this.queue.isEmpty();
    if (!this.item) await this.show(this.fetchItem({}));
    this.fetchNext();
  }

  onSubmit(event) {
    const form = event.target;
    if (form.matches("[data-label-answer]")) {
      event.preventDefault();
      if (form.closest("[data-label-panel-place]")) this.answerWritten(form);
      else this.answer(form.action, new FormData(form, event.submitter), form.closest("[data-item]"));
    } else if (form.matches("[data-label-mend]")) {
      event.preventDefault();
      this.mend(form);
    } else if (form.matches("[data-take-back]")) {
      event.preventDefault();
      this.takeBack(form);
    }
  }

  get seconds() {
    return ((performance.now() - this.since) / 1000).toFixed(1);
  }

  // What somebody wrote stays on the page until the server has taken it.
  async answerWritten(form) {
    if (this.isWriting) return;
    this.isWriting = true;
    const { item } = this;
    const reply = await this.postWritten(form, { seconds: this.seconds });
    this.isWriting = false;
    if (!reply) return this.notice("The server does not answer. What you wrote is still here; send it again.");
    this.onReply(reply);
    // Meanwhile an answer may have been taken back, and its utterance is on the page.
    if (!reply.refusal && this.item === item) this.goOn();
  }

  // The draft of a panel is kept until the server has taken what it holds.
  async postWritten(form, values = {}) {
    const reply = await this.post(form, values);
    const hasArrived = reply && !reply.refusal;
    form.dispatchEvent(new CustomEvent(hasArrived ? "draft:arrived" : "input", { bubbles: true }));
    return reply;
  }

  answer(address, sent, item) {
    if (!this.isAsking) return;
    sent.set("seconds", this.seconds);
    this.queue.add({ address, utterance: item.dataset.item, fields: [...sent] });
    this.goOn();
  }

  // What the server says to an answer; a refusal leads back to its utterance.
  onReply(reply, sent = null) {
    if (reply.strip) fill(this.strip, reply.strip);
    if (reply.refusal) this.notice(reply.refusal, reply.text, sent?.utterance);
  }

  notice(sentence, text = "", utterance = "") {
    const line = document.createElement("li");
    line.className = "message warning";
    line.append(text ? `“${text}”: ${sentence} ` : sentence);
    if (utterance) {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "link-button";
      button.textContent = "Show it";
      button.addEventListener("click", () => {
        line.remove();
        this.notices.hidden = !this.notices.children.length;
        this.show(this.fetchItem({ utterance })).then(() => this.fetchNext());
      });
      line.append(button);
    }
    this.notices.append(line);
    this.notices.hidden = false;
  }

  // What is no news after the next answer goes; a refused answer stays until somebody looks at it.
  clearNotices() {
    this.notices.querySelectorAll("li:not(:has(button))").forEach((line) => line.remove());
    this.notices.hidden = !this.notices.children.length;
  }

  async post(form, values = {}) {
    const body = new FormData(form);
    for (const [name, value] of Object.entries(values)) body.set(name, value);
    try {
      const answer = await fetch(form.action, {
        method: "POST",
        body,
        headers: { Accept: "application/json" },
      });
      return answer.redirected ? null : await answer.json();
    } catch {
      return null;
    }
  }

  async mend(form) {
    const reply = await this.postWritten(form);
    if (!reply) return this.notice("The server does not answer. Try again in a moment.");
    if (reply.refusal) return this.notice(reply.refusal);
    await this.show(this.fetchItem({ utterance: reply.utterance }));
    this.fetchNext();
  }

  async takeBack(form) {
    if (this.isTakingBack) return;
    this.isTakingBack = true;
    const reply = await this.post(form);
    this.isTakingBack = false;
    if (!reply) return this.notice("The server does not answer. Try again in a moment.");
    this.onReply(reply);
    if (reply.refusal) return;
    await this.show(this.fetchItem({ utterance: reply.utterance }));
    this.fetchNext();
  }

  onClick(event) {
    const opener = event.target.closest("[data-label-open]");
    if (opener) this.openPanel(opener.dataset.labelOpen);
    if (event.target.closest("[data-label-close]")) this.closePanel();
    if (event.target.closest("[data-label-again]")) this.show(this.fetchItem({ utterance: this.item.dataset.item }));
  }

  openPanel(name) {
    const template = this.item?.querySelector(`template[data-label-panel="${name}"]`);
    if (!template) return;
    const selected = getSelection().toString().trim();
    const place = this.item.querySelector("[data-label-panel-place]");
    place.replaceChildren(template.content.cloneNode(true));
    const field = place.querySelector("textarea, input:not([type=hidden])");
    if (name === "mend" && this.item.querySelector(".label-text").textContent.includes(selected)) {
      field.value = selected;
    }
    tellOthers(place);
    field.focus();
    if (name === "edit") this.openEditor(field);
  }

  async openEditor(field) {
    await enhanceBy("editor", field);
    field.parentElement.querySelector(".cm-content")?.focus();
  }

  // What is typed there is a draft, which the panel shows when it is opened again.
  closePanel() {
    this.item?.querySelector("[data-label-panel-place]").replaceChildren();
  }

  onEscape(event) {
    if (keyOf(event) !== "Escape" || event.defaultPrevented || document.querySelector("dialog[open]")) return;
    this.closePanel();
  }

  // A key that comes before the utterance can be read is not for it: nothing is done, and that is said.
  onKey(event) {
    const action = actionOf(event);
    if (!action || event.repeat || event.target.closest(TYPING) || document.querySelector("dialog[open]")) return;
    const button = action === "digit" ? `[data-digit="${keyOf(event)}"]` : `[data-action="${action}"]`;
    const pressed = this.item?.querySelector(button);
    if (action === "undo") this.takeLastBack();
    else if (!pressed) return;
    else if (this.isAsking) pressed.click();
    else sayIgnored(event);
    event.preventDefault();
  }

  // The last answer may still be on its way.
  async takeLastBack() {
    await this.queue.isEmpty();
    this.strip.querySelector("form[data-take-back]")?.requestSubmit();
  }
}
