// Runs a WebAssembly program with as much of WASI as Lendület needs: arguments, standard output and a clock.
// Usage: node run.mjs PROGRAM.wasm ARGUMENTS…
import { readFileSync, writeSync } from "node:fs";

const args = process.argv.slice(2).map((text) => new TextEncoder().encode(text + "\0"));
const module = await WebAssembly.compile(readFileSync(process.argv[2]));
const bytes = () => new Uint8Array(instance.exports.memory.buffer);
const view = () => new DataView(instance.exports.memory.buffer);

const known = {
    args_sizes_get: (count, size) => (view().setUint32(count, args.length, true), view().setUint32(size, args.reduce((n, a) => n + a.length, 0), true), 0),
    args_get(pointers, text) {
        for (const argument of args) {
            view().setUint32(pointers, text, true);
            bytes().set(argument, text);
            pointers += 4;
            text += argument.length;
        }
        return 0;
    },
    clock_time_get: (_clock, _precision, time) => (view().setBigUint64(time, process.hrtime.bigint(), true), 0),
    fd_write(fd, vectors, count, written) {
        let total = 0;
        for (let i = 0; i < count; ++i) {
            const start = view().getUint32(vectors + 8 * i, true), length = view().getUint32(vectors + 8 * i + 4, true);
            if (length) total += writeSync(fd, bytes().subarray(start, start + length));
        }
        view().setUint32(written, total, true);
        return 0;
    },
    proc_exit: (code) => process.exit(code),
};
// Whatever else is asked for is answered with WASI's errno 8, "bad file descriptor": there are no files here.
const names = WebAssembly.Module.imports(module).map((entry) => entry.name);
const wasi = Object.fromEntries(names.map((name) => [name, known[name] ?? (() => 8)]));
const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi });
instance.exports._start();
