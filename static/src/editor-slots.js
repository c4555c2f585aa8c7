// Lights a slot on both sides of a template while the cursor is on it. Which places belong together the
// server says; here they only move along with what is typed until its next answer.
import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView } from "@codemirror/view";

const setPlaces = StateEffect.define(); // [{ from, to, slot }]
const setLit = StateEffect.define(); // the number of a slot, -1 for none
const mark = Decoration.mark({ class: "cm-slot-lit" });

const moved = (places, changes) =>
  places
    .map((place) => ({ ...place, from: changes.mapPos(place.from, 1), to: changes.mapPos(place.to, -1) }))
    .filter((place) => place.from < place.to);

const field = StateField.define({
  create: () => ({ places: [], lit: -1 }),
  update(value, transaction) {
    let { places, lit } = value;
    if (transaction.docChanged) places = moved(places, transaction.changes);
    for (const effect of transaction.effects) {
      if (effect.is(setPlaces)) places = effect.value;
      if (effect.is(setLit)) lit = effect.value;
    }
    return places === value.places && lit === value.lit ? value : { places, lit };
  },
  provide: (self) =>
    EditorView.decorations.from(self, ({ places, lit }) =>
      Decoration.set(
        places.filter((place) => place.slot === lit).map((place) => mark.range(place.from, place.to)),
        true,
      ),
    ),
});

function slotAt(state) {
  const at = state.selection.main.head;
  return state.field(field).places.find(({ from, to }) => from <= at && at <= to)?.slot ?? -1;
}

/** Give an editor the places of each slot: [[from, to], …] by the number of the slot. */
export function showSlots(view, slots) {
  const places = slots.flatMap((each, slot) => each.map(([from, to]) => ({ from, to, slot })));
  view.dispatch({ effects: setPlaces.of(places.filter(({ to }) => to <= view.state.doc.length)) });
}

export function lightSlot(view, slot) {
  if (view.state.field(field).lit !== slot) view.dispatch({ effects: setLit.of(slot) });
}

/** The extension; `onSlot` is called with the slot under the cursor. */
export function slotLighting(onSlot) {
  return [
    field,
    EditorView.updateListener.of((update) => {
      const isNew = update.transactions.some((each) => each.effects.some((effect) => effect.is(setPlaces)));
      if (update.view.hasFocus && (update.selectionSet || update.focusChanged || update.docChanged || isNew)) {
        onSlot(slotAt(update.state));
      }
    }),
  ];
}
