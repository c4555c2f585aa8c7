// A form that was sent back: the first field with an error has the focus, hence is in sight.
const FIELD = ":is(input, select, textarea):not([type=hidden])";
const WRONG = `.field:has(.errorlist) ${FIELD}, ${FIELD}[aria-invalid=true]`;

export function focusFirstError(root) {
  root.querySelector(WRONG)?.focus();
}
