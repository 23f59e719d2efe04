// A WebAssembly module of the engine: its functions by name, and its memory.
import { wasiImports } from "./wasi";

type Call = (...values: (number | bigint)[]) => number;

export interface Started {
    module: WebAssembly.Module;
    exports: WebAssembly.Exports;
}

export class Module {
    private readonly exports: WebAssembly.Exports;

    protected constructor({ exports }: Started) {
        this.exports = exports;
    }
    // `shared`: the memory of a module that does not bring its own.
    protected static async start(source: BufferSource, shared?: WebAssembly.Memory): Promise<Started> {
        const module = await WebAssembly.compile(source);
        let instance: WebAssembly.Instance;
        const memory = () => instance.exports.memory as WebAssembly.Memory;
        const imports: WebAssembly.Imports = { wasi_snapshot_preview1: wasiImports(module, memory) };
        if (shared) imports.env = { memory: shared };
        instance = await WebAssembly.instantiate(module, imports);
        (instance.exports._initialize as () => void)();
        return { module, exports: instance.exports };
    }

    call(name: string, ...values: (number | bigint)[]): number {
        return (this.exports[name] as unknown as Call)(...values);
    }
    // Where memory is shared this is a SharedArrayBuffer, of which what is kept or decoded must be copied first; it is
    // used like another one. Asked for anew each time, since memory grows.
    get buffer(): ArrayBuffer {
        return (this.exports.memory as WebAssembly.Memory).buffer;
    }
    get view(): DataView {
        return new DataView(this.buffer);
    }
    text(at: number): string {
        const bytes = new Uint8Array(this.buffer);
        let end = at;
        while (bytes[end]) ++end;
        return new TextDecoder().decode(bytes.slice(at, end));
    }
    // Runs an action with bytes in the module's memory.
    with<T>(bytes: Uint8Array, action: (at: number) => T): T {
        const at = this.call("malloc", Math.max(bytes.length, 1));
        new Uint8Array(this.buffer, at, bytes.length).set(bytes);
        try {
            return action(at);
        } finally {
            this.call("free", at);
        }
    }
    // The same with words, each with the zero byte that ends it.
    withTexts<T>(texts: string[], action: (at: number[]) => T): T {
        const parts = texts.map((text) => new TextEncoder().encode(`${text}\0`));
        const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0)), places: number[] = [];
        parts.reduce((at, part) => (bytes.set(part, at), places.push(at), at + part.length), 0);
        return this.with(bytes, (at) => action(places.map((place) => at + place)));
    }
}

// The bytes of a file beside the page.
export async function fileBytes(file: string): Promise<Uint8Array<ArrayBuffer>> {
    const answer = await fetch(file);
    if (!answer.ok) throw new Error(`${file} cannot be loaded (${answer.status})`);
    return new Uint8Array(await answer.arrayBuffer());
}
