// Pages without the frame. They stand in the place of the page that one asked for, so what was sent has not arrived.
import { takeSent } from "./draft-storage.js";
import { focusFirstError } from "./first-error.js";

takeSent();
focusFirstError(document);
