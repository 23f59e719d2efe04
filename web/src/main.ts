// Loads the engine, finds out what this page is to show, and starts the viewer. `?shadows=0` leaves shadows out,
// `?ao=0` ambient occlusion, for machines that draw in software.
import { App } from "./app";
import { Engine } from "./engine/engine";
import { Sources } from "./sources";
import { connect } from "./ui/controls";
import { element } from "./ui/dom";
import { Stage } from "./view/stage";

declare global {
    interface Window {
        lendulet?: App; // for scripts and tests, once the first scene stands
    }
}

async function loadEngine(): Promise<Engine | null> {
    if (!Sources.wantsEngine) return null;
    const answer = await fetch("lendulet.wasm");
    if (!answer.ok) throw new Error(`lendulet.wasm cannot be loaded (${answer.status})`);
    return Engine.load(await answer.arrayBuffer());
}

async function main(): Promise<void> {
    const sources = await Sources.find(await loadEngine());
    const options = new URLSearchParams(location.search), shadows = Number(options.get("shadows") ?? 2048);
    const occlusion = shadows > 0 && options.get("ao") !== "0";
    const stage = new Stage(element<HTMLCanvasElement>("canvas"), shadows, occlusion);
    const app = new App(sources, stage);
    sources.lost = (sentence) => app.say(sentence);
    app.start();
    while (!app.player.world) await new Promise((done) => setTimeout(done, 10));
    connect(app);
    element("loading").hidden = true;
    window.lendulet = app;
}

main().catch((error: Error) => {
    console.error(error);
    element("loading").hidden = false;
    element("loading").textContent = `The viewer cannot start: ${error.message}`;
});
