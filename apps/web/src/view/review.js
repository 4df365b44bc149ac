// Requests a report from the program and saves it; saves the motion of the hand as a stylus script.
import { bundleOf } from "./bundle.js";

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

const stem = (title) => title.replace(/.*\//, "").replace(/\.[^.]*$/, "");

// ask(): the report, a blob, of a recording or a run called `title`. Its verdict is told at once.
export function addReview(button, ask, title, onMessage) {
  button.hidden = false;
  button.addEventListener("click", async () => {
    button.disabled = true;
    onMessage("Making the report …", "work");
    try {
      const report = await ask(), name = `${stem(title)}.review.html`;
      save(report, name);
      onMessage(`${bundleOf(await report.text()).about.verdict.headline}. The report is saved as ${name}.`, "news");
    } catch (error) {
      onMessage(error.message);
    } finally {
      button.disabled = false;
    }
  });
}

// What `run --script` reads: where the pen wanted the held part's file frame, from the first of these frames on.
export function stylusScript(frames) {
  if (frames.length === 0) throw new Error("The run has not begun.");
  const rows = ["t,px,py,pz,qw,qx,qy,qz"];
  let last = -Infinity;
  for (const { t, y } of frames) {
    if (!(t > last)) continue;
    last = t;
    rows.push([t - frames[0].t, ...y].map((v) => Number(v.toPrecision(9))).join());
  }
  return rows.join("\n") + "\n";
}

export function saveScript(frames, title) {
  save(new Blob([stylusScript(frames)], { type: "text/csv" }), `${stem(title)}.hand.csv`);
}
