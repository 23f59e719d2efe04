// The page's buttons, fields and keys. Each control has one action; keys do what the controls do.
import type { App } from "../app";
import { shapeNames } from "../hand";
import { type Colouring, colourings, dark, light } from "../view/theme";
import { drawings } from "../view/structure";
import { element, make } from "./dom";
import { Files } from "./files";
import { readLink } from "./permalink";

export function connect(app: App): void {
    const button = (id: string, action: () => void) =>
        element(id).addEventListener("click", () => app.guarded(action));
    const canvas = app.stage.canvas, timeline = element<HTMLInputElement>("timeline");
    const speed = element<HTMLSelectElement>("speed"), colours = element<HTMLSelectElement>("colours");
    const keys = element<HTMLDialogElement>("keys");
    // Where the pointer was last over the scene; balls and boxes go there, from buttons to the middle.
    let aim: [number, number] | null = null;
    const middle = () => app.middle;
    canvas.addEventListener("pointermove", (event) => (aim = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerleave", () => (aim = null));

    const setSpeed = (index: number) => {
        speed.selectedIndex = Math.min(Math.max(index, 0), speed.options.length - 1);
        app.player.timeScale = Number(speed.value);
    };
    const look = (index: number) => {
        app.player.look(Math.max(index, 0));
        timeline.value = String(index);
    };
    const back = () => look(Number(timeline.value) - 1);

    button("restart", () => app.restart());
    button("play", () => app.player.play(!app.player.playing));
    button("step", () => app.player.step());
    button("contacts", () => app.setContacts(!app.picture.contacts));
    button("shoot", () => app.hand.shoot(...middle()));
    button("drop", () => app.hand.drop(...middle()));
    button("fork", () => app.toggleFork());
    button("theme", () => app.toggleTheme());
    button("help", () => keys.showModal());
    timeline.addEventListener("input", () => app.guarded(() => look(Number(timeline.value))));
    speed.addEventListener("change", () => setSpeed(speed.selectedIndex));
    colours.addEventListener("change", () => app.setColours(colours.value as Colouring));
    element<HTMLInputElement>("size").addEventListener("change", (event) =>
        app.guarded(() => app.setSize(Number((event.target as HTMLInputElement).value))));
    const shape = element<HTMLSelectElement>("shape");
    shape.append(...shapeNames.map((name) => make("option", name)));
    shape.addEventListener("change", () => (app.hand.shape = shape.value));

    const actions: Record<string, () => void> = {
        " ": () => app.player.play(!app.player.playing),
        ArrowRight: () => app.player.step(),
        ArrowLeft: back,
        r: () => app.restart(),
        b: () => app.hand.shoot(...(aim ?? middle())),
        x: () => app.hand.drop(...(aim ?? middle())),
        c: () => app.setContacts(!app.picture.contacts),
        f: () => app.picture.lookAtAll(),
        k: () => app.toggleFork(),
        p: () => app.compare(!app.comparison.on),
        e: () => (location.hash = element<HTMLAnchorElement>("explain-open").hash),
        d: () => app.toggleTheme(),
        "[": () => setSpeed(speed.selectedIndex - 1),
        "]": () => setSpeed(speed.selectedIndex + 1),
        "?": () => keys.showModal(),
        Escape: () => app.pick(null),
    };
    colourings.forEach((how, i) => (actions[String(i + 1)] = () => app.setColours(how)));
    window.addEventListener("keydown", (event) => {
        const target = event.target as HTMLElement;
        const typing = target.closest("input:not([type=range]), select, dialog");
        if (app.away || typing || event.ctrlKey || event.metaKey || event.altKey) return;
        // Buttons and the timeline keep the keys that are theirs.
        if (event.key === " " && target.closest("button, a")) return;
        if (event.key.startsWith("Arrow") && target === timeline) return;
        const action = actions[event.key] ?? actions[event.key.toLowerCase()];
        if (!action) return;
        event.preventDefault();
        app.guarded(action);
    });

    drawing(app);
    const files = new Files(app), { repro } = app.sources;
    if (repro && !readLink().deeds) app.guarded(() => files.openRepro(repro.name, repro.bytes));
    sources(app);
    sheets();
    const system = matchMedia("(prefers-color-scheme: dark)");
    app.setTheme(system.matches ? dark : light);
    system.addEventListener("change", () => app.setTheme(system.matches ? dark : light));
}

// What is drawn of the engine's own structures.
function drawing(app: App): void {
    const boxes = element<HTMLSelectElement>("boxes");
    const ticks = drawings.map((what) => element<HTMLInputElement>(`show-${what}`));
    const choose = () => app.setDrawn([boxes.value, ...drawings.filter((_, i) => ticks[i].checked)]);
    for (const control of [boxes, ...ticks]) control.addEventListener("change", choose);
}

// Where scenes are computed, if there is a choice.
function sources(app: App): void {
    const where = element<HTMLSelectElement>("where"), { sources } = app;
    element("where-label").hidden = !sources.connection || !sources.engine;
    where.value = sources.native ? "native" : "page";
    where.addEventListener("change", () => {
        sources.native = where.value === "native" && sources.connection !== null;
        app.guarded(() => app.open(app.player.sceneName));
    });
}

// Panels that are sheets on narrow windows.
function sheets(): void {
    for (const id of ["scenes", "figures"]) {
        const panel = element(id), opener = element(`open-${id}`);
        const show = (open: boolean) => {
            panel.classList.toggle("open", open);
            opener.setAttribute("aria-expanded", String(open));
            if (open) panel.querySelector<HTMLElement>(".close")!.focus();
        };
        opener.addEventListener("click", () => show(!panel.classList.contains("open")));
        panel.querySelector(".close")!.addEventListener("click", () => {
            show(false);
            opener.focus();
        });
        // A chosen scene is to be seen.
        panel.addEventListener("click", (event) => {
            if ((event.target as HTMLElement).closest("a")) show(false);
        });
        element("canvas").addEventListener("pointerdown", () => show(false));
    }
}
