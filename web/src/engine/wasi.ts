// As much of WASI as the engine asks for: a clock for its stage times, and the end of the program where it finds a bug
// of its own, with the sentence that it writes on standard error before that.

export class EngineStopped extends Error {}

export function wasiImports(module: WebAssembly.Module, memory: () => WebAssembly.Memory): WebAssembly.ModuleImports {
    const badFile = 8; // WASI's errno: there are no files here
    let text = "";
    const known: Record<string, (...values: never[]) => number> = {
        clock_time_get(_clock: number, _precision: bigint, out: number) {
            new DataView(memory().buffer).setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
            return 0;
        },
        fd_write(_file: number, vectors: number, count: number, written: number) {
            const view = new DataView(memory().buffer);
            let total = 0;
            for (let i = 0; i < count; ++i) {
                const start = view.getUint32(vectors + 8 * i, true), size = view.getUint32(vectors + 8 * i + 4, true);
                text += new TextDecoder().decode(new Uint8Array(memory().buffer, start, size).slice());
                total += size;
            }
            view.setUint32(written, total, true);
            return 0;
        },
        proc_exit(code: number): number {
            throw new EngineStopped(text.trim() || `the engine stopped with code ${code}`);
        },
    };
    const imports: WebAssembly.ModuleImports = {};
    for (const { kind, name } of WebAssembly.Module.imports(module))
        if (kind === "function") imports[name] = known[name] ?? (() => badFile);
    return imports;
}
