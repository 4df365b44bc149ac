// The view page in a real browser: what it shows is asked of its own state and of what the program sends, not of pixels.
//   TEGOTAE_BIN_DIR=build/release/bin TEGOTAE_MODELS_DIR=models node tests/view/browser.mjs [PART OF A NAME]
import "./browser_access.mjs";
import "./browser_first_hour.mjs";
import "./browser_keys.mjs";
import "./browser_live.mjs";
import "./browser_replay.mjs";
import "./browser_review.mjs";
import "./browser_parts.mjs";
import "./browser_section.mjs";
import "./browser_study.mjs";
import "./browser_step.mjs";
import "./pieces.mjs";
import { runCases } from "./cases.mjs";

process.exit((await runCases(process.argv[2] ?? "")) > 0 ? 1 : 0);
