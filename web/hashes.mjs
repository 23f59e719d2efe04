// Runs the page's scenes natively and writes their hashes for the page to compare with:
// node hashes.mjs path/to/lendulet OUT.json [SCENE …]
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";

const [program, out, ...only] = process.argv.slice(2);
if (!out) {
    console.error("usage: node hashes.mjs path/to/lendulet OUT.json [SCENE …]");
    process.exit(2);
}
const table = JSON.parse(readFileSync(new URL("src/scenes.json", import.meta.url), "utf8"));
const names = table
    .flatMap(({ scenes }) => Object.entries(scenes))
    .filter(([name]) => only.length === 0 || only.includes(name))
    .map(([name, { size }]) => (size ? `${name}:${size}` : name));
const steps = 120, hashes = {};
for (const name of names) {
    const json = execFileSync(program, ["run", name, "--seconds", "2", "--quiet", "--json", "-"],
        { encoding: "utf8", maxBuffer: 64 * 1024 * 1024 });
    const run = JSON.parse(json);
    if (run.steps !== steps) throw new Error(`${name}: ${run.steps} steps in 2 s, expected ${steps}`);
    hashes[name] = run.hash;
}
writeFileSync(out, JSON.stringify({ steps, hashes }, null, 1) + "\n");
