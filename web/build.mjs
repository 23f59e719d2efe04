// Builds the static page: node build.mjs MODULE.wasm FOLDER
// MODULE "-": without an engine of its own, for a native one behind the server.
import { build } from "esbuild";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
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
if (module !== "-") {
    if (resolve(module) !== resolve(folder, "lendulet.wasm")) copyFileSync(module, join(folder, "lendulet.wasm"));
} else {
    const page = readFileSync(join(here, "index.html"), "utf8");
    const without = '<head>\n<meta name="lendulet-wasm" content="no">';
    writeFileSync(join(folder, "index.html"), page.replace("<head>", without));
    for (const file of ["lendulet.wasm", "native-hashes.json"]) rmSync(join(folder, file), { force: true });
}
