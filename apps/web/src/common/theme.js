// Lets a page choose between light and dark itself: the style sheet's own query for the scheme is switched on or off.
const query = "prefers-color-scheme";

export const systemIsDark = () => matchMedia(`(${query}: dark)`).matches;

const rules = () =>
  [...document.styleSheets].flatMap((sheet) =>
    [...sheet.cssRules].filter((rule) => rule instanceof CSSMediaRule && (rule.tegotaeScheme ?? rule.conditionText).includes(query)));

export function setDark(dark) {
  for (const rule of rules()) {
    rule.tegotaeScheme = query; // its condition is gone after the first time
    rule.media.mediaText = dark ? "all" : "not all";
  }
  document.documentElement.style.colorScheme = dark ? "dark" : "light";
}

export const cssColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
