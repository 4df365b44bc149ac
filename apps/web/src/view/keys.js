// What keys and the mouse do, for the help and for the keyboard.
export const help = [
  ["Mouse", [
    ["left drag on the background, middle drag", "orbit"],
    ["right drag, Shift + middle drag", "pan"],
    ["wheel", "zoom to the pointer"],
  ]],
  ["Holding the part (live, simulated pen)", [
    ["left drag on the held part", "move it in the plane of the screen; let go to stop pressing"],
    ["Shift + left drag on it", "turn it"],
    ["wheel while dragging", "move it away or nearer"],
    ["H", "hold it by keys: arrows and Page Up / Down move, with Shift turn; Esc lets go"],
  ]],
  ["Changing the parts (live)", [
    ["click on a part, or on its name", "select it: hold, move, remove, add back"],
  ]],
  ["Keys", [
    ["1 … 7", "front, back, left, right, top, bottom, isometric"],
    ["F, C", "show everything, show the held part"],
    ["arrows, Shift + arrows, + −", "orbit, pan, zoom"],
    ["Space, .", "pause or go on, one step (virtual time and recordings)"],
    [", and .", "one frame back and on (recordings)"],
    ["R", "begin the run anew"],
    ["S", "section plane: across x, y, z, off"],
    ["T", "light or dark"],
    ["?", "this help"],
  ]],
];

// Keys that belong to the element that has the focus.
export function isTyping(event) {
  const tag = event.target.tagName;
  if (tag === "SELECT" || tag === "DIALOG") return true;
  if (tag === "INPUT" && event.target.type === "number") return event.key !== "Escape";
  if (tag === "INPUT") return event.target.type === "range" ? /^(Arrow|Page|Home|End)/.test(event.key) : event.key === " ";
  return tag === "BUTTON" && (event.key === " " || event.key === "Enter");
}
