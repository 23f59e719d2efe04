// A worker of the page: lends its thread to the engine, and does nothing else from then on.
import type { Lent } from "./engine/threads";
import { wasiImports } from "./engine/wasi";

self.onmessage = async ({ data }: MessageEvent<Lent>) => {
    const { module, memory, number, stack, own } = data;
    let engine: WebAssembly.Exports | null = null;
    const call = (name: string, ...values: number[]) => (engine![name] as (...values: number[]) => void)(...values);
    try {
        const wasi = wasiImports(module, () => memory);
        engine = (await WebAssembly.instantiate(module, { env: { memory }, wasi_snapshot_preview1: wasi })).exports;
        (engine.__stack_pointer as WebAssembly.Global).value = stack;
        call("__wasm_init_tls", own);
        self.postMessage("there");
        call("lendulet_lend_thread", number);
    } catch (error) {
        if (engine) call("lendulet_thread_stopped"); // whoever waits for this one waits in vain
        self.postMessage((error as Error).message);
    }
};
