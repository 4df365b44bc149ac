// What keys and the mouse do, for the help and for the keyboard.
export const help = [
  ["Mouse and touch", [
    ["left drag on the background, middle drag, one finger", "orbit"],
    ["right drag, Shift + middle drag, two fingers", "pan"],
    ["wheel, pinch", "zoom to the pointer"],
    ["click on a part, on its name", "select it: hold, move, remove, isolate, see through"],
    ["click on a contact", "its part, features, gap and force"],
  ]],
  ["Holding the part (live, simulated pen)", [
    ["left drag or finger on the held part", "move it in the plane of the screen; let go to stop pressing"],
    ["Shift + left drag on it, or G before", "turn it"],
    ["wheel while dragging", "move it away or nearer"],
    ["H", "hold the selected part where none is held; then hold it by keys: arrows and Page Up / Down move, with Shift turn; Esc lets go"],
  ]],
  ["Looking", [
    ["1 … 7", "front, back, left, right, top, bottom, isometric"],
    ["F, C", "show everything, show the held part (or the selected one)"],
    ["arrows, Shift + arrows, + −", "orbit, pan, zoom"],
    ["O, U", "with or without perspective, another axis up"],
    ["S, [ and ]", "section plane: across x, y, z, off; move it. Its handle: drag, with Shift tilt"],
    ["P, then arrows, Page Up / Down", "tilt the section plane, move it; Esc lets go"],
    ["E", "parts away from each other, and back"],
    ["M", "measure: click two faces, edges or corners, or Enter for the one in the middle; Esc ends it"],
    ["Enter", "a click in the middle of the picture, where the cross is (arrows and Shift + arrows bring something there)"],
    ["N", "the next contact: its part, features, gap and force; Esc closes it"],
    ["T", "light or dark"],
  ]],
  ["Parts", [
    ["/", "search"],
    ["V, I, X", "of the selected part: show or hide, show it alone, see through it"],
    ["A", "show all"],
    ["Ctrl + Z", "take the last change back"],
  ]],
  ["The run", [
    ["Space, .", "pause or go on, one step (virtual time and recordings)"],
    [", and .", "one frame back and on (recordings)"],
    ["R", "begin the run anew"],
    ["?", "this help"],
  ]],
];

// Keys that belong to the element that has the focus.
export function isTyping(event) {
  const tag = event.target.tagName;
  if (tag === "SELECT" || tag === "DIALOG") return true;
  if (tag === "INPUT" && ["number", "search"].includes(event.target.type)) return event.key !== "Escape";
  if (tag === "INPUT") return event.target.type === "range" ? /^(Arrow|Page|Home|End)/.test(event.key) : event.key === " ";
  return tag === "BUTTON" && (event.key === " " || event.key === "Enter");
}
