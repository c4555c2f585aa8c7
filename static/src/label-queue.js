// Answers on their way to the server: in order, one at a time, kept in this browser until they arrived.
const RETRY = 3000;
const LOST = "Answers wait in this browser because your session has ended. Reload the page and log in.";
const STALE = "Answers wait in this browser because this page is out of date. Reload it.";
const NO_RIGHT = "This answer could not be stored: you may not label here any more.";

// The token of this page: one that was kept with an answer is worth nothing after the next log-in.
const token = () => JSON.parse(document.body.getAttribute("hx-headers"))["X-CSRFToken"];

function showConnection(isLost) {
  const line = document.getElementById("connection");
  if (line) line.hidden = !isLost;
}

export class AnswerQueue {
  /** `onReply(reply, answer)` hears what came of each answer, `onTrouble(sentence)` why they wait. */
  constructor(account, onReply, onTrouble) {
    this.key = `answers:${account}`;
    this.onReply = onReply;
    this.onTrouble = onTrouble;
    this.waiting = this.read();
    this.kept = this.waiting.length; // of an earlier page
    this.listeners = [];
    this.work();
  }

  get utterances() {
    return this.waiting.map((each) => each.utterance);
  }

  add(answer) {
    this.waiting.push(answer);
    this.write();
    if (this.waiting.length === 1) this.work();
  }

  isEmpty() {
    if (!this.waiting.length) return Promise.resolve();
    return new Promise((resolve) => this.listeners.push(resolve));
  }

  async work() {
    while (this.waiting.length) {
      const reply = await this.send(this.waiting[0]);
      showConnection(!reply);
      if (reply?.trouble) return this.onTrouble(reply.trouble);
      if (!reply) {
        await new Promise((resolve) => setTimeout(resolve, RETRY));
        continue;
      }
      const answer = this.waiting.shift();
      this.kept = Math.max(0, this.kept - 1);
      this.write();
      this.onReply(reply, answer);
    }
    this.listeners.splice(0).forEach((resolve) => resolve());
  }

  // Null where the server was not reached: the answer is sent again.
  async send(answer) {
    const body = new FormData();
    answer.fields.forEach(([name, value]) => body.append(name, value));
    body.delete("csrfmiddlewaretoken");
    try {
      const headers = { Accept: "application/json", "X-CSRFToken": token() };
      const reply = await fetch(answer.address, { method: "POST", body, headers });
      if (reply.redirected) return { trouble: LOST };
      if (reply.status === 403 && !this.kept) return { trouble: STALE };
      if (reply.status === 403 || reply.status === 404) return { refusal: NO_RIGHT };
      return reply.status >= 500 ? null : await reply.json();
    } catch {
      return null;
    }
  }

  read() {
    try {
      return JSON.parse(localStorage.getItem(this.key)) ?? [];
    } catch {
      return [];
    }
  }

  write() {
    try {
      localStorage.setItem(this.key, JSON.stringify(this.waiting));
    } catch {
      // A full or forbidden storage: the answers live as long as the page.
    }
  }
}
