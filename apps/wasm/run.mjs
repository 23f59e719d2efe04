// Runs a built-in scene in the WebAssembly module and prints the world's hash: shows that WebAssembly computes the same
// bits as a native build. Usage: node run.mjs MODULE.wasm SCENE STEPS [THREADS]
// THREADS: of a module that was built for them (lendulet-threads of ./dev web), the calling one included; 1 otherwise.
import { readFileSync } from "node:fs";
import { isMainThread, parentPort, Worker, workerData } from "node:worker_threads";

// Of WASI there is the clock; whatever else is asked for is answered with errno 8, "bad file descriptor".
async function instance(module, memory) {
    const imports = {}, list = WebAssembly.Module.imports(module).filter(({ kind }) => kind === "function");
    const wasi = Object.fromEntries(list.map(({ name }) => [name, () => 8]));
    wasi.clock_time_get = (_clock, _precision, out) => {
        new DataView(exports.memory.buffer).setBigUint64(out, process.hrtime.bigint(), true);
        return 0;
    };
    wasi.proc_exit = (code) => process.exit(code || 1);
    if (memory) imports.env = { memory };
    const { exports } = await WebAssembly.instantiate(module, { ...imports, wasi_snapshot_preview1: wasi });
    return exports;
}

async function lend({ module, memory, number, stack, own }) {
    const engine = await instance(module, memory);
    engine.__stack_pointer.value = stack;
    engine.__wasm_init_tls(own);
    parentPort.postMessage("ready");
    try {
        engine.lendulet_lend_thread(number);
    } catch (error) {
        engine.lendulet_thread_stopped();
        throw error;
    }
}

async function start(module, threads) {
    if (threads === 1 && !WebAssembly.Module.imports(module).some(({ kind }) => kind === "memory")) {
        const engine = await instance(module);
        engine._initialize();
        return engine;
    }
    const memory = new WebAssembly.Memory({ initial: 256, maximum: 32768, shared: true });
    const engine = await instance(module, memory), stackBytes = 1 << 20;
    engine._initialize();
    for (let number = 1; number < threads; ++number) {
        const stack = (engine.malloc(stackBytes + engine.__tls_size.value + 64) + stackBytes) & ~63;
        const worker = new Worker(new URL(import.meta.url), {
            workerData: { module, memory, number, stack, own: stack },
        });
        await new Promise((ready, failed) => worker.once("message", ready).once("error", failed));
    }
    return engine;
}

async function run(file, scene, steps, threads) {
    const engine = await start(await WebAssembly.compile(readFileSync(file)), threads);
    const bytes = () => new Uint8Array(engine.memory.buffer);
    const text = (at) => new TextDecoder().decode(bytes().slice(at, bytes().indexOf(0, at)));
    const check = (result) => {
        if (result >= 0) return result;
        console.error(text(engine.lendulet_error()));
        process.exit(1);
    };
    const name = new TextEncoder().encode(scene + "\0"), room = engine.malloc(Math.max(name.length, 64));
    bytes().set(name, room);
    const world = engine.lendulet_create_scene(room);
    if (!world) check(-1);
    if (threads > 1) { // lendulet_settings.workers
        check(engine.lendulet_read_settings(world, room));
        new DataView(engine.memory.buffer).setInt32(room + 32, threads, true);
        check(engine.lendulet_set_settings(world, room));
    }
    const begin = performance.now();
    for (let i = 0; i < steps; ++i) check(engine.lendulet_step(world));
    const took = performance.now() - begin;
    console.log(BigInt.asUintN(64, engine.lendulet_hash(world)).toString(16).padStart(16, "0"));
    if (process.env.TIMES) console.error(`${(took / steps).toFixed(3)} ms a step`);
    process.exit(0); // the other threads sleep
}

const [file, scene, steps, threads = "1"] = process.argv.slice(2);
if (!isMainThread) await lend(workerData);
else if (steps) await run(file, scene, Number(steps), Number(threads));
else {
    console.error("usage: node run.mjs MODULE.wasm SCENE STEPS [THREADS]");
    process.exit(2);
}
