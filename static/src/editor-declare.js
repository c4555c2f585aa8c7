// The button beside "there is no predicate": it declares the predicate as the form uses it.
import { forgetOffers } from "./editor-completion.js";
import { csrfToken } from "./csrf.js";

const CONFLICT = 409;

async function declare(address, declaration) {
  const headers = { "Content-Type": "application/json", Accept: "application/json", "X-CSRFToken": csrfToken() };
  const answer = await fetch(address, { method: "POST", headers, body: JSON.stringify(declaration) });
  const body = await answer.json();
  // Somebody has declared it meanwhile: that is as good.
  if (!answer.ok && answer.status !== CONFLICT) throw new Error(body.detail ?? body.title);
  return body;
}

/** Say that it is declared, with a link to where that is changed. The line stays until somebody declares another one. */
function tell(form, { name }, { id }) {
  form.querySelector(".declared")?.remove();
  const line = document.createElement("p");
  line.className = "declared small";
  line.role = "status";
  line.append(`Declared ${name}. `);
  if (id) {
    const link = document.createElement("a");
    link.href = form.dataset.predicateUrl.replace("/0/", `/${id}/`);
    link.textContent = `Change or delete ${name}`;
    line.append(link);
  }
  form.querySelector(".actions").before(line);
}

/** The button. `after` is called once the predicate is there. */
export function declareButton(form, declaration, after) {
  const { name, kind, signatures } = declaration;
  const button = document.createElement("button");
  button.type = "button";
  button.className = "small-button repair";
  button.textContent = `Declare ${kind} ${name}${signatures.map((each) => `(${each.join(", ")})`).join(" or ")}`;
  button.addEventListener("click", async () => {
    button.disabled = true;
    try {
      tell(form, declaration, await declare(form.dataset.predicatesUrl, declaration));
      forgetOffers();
      after();
    } catch (error) {
      button.disabled = false;
      button.after(` It was not declared: ${error.message}`);
    }
  });
  return button;
}
