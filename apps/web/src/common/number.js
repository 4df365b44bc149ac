// Numbers as people write them: no exponents, a true minus, and 0 for what is nothing but rounding.
const minShown = 1e-9;
const maxPlaces = 6;

// `digits` significant ones, and no zeros behind the last that says something.
export function written(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) < minShown) return "0";
  const places = Math.min(maxPlaces, Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(value)))));
  const text = value.toFixed(places);
  return signed(text.includes(".") ? text.replace(/\.?0+$/, "") : text);
}

// A fixed number of places, for columns that change while one reads them.
export const fixed = (value, places) => (Number.isFinite(value) ? signed(value.toFixed(places)) : "–");

// A length in m, in the unit that people would take for it.
export function length(meters, digits = 4) {
  const size = Math.abs(meters);
  if (size < minShown) return "0\u00a0mm";
  return size < 1e-4 ? `${written(1e6 * meters, digits)}\u00a0µm` : `${written(1e3 * meters, digits)}\u00a0mm`;
}

// A number that may be of any size, as in reports: where it would be all zeros, with a power of ten.
export function plain(value, digits = 6) {
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-6 && size < 1e9)) return signed(String(Number(value.toPrecision(digits))));
  const [head, power] = value.toExponential(digits - 1).split("e");
  const raised = String(Number(power)).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
  return signed(`${Number(head)} × 10${raised}`.replace(/^(-?)1 × /, "$1"));
}

const signed = (text) => (Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−"));
