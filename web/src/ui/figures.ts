// The figures of the last step: counts, energy, time by stage, and the hash.
import type { Player } from "../player";
import { amount, element, make, Pairs } from "./dom";

// Hashes after 120 steps as the native engine gives them, by scene; written when the page is built.
type NativeHashes = { steps: number; hashes: Record<string, string> };

export class Figures {
    private readonly numbers = new Pairs(element("numbers"));
    private readonly bars: { bar: HTMLElement; ms: HTMLElement; mean: number }[] = [];
    private native: NativeHashes | null = null;
    private frames = 0;
    private since = performance.now();
    rate = 0; // frames a second

    constructor(stages: string[], private readonly drawnBy: string) {
        for (const stage of stages) {
            const bar = make("div", "", { class: "bar" }), ms = make("span", "", { class: "ms" });
            const cell = make("div");
            cell.append(bar);
            const name = make("span", stage.replace("_", " ").replace("-", " "), { class: "name" });
            element("bars").append(name, cell, ms);
            this.bars.push({ bar, ms, mean: 0 });
        }
        if (document.querySelector('meta[name="lendulet-wasm"]')) return; // nothing is computed in this page
        fetch("native-hashes.json").then(async (answer) => {
            if (answer.ok) this.native = (await answer.json()) as NativeHashes;
        }).catch(() => undefined); // without the file nothing is compared
    }

    countFrame(): void {
        ++this.frames;
        const now = performance.now();
        if (now - this.since < 500) return;
        this.rate = (1000 * this.frames) / (now - this.since);
        this.frames = 0;
        this.since = now;
    }

    show(player: Player): void {
        const s = player.world.statistics();
        this.numbers.set("frames", `${this.rate.toFixed(0)} /s`);
        this.numbers.set("drawn", `by ${this.drawnBy}`);
        const where = { page: "in the page", native: "natively", recording: "long ago" };
        const { kind, threads = 1 } = player.world;
        this.numbers.set("computed", where[kind] + (threads > 1 ? ` by ${threads} threads` : ""));
        if (player.twin) {
            const same = player.twin.hash === player.world.hash;
            element("apart").textContent = same ? "same bits so far" : `${amount(player.apart, "m")} apart`;
        }
        this.showHash(player);
        if (!s) return;
        // Over a stream a step takes what the engine says; the way there and back is not its.
        const took = player.world.kind === "native" ? (s?.total ?? 0) : player.stepTime;
        this.numbers.set("step", `${took.toFixed(2)} ms`);
        this.numbers.set("bodies", `${s.bodies}`);
        this.numbers.set("awake", `${s.awake}`);
        this.numbers.set("contact points", `${s.contacts}`);
        this.numbers.set("box pairs", `${s.pairs}`);
        this.numbers.set("joints", `${s.joints}`);
        this.numbers.set("colours", `${s.colours}`);
        this.numbers.set("deepest overlap", `${(1000 * s.penetration).toFixed(1)} mm`);
        this.numbers.set("kinetic energy", amount(s.kineticEnergy, "J"));
        this.numbers.set("potential energy", amount(s.potentialEnergy, "J"));
        this.numbers.set("momentum", amount(Math.hypot(...s.momentum), "kg m/s"));
        this.bars.forEach((b, i) => (b.mean = 0.8 * b.mean + 0.2 * s.stages[i]));
        const most = Math.max(...this.bars.map((b) => b.mean), 1e-6);
        for (const { bar, ms, mean } of this.bars) {
            bar.style.width = `${(100 * mean) / most}%`;
            ms.textContent = mean.toFixed(2);
        }
    }

    private showHash(player: Player): void {
        element("hash").textContent = player.world.hash || "–";
        if (player.world.kind !== "page") {
            element("same").textContent = "";
            return;
        }
        const same = element("same"), step = player.world.stepCount;
        const expected = this.native?.hashes[player.sceneName];
        if (!this.native || !expected || player.touched || step < this.native.steps) same.textContent = "";
        else if (step === this.native.steps)
            same.textContent = player.world.hash === expected ? "same bits as native" : "not the native bits";
    }
}
