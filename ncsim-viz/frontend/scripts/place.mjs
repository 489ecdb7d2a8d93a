// Inlines what Vite built into one HTML file, the package data of the ncsim_viz wheel.
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "..", "dist");
const target = process.argv[2] ?? join(here, "..", "..", "src", "ncsim_viz", "viewer.html");

const script = readFileSync(join(dist, "viewer.js"), "utf8").replaceAll("</script", "<\\/script");
const style = readFileSync(join(dist, "viewer.css"), "utf8").trim();
const page = readFileSync(join(dist, "index.html"), "utf8")
  .replace(/\s*<script[^>]*viewer\.js"[^>]*><\/script>/, "")
  .replace(/\s*<link[^>]*viewer\.css"[^>]*>/, () => `\n    <style>${style}</style>`)
  .replace("<!--NCSIM-DATA-->", () => `<!--NCSIM-DATA-->\n    <script type="module">${script.trim()}</script>`);
if (!page.includes("<style>") || !page.includes("<!--NCSIM-DATA-->")) {
  throw new Error("index.html has not the expected form");
}
writeFileSync(target, page);
console.log(`${target}: ${page.length} characters`);
