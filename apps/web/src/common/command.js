// A command that can be pasted into any shell: {command: [word, ...], files: [place, ...]}; the words at these places are
// paths from this page's folder. A page that did not come from a disk cannot tell where it is, and leaves them as they are.
export function commandText({ command, files }) {
  return command.map((word, place) => quoted(files.includes(place) ? absolute(word) : word)).join(" ");
}

function absolute(path) {
  if (location.protocol !== "file:") return path;
  const url = new URL(path.split("/").map(encodeURIComponent).join("/"), location.href);
  try {
    return decodeURIComponent(url.pathname).replace(/(.)\/$/, "$1");
  } catch {
    return path; // a name that is not UTF-8
  }
}

const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
