// Runs a built-in scene in the WebAssembly module and prints the world's hash: shows that WebAssembly computes the same
// bits as a native build. Usage: node run.mjs MODULE.wasm SCENE STEPS
import { readFileSync } from "node:fs";

const [file, scene, steps] = process.argv.slice(2);
if (!steps) {
    console.error("usage: node run.mjs MODULE.wasm SCENE STEPS");
    process.exit(2);
}
const module = await WebAssembly.compile(readFileSync(file));
// Of WASI there is the clock; whatever else is asked for is answered with errno 8, "bad file descriptor".
const wasi = Object.fromEntries(WebAssembly.Module.imports(module).map((entry) => [entry.name, () => 8]));
wasi.clock_time_get = (_clock, _precision, out) => {
    new DataView(engine.memory.buffer).setBigUint64(out, process.hrtime.bigint(), true);
    return 0;
};
wasi.proc_exit = (code) => process.exit(code || 1);
const engine = (await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi })).exports;
engine._initialize();

function text(at) {
    const bytes = new Uint8Array(engine.memory.buffer);
    return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
}
function check(result) {
    if (result >= 0) return result;
    console.error(text(engine.lendulet_error()));
    process.exit(1);
}

const name = new TextEncoder().encode(scene + "\0"), at = engine.malloc(name.length);
new Uint8Array(engine.memory.buffer, at, name.length).set(name);
const world = engine.lendulet_create_scene(at);
if (!world) check(-1);
const start = performance.now();
for (let i = 0; i < Number(steps); ++i) check(engine.lendulet_step(world));
const took = performance.now() - start;
console.log(BigInt.asUintN(64, engine.lendulet_hash(world)).toString(16).padStart(16, "0"));
if (process.env.TIMES) console.error(`${(took / Number(steps)).toFixed(3)} ms a step`);
