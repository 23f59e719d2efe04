// The way into explain mode and back: the entry over the list of scenes, the key E, the address.
import type { App } from "../app";
import { isAddress } from "../explain/address";
import { ExplainMode } from "../explain/mode";
import { element } from "./dom";

// `address`: the one that the page was opened with.
export function connectExplain(app: App, shadows: number, address: string): void {
    const entry = element("explain-open"), { explain } = app.sources;
    entry.hidden = !explain;
    if (!explain) return;
    let mode: ExplainMode | null = null, played = false;
    const closed = () => {
        app.away = false;
        app.player.playing = played;
        app.setTheme(mode!.themeNow);
    };
    const open = (hash: string) => {
        if (!mode?.isOpen) {
            played = app.player.playing;
            app.player.playing = false;
            app.away = true;
        }
        mode ??= window.lenduletExplain = new ExplainMode(explain, shadows, closed);
        mode.open(app.picture.theme, hash);
    };
    window.addEventListener("hashchange", ({ newURL }) => {
        const { hash } = new URL(newURL); // the address may be another one by now: the scene writes its own into it
        if (isAddress(hash)) open(hash);
        else if (mode?.isOpen) mode.close();
    });
    element("list").addEventListener("click", (event) => {
        if (mode?.isOpen && (event.target as HTMLElement).closest("a")) mode.close();
    });
    if (isAddress(address)) open(address);
}
