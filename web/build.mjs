// Builds the static page: node build.mjs MODULE.wasm FOLDER
import { build } from "esbuild";
import { copyFileSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const [module, folder] = process.argv.slice(2);
if (!folder) {
    console.error("usage: node build.mjs MODULE.wasm FOLDER");
    process.exit(2);
}
const here = fileURLToPath(new URL(".", import.meta.url));
mkdirSync(folder, { recursive: true });
await build({
    entryPoints: [join(here, "src/main.ts")],
    outfile: join(folder, "viewer.js"),
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "linked",
    logLevel: "warning",
});
for (const file of ["index.html", "style.css", "icon.svg"]) copyFileSync(join(here, file), join(folder, file));
copyFileSync(module, join(folder, "lendulet.wasm"));
