// Loads the engine and starts the viewer. `?shadows=0` leaves shadows out, for machines that draw in software.
import { App } from "./app";
import { Engine } from "./engine/engine";
import { connect } from "./ui/controls";
import { element } from "./ui/dom";
import { Stage } from "./view/stage";

declare global {
    interface Window {
        lendulet?: App; // for scripts and tests, once the first scene stands
    }
}

async function main(): Promise<void> {
    const answer = await fetch("lendulet.wasm");
    if (!answer.ok) throw new Error(`lendulet.wasm cannot be loaded (${answer.status})`);
    const engine = await Engine.load(await answer.arrayBuffer());
    const wanted = new URLSearchParams(location.search).get("shadows");
    const stage = new Stage(element<HTMLCanvasElement>("canvas"), wanted === null ? 2048 : Number(wanted));
    const app = new App(engine, stage);
    app.start();
    connect(app);
    element("loading").hidden = true;
    window.lendulet = app;
}

main().catch((error: Error) => {
    console.error(error);
    element("loading").hidden = false;
    element("loading").textContent = `The viewer cannot start: ${error.message}`;
});
