// The block of bytes that the page begins with (apps/view/bundle.hpp): a description and arrays.
export function readBundle(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const about = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const begin = 4 + length;
  return {
    about,
    floats: ({ at, count }) => new Float32Array(buffer, begin + 4 * at, count),
    integers: ({ at, count }) => new Uint32Array(buffer, begin + 4 * at, count),
  };
}

// What a file carries inside; null when the page was served.
export function embeddedBundle() {
  const text = document.getElementById("data").textContent.trim();
  return text ? writtenBundle(text) : null;
}

// The same of another page's text.
export const bundleOf = (html) => writtenBundle(html.match(/ id="data">([^<]*)</)[1].trim());

function writtenBundle(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return readBundle(bytes.buffer);
}
