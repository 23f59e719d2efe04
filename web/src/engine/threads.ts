// Threads for the engine in the page: workers of the page, each with an instance of the module over the same memory,
// which lend themselves to it. Memory can be shared where the page is isolated from others, which its server says by
// two headers: see docs/viewer.md. Nobody waits for a worker: a step does itself what nobody has come for.
import type { Started } from "./module";

// What a worker is given.
export interface Lent {
    module: WebAssembly.Module;
    memory: WebAssembly.Memory;
    number: number; // 1 and on: the page's own thread is 0
    stack: number;  // where its stack ends, from which it grows down
    own: number;    // where its own variables begin
}

export const mostThreads = 16;
const pageBytes = 65536, firstPages = 256; // at least, as the module is linked
const mostMegabytes = [2048, 512];         // at most, and where a machine has no room for that
const stackBytes = 1 << 20;                // as the module's own

// How many threads worlds get, `asked` being what the address says: with half of what the machine runs at once the
// drawing, the browser itself and others have room. The page's thread cannot give up its core where it waits for
// another one that has none, so with all of them a step takes longer than alone as soon as anybody else does anything.
export function usualThreads(asked: string | null): number {
    if (!globalThis.crossOriginIsolated || typeof SharedArrayBuffer === "undefined") return 1;
    const wanted = Number(asked);
    if (asked !== null && wanted >= 1) return Math.min(Math.floor(wanted), mostThreads);
    return Math.min(Math.max(navigator.hardwareConcurrency >> 1, 1), 8);
}

export function sharedMemory(): WebAssembly.Memory {
    let refused: unknown;
    for (const megabytes of mostMegabytes)
        try {
            const maximum = megabytes * ((1 << 20) / pageBytes);
            return new WebAssembly.Memory({ initial: firstPages, maximum, shared: true });
        } catch (error) {
            refused = error;
        }
    throw refused;
}

export class Threads {
    there = 1; // that take part in steps, the page's own included
    trouble = ""; // the sentence that says why there are fewer than were asked for
    private asked = 1;
    private readonly listeners: ((sentence: string) => void)[] = [];

    constructor(
        private readonly engine: Started, private readonly memory: WebAssembly.Memory, readonly usual: number,
    ) {}

    // From now on there may be so many, as soon as they have come. They stay: where fewer are wanted the others sleep.
    want(count: number): void {
        while (this.asked < Math.min(count, mostThreads) && this.trouble === "") this.start(this.asked++);
    }
    // Told of trouble, also of that which was before.
    onTrouble(listener: (sentence: string) => void): void {
        this.listeners.push(listener);
        if (this.trouble !== "") listener(this.trouble);
    }

    private start(number: number): void {
        const { exports, module } = this.engine;
        const value = (name: string) => (exports[name] as WebAssembly.Global).value as number;
        const block = (exports.malloc as (bytes: number) => number)(stackBytes + value("__tls_size") + 64);
        const stack = (block + stackBytes) & ~63;
        const lost = (why: string) => {
            this.trouble = `A thread of the engine is missing (${why}): the page goes on with ${this.there}.`;
            for (const listener of this.listeners) listener(this.trouble);
        };
        let worker: Worker;
        try {
            worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
        } catch (error) {
            return lost((error as Error).message);
        }
        worker.onerror = (event) => lost(event.message || "worker.js cannot be loaded");
        worker.onmessage = ({ data }: MessageEvent<string>) => {
            if (data === "there") ++this.there;
            else lost(data);
        };
        worker.postMessage({ module, memory: this.memory, number, stack, own: stack } satisfies Lent);
    }
}
