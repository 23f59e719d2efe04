// Files in and out: what is dropped onto the page, and what can be saved from it.
import type { App } from "../app";
import type { Script } from "../deeds";
import { base64, withFiles } from "../engine/embed";
import { readGltf } from "../engine/gltf";
import { isRecording, RecordingWorld } from "../engine/recording";
import { Refused } from "../engine/types";
import { element } from "./dom";
import { download, Recorder } from "./record";
import { readRepro, type Repro } from "./repro";

const largest = 256 * 1024 * 1024; // bytes of a file

export class Files {
    private recorder: Recorder | null = null;
    private film: MediaRecorder | null = null;
    private gltf: Uint8Array | null = null; // the file that the world comes from

    constructor(private readonly app: App) {
        const on = (id: string, action: () => void) => element(id).addEventListener("click", () => app.guarded(action));
        on("save-repro", () => this.saveRepro());
        on("save-picture", () => this.savePicture());
        on("record", () => this.record());
        on("film", () => this.filmNow());
        const chooser = element<HTMLInputElement>("file");
        on("open-file", () => chooser.click());
        chooser.addEventListener("change", () => {
            void this.openAll([...(chooser.files ?? [])]);
            chooser.value = "";
        });
        window.addEventListener("dragover", (event) => event.preventDefault());
        window.addEventListener("drop", (event) => {
            event.preventDefault();
            void this.openAll([...(event.dataTransfer?.files ?? [])]);
        });
        app.opened = () => this.stop();
        const { player } = app, before = player.stepped;
        player.stepped = (poses) => {
            before(poses);
            this.recorder?.add(poses, () => player.world.shapes());
        };
    }

    // What is wrong with a file is said, and what there is stays. Of several files one is opened, the others are those
    // that it refers to.
    async openAll(files: File[]): Promise<void> {
        const file = files.find(({ name }) => /\.gl(b|tf)$/i.test(name)) ?? files[0];
        if (!file) return;
        try {
            if (files.some(({ size }) => size > largest)) throw new Refused(`${file.name} is larger than 256 MB.`);
            const bytes = new Uint8Array(await file.arrayBuffer());
            if (isRecording(bytes)) this.openRecording(file.name, bytes);
            else if (/\.gl(b|tf)$/i.test(file.name)) this.openGltf(file.name, await withFiles(bytes, files));
            else if (/\.json$/i.test(file.name)) this.openRepro(file.name, bytes);
            else throw new Refused(`${file.name} is neither glTF nor a recording nor a repro file.`);
        } catch (error) {
            if (!(error instanceof Refused)) console.warn(error);
            this.app.say(error instanceof Error ? error.message : String(error));
        }
    }
    private openRecording(name: string, bytes: Uint8Array): void {
        this.app.openWith(name, () => new RecordingWorld(bytes));
    }
    private openGltf(name: string, bytes: Uint8Array<ArrayBuffer>, script?: Script): void {
        const { engine } = this.app.sources;
        if (!engine) throw new Refused(`This page has no engine of its own: lendulet view ${name} shows the file.`);
        const warnings: string[] = [];
        if (!this.app.openWith(name, () => readGltf(engine, bytes, warnings), {}, script)) return;
        this.gltf = bytes;
        if (warnings.length > 0) this.app.say(`${name}: ${warnings[0]}`);
    }
    openRepro(name: string, bytes: Uint8Array): void {
        const { scene, steps, hash, deeds, gltf } = readRepro(name, bytes), { app } = this;
        const reached = () => {
            const now = app.player.world.hash;
            if (now) app.say(now === hash ? "The same bits as when it was saved." : "Not the bits that were saved.");
        };
        const script = { deeds, end: { step: steps, reached } };
        if (gltf === undefined) app.open(scene, {}, script);
        else this.openGltf(scene, Uint8Array.from(atob(gltf), (c) => c.charCodeAt(0)), script);
    }

    private saveRepro(): void {
        const { player } = this.app;
        const repro: Repro = {
            lendulet: "repro", version: 1, scene: player.sceneName, steps: player.world.stepCount,
            hash: player.world.hash, deeds: player.deeds,
        };
        if (player.world.kind === "recording") throw new Refused("A recording is a file already.");
        if (this.gltf) repro.gltf = base64(this.gltf);
        download(`${this.name}.json`, JSON.stringify(repro, null, 1));
    }
    private savePicture(): void {
        this.app.stage.render();
        this.app.stage.canvas.toBlob((blob) => blob && download(`${this.name}.png`, blob));
    }
    private record(): void {
        const { player } = this.app, button = element("record");
        if (this.recorder) {
            download(`${this.name}.rec`, this.recorder.finish(player.world.hash));
            this.recorder = null;
        } else {
            player.resume();
            const { world } = player;
            this.recorder = new Recorder(player.sceneName, world.stepSize, world.shapes(), player.now);
        }
        button.setAttribute("aria-pressed", String(this.recorder !== null));
    }
    // Ends a recording that another scene would spoil.
    stop(): void {
        this.recorder = null;
        this.gltf = null;
        element("record").setAttribute("aria-pressed", "false");
    }
    private filmNow(): void {
        const button = element("film");
        if (this.film) {
            this.film.stop();
            this.film = null;
        } else {
            const parts: Blob[] = [], film = new MediaRecorder(this.app.stage.canvas.captureStream(30));
            film.addEventListener("dataavailable", (event) => parts.push(event.data));
            const kind = film.mimeType.includes("mp4") ? "mp4" : "webm";
            film.addEventListener("stop", () => download(`${this.name}.${kind}`, new Blob(parts)));
            film.start();
            // A scene that stands is drawn once for it.
            requestAnimationFrame(() => this.app.stage.render());
            this.film = film;
        }
        button.setAttribute("aria-pressed", String(this.film !== null));
    }
    private get name(): string {
        return this.app.player.sceneName.replaceAll(/[^\w.-]+/g, "-");
    }
}
