// A page with a form that was sent back: the first field with an error has the focus, hence is in sight.
const FIELD = ":is(input, select, textarea):not([type=hidden])";
document.querySelector(`.field:has(.errorlist) ${FIELD}, ${FIELD}[aria-invalid=true]`)?.focus();
