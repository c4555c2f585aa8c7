// The copy of a draft on the server: sent a moment after the last key, one request at a time, again and again
// with longer pauses while the server does not answer.
import { postDraft } from "./draft-post.js";
import { attempt } from "./draft-storage.js";
import { askToLogIn, isLogin, session } from "./log-in.js";
import { timeOf } from "./moments.js";

const PAUSE = 800; // milliseconds without a key before it is sent
const FIRST_RETRY = 2000;
const LONGEST_RETRY = 60_000;

// A name by which the server tells the browsers of one person apart.
const deviceName = nameDevice();

function nameDevice() {
  const made = crypto.getRandomValues(new Uint32Array(2)).join("-");
  return attempt(() => {
    if (!localStorage.getItem("device")) localStorage.setItem("device", made);
    return localStorage.getItem("device");
  }, made);
}

/** A draft as the server takes it. */
export function draftToSend(fields, place) {
  const version = Number.parseInt(fields.version, 10);
  return { fields, version: Number.isNaN(version) ? null : version, device: deviceName, ...place };
}

export class DraftServer {
  /** `show` is called with a sentence about the state of the draft, and with what a person can do about it: text → action. */
  constructor(form, show) {
    this.url = form.dataset.draftUrl;
    this.account = Number(form.dataset.draftOf);
    this.show = show;
    this.retry = FIRST_RETRY;
    this.waiting = null; // what to send next
    this.isSending = false;
    this.isLoggedOut = false;
    window.addEventListener("online", () => this.waiting && this.send());
    window.addEventListener("pagehide", () => this.sendLast());
    document.addEventListener("session:ended", () => this.showLoggedOut());
  }

  /** Return the draft that the server has of another visit; null where there is none, or no answer. */
  async load() {
    try {
      const answer = await fetch(this.url, { headers: { accept: "application/json" } });
      if (!answer.ok || isLogin(answer)) return null;
      const { draft } = await answer.json();
      return draft && { ...draft, savedAt: draft.saved_at, isElsewhere: draft.device !== deviceName };
    } catch {
      return null;
    }
  }

  /** Keep these fields of the form at `place`, once nothing has been typed for a moment. */
  save(fields, place) {
    this.waiting = draftToSend(fields, place);
    if (!this.isLoggedOut) this.show("Saving the draft …");
    this.after(PAUSE);
  }

  discard() {
    this.waiting = { discard: true };
    this.send();
  }

  /** The form was sent: what is typed arrives with it. */
  stop() {
    this.waiting = null;
    clearTimeout(this.timer);
  }

  after(milliseconds) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send(), milliseconds);
  }

  post(sent, options = {}) {
    return postDraft(this.url, this.account, sent, options);
  }

  async send() {
    if (this.isSending || !this.waiting) return;
    const sent = this.waiting;
    this.waiting = null;
    this.isSending = true;
    const { logIns } = session;
    try {
      await this.take(await this.post(sent), sent, logIns);
    } catch {
      this.fail(sent);
    }
    this.isSending = false;
    if (this.waiting && !this.isFailing) this.after(PAUSE);
  }

  async take(answer, sent, logIns) {
    this.isFailing = false;
    if (answer.redirected && logIns !== session.logIns) {
      this.waiting ??= sent; // it was sent before the person was back
      return;
    }
    if (isLogin(answer)) {
      this.waiting ??= sent;
      this.isFailing = true;
      return this.showLoggedOut();
    }
    this.isLoggedOut = false;
    if (answer.status >= 500) return this.fail(sent);
    const { saved_at, error } = await answer.json();
    this.retry = FIRST_RETRY;
    if (saved_at) this.show(`Draft saved ${timeOf(saved_at)}`);
    else this.show(error ?? "");
  }

  /** Said once: a button that is replaced while somebody presses it does nothing. */
  showLoggedOut() {
    if (this.isLoggedOut) return;
    this.isLoggedOut = true;
    this.show("Your session has ended. The draft is kept in this browser.", {
      "Log in again": () => askToLogIn(() => this.continue()),
    });
  }

  continue() {
    this.isLoggedOut = false;
    this.show("You are logged in again.");
    this.send();
  }

  fail(sent) {
    this.isFailing = true;
    this.isLoggedOut = false;
    this.waiting ??= sent;
    this.show("No connection. The draft is kept in this browser; trying again …");
    this.after(this.retry);
    this.retry = Math.min(2 * this.retry, LONGEST_RETRY);
  }

  /** The page goes away: what waits is sent behind it. */
  sendLast() {
    if (this.waiting) this.post(this.waiting, { keepalive: true }).catch(() => {});
    this.waiting = null;
  }
}
