// Bundles our modules and styles into static/dist under plain names; Django's manifest storage
// adds the hashes. Usage: node static/build.mjs [--watch]
import { rm } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const watch = process.argv.includes("--watch");

const common = {
  bundle: true,
  minify: !watch,
  sourcemap: watch ? "inline" : false,
  legalComments: "linked",
  outdir: here("dist"),
  target: ["chrome123", "firefox121", "safari17.5"],
  logLevel: "info",
};

const builds = [
  // theme.js runs before the first paint, so it is a classic script; the rest are modules.
  { ...common, format: "iife", entryPoints: [here("src/theme.js")] },
  {
    ...common,
    format: "esm",
    entryPoints: ["main", "charts", "tree", "editor", "label", "examples", "audit", "refusal", "review", "campaign", "entrance", "my-drafts"].map((name) =>
      here(`src/${name}.js`),
    ),
  },
  { ...common, entryPoints: [here("css/main.css")] },
  { ...common, loader: { ".svg": "copy" }, entryPoints: [here("favicon.svg")] },
];

await rm(here("dist"), { recursive: true, force: true });
if (watch) {
  const contexts = await Promise.all(builds.map((options) => esbuild.context(options)));
  await Promise.all(contexts.map((context) => context.watch()));
} else {
  await Promise.all(builds.map((options) => esbuild.build(options)));
}
