// Builds the static page: node build.mjs MODULES[,MODULES] FOLDER
// MODULES: folders of lendulet_wasm.wasm, lendulet_explain.wasm and lendulet_threads.wasm.
// MODULES "-": without an engine of its own, for a native one behind the server.
import { build } from "esbuild";
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const [modules, folder] = process.argv.slice(2);
if (!folder) {
    console.error("usage: node build.mjs MODULES FOLDER");
    process.exit(2);
}
const here = fileURLToPath(new URL(".", import.meta.url));
mkdirSync(folder, { recursive: true });
for (const name of readdirSync(folder)) if (name.startsWith("part-")) rmSync(join(folder, name)); // of other builds
await build({
    entryPoints: { viewer: join(here, "src/main.ts"), worker: join(here, "src/worker.ts") },
    outdir: folder,
    bundle: true,
    splitting: true, // what only WebGPU needs is loaded where there is WebGPU
    chunkNames: "part-[hash]",
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "linked",
    logLevel: "warning",
});
for (const file of ["index.html", "style.css", "explain.css", "icon.svg"])
    copyFileSync(join(here, file), join(folder, file));
const made = {
    "lendulet.wasm": "lendulet_wasm.wasm", "lendulet_explain.wasm": "lendulet_explain.wasm",
    "lendulet_threads.wasm": "lendulet_threads.wasm",
};
if (modules !== "-") {
    const folders = modules.split(",");
    if (folders.some((from) => resolve(from) !== resolve(folder)))
        for (const [file, from] of Object.entries(made))
            copyFileSync(folders.map((name) => join(name, from)).find(existsSync) ?? from, join(folder, file));
} else {
    const page = readFileSync(join(here, "index.html"), "utf8");
    const without = '<head>\n<meta name="lendulet-wasm" content="no">';
    writeFileSync(join(folder, "index.html"), page.replace("<head>", without));
    for (const file of [...Object.keys(made), "native-hashes.json"]) rmSync(join(folder, file), { force: true });
}
