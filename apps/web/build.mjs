// Builds every page of src/<page>/ (main.js, style.css, page.html) into one self-contained file, dist/<page>.html:
//
//     cd apps/web && npm ci && npm run build
//
// dist/ is committed, so that building the library needs no Node. The licenses of the libraries that a page uses go into it.
import { existsSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const here = new URL(".", import.meta.url).pathname;

async function bundle(entry) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2020",
    charset: "utf8",
    legalComments: "inline",
    logLevel: "warning",
    metafile: true,
  });
  return { text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs) };
}

function licenses(inputs) {
  const names = new Set(inputs.map((file) => file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1]).filter(Boolean));
  return [...names].sort().map((name) => {
    const file = `${here}node_modules/${name}/LICENSE`;
    if (!existsSync(file)) throw new Error(`${name} has no LICENSE`);
    return `${name}:\n${readFileSync(file, "utf8").trim()}\n`;
  }).join("\n");
}

for (const page of readdirSync(here + "src")) {
  const source = `${here}src/${page}/`;
  if (!statSync(source).isDirectory() || page === "common") continue;
  const script = await bundle(source + "main.js");
  const style = await bundle(source + "style.css");
  // Functions as replacements: a bundle may contain "$&" and its like.
  const html = readFileSync(source + "page.html", "utf8")
    .replace("/*LICENSES*/", () => licenses([...script.inputs, ...style.inputs]).replaceAll("--", "- -"))
    .replace("/*STYLE*/", () => style.text)
    .replace("/*SCRIPT*/", () => script.text.replaceAll("</script", "<\\/script"));
  const file = `${here}dist/${page}.html`;
  writeFileSync(file, html);
  console.log(`${page}: ${Math.round(html.length / 1024)} KB`);
}
