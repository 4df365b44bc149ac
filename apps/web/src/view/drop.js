// A file that is dropped on the page: the browser would leave the page for it. The page cannot read parts; the program does.
const shown = (name) => (/^[\w.+-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`);

export function listenToDrops(onMessage) {
  const wanted = ({ target, dataTransfer }) => target.tagName === "INPUT" && !dataTransfer?.types.includes("Files"); // text into a field
  addEventListener("dragover", (event) => wanted(event) || event.preventDefault());
  addEventListener("drop", (event) => {
    if (wanted(event)) return;
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    onMessage(`This page shows what the program has opened. To open the file: tegotae view ${shown(file.name)}`, "news");
  });
}
