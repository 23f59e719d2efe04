// Where worlds come from: the engine in the page, a native engine behind this very server, or a file that it serves.
import type { Engine } from "./engine/engine";
import { fileBytes } from "./engine/module";
import { RecordingWorld } from "./engine/recording";
import { type Catalogue, Connection, StreamWorld } from "./engine/stream";
import { type Explain, explainInPage } from "./explain/sequence";
import { Refused, type World } from "./engine/types";

const meta = (name: string) => document.querySelector<HTMLMetaElement>(`meta[name="${name}"]`)?.content ?? null;

export class Sources implements Catalogue {
    scenes: Catalogue["scenes"] = [];
    stages: string[] = [];
    choices: string[][] = [[], [], []];
    native = false; // new worlds are computed by the native engine
    connection: Connection | null = null;
    // What the server was started with.
    given: { name: string; make: () => World | Promise<World> } | null = null;
    // A repro file that it was started with.
    repro: { name: string; bytes: Uint8Array } | null = null;
    lost: (sentence: string) => void = () => undefined;

    private constructor(readonly engine: Engine | null) {}

    static get wantsEngine(): boolean {
        return meta("lendulet-wasm") !== "no";
    }
    static get hasStream(): boolean {
        return meta("lendulet-stream") !== null;
    }
    static async find(engine: Engine | null): Promise<Sources> {
        const sources = new Sources(engine);
        if (engine) sources.take(engine);
        if (Sources.hasStream) await sources.connect();
        const recording = meta("lendulet-recording"), repro = meta("lendulet-repro");
        if (repro !== null) sources.repro = { name: repro, bytes: await fileBytes("repro") };
        if (recording !== null) {
            const bytes = await fileBytes("recording");
            sources.given = { name: recording, make: () => new RecordingWorld(bytes) };
        }
        return sources;
    }
    private take(catalogue: Catalogue): void {
        this.scenes = catalogue.scenes;
        this.stages = catalogue.stages;
        this.choices = catalogue.choices;
    }
    private async connect(): Promise<void> {
        const address = new URL("stream", location.href);
        address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
        address.hash = address.search = "";
        const connection = await Connection.open(address.href);
        this.take(await connection.catalogue());
        connection.lost = () => {
            this.native = false;
            this.connection = null;
            this.lost(this.engine
                ? "The native engine is gone. R runs this scene in the page, as do those that you open now."
                : "The native engine is gone: start it and load the page again.");
        };
        this.connection = connection;
        this.native = true;
        const name = meta("lendulet-stream") || meta("lendulet-title") || "scene";
        // The file of the command line is the native engine's alone; a scene is known to the page too.
        const isScene = Boolean(meta("lendulet-stream"));
        this.given = { name, make: () => (this.native || !isScene ? this.openNative("") : this.open(name)) };
    }

    // Null: nobody here can explain.
    get explain(): Explain | null {
        if (this.engine) return explainInPage;
        if (!this.connection) return null;
        return async (question) => {
            if (!this.connection) throw new Refused("The native engine is gone.");
            return this.connection.explain(question);
        };
    }

    // Throws Refused, or rejects, with the engine's sentence.
    open(scene: string): World | Promise<World> {
        if (this.native) return this.openNative(scene);
        if (!this.engine) throw new Refused("This page has no engine of its own (./dev web builds one with it).");
        return this.engine.create(scene);
    }
    private openNative(scene: string): Promise<World> {
        if (!this.connection) throw new Refused("The native engine is gone.");
        return StreamWorld.open(this.connection, scene, scene === "" ? meta("lendulet-gltf") : null);
    }
}
