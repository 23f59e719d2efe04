// The card that shows how long each broad phase takes on the world that runs.
import type { App } from "../app";
import { element, make } from "./dom";

interface Bar {
    row: HTMLElement;
    bar: HTMLElement;
    time: HTMLElement;
}

export class CompareCard {
    private readonly bars = new Map<string, Bar>();

    constructor(private readonly app: App) {
        element("compare-close").addEventListener("click", () => app.guarded(() => app.compare(false)));
        element("compare-open").addEventListener("click", () => app.guarded(() => app.compare(!app.comparison.on)));
    }
    // Called some times a second.
    show(): void {
        const { comparison } = this.app, rows = comparison.rows();
        element("compare").hidden = !comparison.on;
        element("compare-open").setAttribute("aria-pressed", String(comparison.on));
        if (!comparison.on) return;
        const most = Math.max(...rows.map((r) => r.time), 1e-6);
        const least = Math.min(...rows.map((r) => r.time));
        for (const { name, time } of rows) {
            const { row, bar, time: text } = this.bars.get(name) ?? this.add(name);
            bar.style.width = `${(100 * time) / most}%`;
            row.toggleAttribute("data-best", time === least && time > 0);
            text.textContent = `${time < 0.1 ? time.toFixed(3) : time.toFixed(2)} ms`;
        }
        const { pairs, bodies } = this.app.player.world.statistics() ?? { pairs: 0, bodies: 0 };
        const same = rows.every((r) => r.same);
        element("compare-same").textContent =
            `${pairs} pairs of boxes among ${bodies} bodies; ${same ? "all eight give the same bits" : "…"}`;
    }
    private add(name: string): Bar {
        const row = make("div", "", { class: "row" }), cell = make("div");
        const bar = make("div", "", { class: "bar" }), time = make("span", "", { class: "ms" });
        cell.append(bar);
        row.append(make("span", name, { class: "name" }), cell, time);
        element("compare-rows").append(row);
        const made = { row, bar, time };
        this.bars.set(name, made);
        return made;
    }
}
