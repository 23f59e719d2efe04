// Settings of the world that can be changed while it runs.
import type { Settings } from "../engine/types";
import { element, make } from "./dom";

interface Field {
    input: HTMLInputElement | HTMLSelectElement;
    read: (s: Settings) => number;
    write: (v: number) => Partial<Settings>;
}

export class Tuning {
    private readonly fields: Field[] = [];
    private shown = "";

    constructor(choices: string[][], private readonly change: (settings: Partial<Settings>) => void) {
        this.number("gravity", "m/s²", -100, 100, 0.1, (s) => -s.gravity[1], (v) => ({ gravity: [0, -v, 0] }));
        this.number("substeps", "", 1, 64, 1, (s) => s.solverSteps, (v) => ({ solverSteps: v }));
        this.number("step", "ms", 1, 100, 0.001, (s) => 1000 * s.stepSize, (v) => ({ stepSize: v / 1000 }));
        this.number("friction", "", 0, 5, 0.05, (s) => s.friction, (v) => ({ friction: v }));
        this.number("bounciness", "", 0, 1, 0.05, (s) => s.restitution, (v) => ({ restitution: v }));
        this.number("threads", "", 1, 64, 1, (s) => s.workers, (v) => ({ workers: v }));
        this.choice("broad phase", choices[0], (s) => s.broadPhase, (v) => ({ broadPhase: v }));
        this.choice("simplex", choices[1], (s) => s.simplex, (v) => ({ simplex: v }));
        this.choice("integrator", choices[2], (s) => s.integrator, (v) => ({ integrator: v }));
        this.choice("sleep", ["never", "at rest"], (s) => s.sleep, (v) => ({ sleep: v }));
        this.choice("fast bodies", ["may pass", "are stopped"], (s) => s.continuous, (v) => ({ continuous: v }));
    }

    private add(name: string, input: Field["input"], unit: string, read: Field["read"], write: Field["write"]): void {
        const label = make("label"), id = `set-${name.replace(" ", "-")}`;
        input.id = id;
        label.append(make("span", unit ? `${name}, ${unit}` : name), input);
        element("tuning").append(label);
        input.addEventListener("change", () => {
            if (input.value !== "" && Number.isFinite(Number(input.value))) this.change(write(Number(input.value)));
            this.shown = ""; // what was refused is put back
        });
        this.fields.push({ input, read, write });
    }
    private number(
        name: string, unit: string, least: number, most: number, step: number, read: Field["read"],
        write: Field["write"],
    ): void {
        const input = make("input", "", { type: "number", inputmode: "decimal" });
        Object.assign(input, { min: String(least), max: String(most), step: step === 1 ? "1" : "any" });
        this.add(name, input, unit, read, write);
    }
    private choice(name: string, names: string[], read: Field["read"], write: Field["write"]): void {
        const select = make("select");
        names.forEach((text, value) => select.append(make("option", text, { value: String(value) })));
        this.add(name, select, "", read, write);
    }

    // Null: the world has none that could be changed.
    show(settings: Settings | null): void {
        const text = JSON.stringify(settings);
        if (text === this.shown) return;
        this.shown = text;
        element("tuning-section").hidden = !settings;
        if (!settings) return;
        for (const { input, read } of this.fields)
            if (input !== document.activeElement || input instanceof HTMLSelectElement)
                input.value = String(Number(read(settings).toPrecision(5)));
    }
    // The engine in the page has threads where the page may share memory.
    offerThreads(there: boolean): void {
        const field = element<HTMLInputElement>("set-threads");
        field.disabled = !there;
        const more = globalThis.crossOriginIsolated ? "?threads=2 in the address asks for two" : "./dev view has many";
        field.title = there ? "" : `The engine in this page has one thread; ${more}.`;
    }
}
