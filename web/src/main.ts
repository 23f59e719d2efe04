// Loads the engine, finds out what this page is to show, and starts the viewer. `?shadows=0` leaves shadows out,
// `?ao=0` ambient occlusion, for machines that draw in software; `?draw=webgl` or `webgpu` says what draws;
// `?threads=N` with how many threads the engine in the page begins.
import { App } from "./app";
import { Engine } from "./engine/engine";
import type { ExplainMode } from "./explain/mode";
import { fileBytes } from "./engine/module";
import { usualThreads } from "./engine/threads";
import { Sources } from "./sources";
import { connect } from "./ui/controls";
import { element } from "./ui/dom";
import { connectExplain } from "./ui/explain";
import { chooseDrawer } from "./view/drawer";
import { Stage } from "./view/stage";

declare global {
    interface Window {
        lendulet?: App; // for scripts and tests, once the first scene stands
        lenduletExplain?: ExplainMode; // once it has been opened
    }
}

// Where threads may be shared the module that has them, everywhere else the one that has not.
async function loadEngine(threads: number): Promise<Engine | null> {
    if (!Sources.wantsEngine) return null;
    if (threads > 1)
        try {
            return await Engine.loadShared(await fileBytes("lendulet_threads.wasm"), threads);
        } catch (error) {
            console.warn(`The engine in the page has one thread: ${(error as Error).message}`);
        }
    return Engine.load(await fileBytes("lendulet.wasm"));
}

async function main(): Promise<void> {
    const options = new URLSearchParams(location.search), shadows = Number(options.get("shadows") ?? 2048);
    const threads = options.get("threads") ?? (Sources.hasStream ? "1" : null); // the native engine has its own
    const sources = await Sources.find(await loadEngine(usualThreads(threads)));
    const occlusion = shadows > 0 && options.get("ao") !== "0";
    const canvas = element<HTMLCanvasElement>("canvas");
    const make = await chooseDrawer(canvas, shadows > 0, options.get("draw"));
    const stage = new Stage(canvas, shadows, occlusion, make);
    const app = new App(sources, stage);
    stage.lost = (sentence) => app.say(sentence, true);
    sources.engine?.threads?.onTrouble((sentence) => app.say(sentence));
    sources.lost = (sentence) => app.lost(sentence);
    const address = location.hash; // the app writes its own
    app.start();
    while (!app.player.world) await new Promise((done) => setTimeout(done, 10));
    connect(app);
    connectExplain(app, shadows, address);
    element("loading").hidden = true;
    window.lendulet = app;
}

main().catch((error: Error) => {
    console.error(error);
    element("loading").hidden = false;
    element("loading").textContent = `The viewer cannot start: ${error.message}`;
});
