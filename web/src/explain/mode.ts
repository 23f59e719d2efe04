// Explain mode: two shapes in the hand on one side, and on the other what the engine does to find how they meet, step
// by step. The address has it all (address.ts).
import * as THREE from "three";
import { Refused } from "../engine/types";
import { element } from "../ui/dom";
import { dark, light, type Theme } from "../view/theme";
import { commandOf, readAddress, writeAddress } from "./address";
import { Hand, type Way } from "./hand";
import { pairs } from "./pairs";
import { Choice, ShapeFields } from "./panel";
import type { Explain, Question, Sequence } from "./sequence";
import { HeldShape } from "./shapes";
import { ground } from "./ground";
import { firstOrbit, View } from "./view";

const stepTime = 1100; // ms a step is shown while they play

export class ExplainMode {
    readonly shapes = [new HeldShape(), new HeldShape()];
    readonly left: View;
    readonly right: View;
    sequence: Sequence | null = null;
    what = "distance";
    step = 1; // of the sequence; 0 shows the shapes, which are always there
    playing = false;
    isOpen = false;
    private simplex = "half-space";
    private chosen = 1;
    private pair = 0;
    private theme: Theme = light;
    private readonly hand: Hand;
    private readonly fields: ShapeFields[];
    private readonly whats: Choice;
    private readonly ways: Choice;
    private readonly floor = ground();
    private asking = false;
    private stale = false;  // the shapes are others than those of the sequence
    private fresh = false;  // something is to be drawn anew
    private aimed: "not" | "softly" | "at once" = "at once"; // the cameras
    private leader: View;
    private stepped = 0; // when a step was shown first, ms

    constructor(private readonly explain: Explain, shadows: number, private readonly closed: () => void) {
        this.left = new View(element<HTMLCanvasElement>("explain-shapes"), shadows, true);
        this.right = new View(element<HTMLCanvasElement>("explain-steps"), shadows && 1024, false);
        this.left.stage.scene.add(this.floor);
        this.leader = this.left;
        for (const view of [this.left, this.right]) {
            view.stage.controls.addEventListener("start", () => (this.leader = view));
            view.turn(firstOrbit());
            new ResizeObserver(() => this.aim("at once")).observe(view.canvas);
        }
        this.hand = new Hand(this.left, this.shapes, (ray) => this.pick(ray), (shape) => (this.chosen = shape),
            (done) => this.changed(done));
        this.fields = ["A", "B"].map((letter, i) => new ShapeFields(letter, this.shapes[i], () => this.changed(true)));
        this.whats = new Choice(element("explain-what"), (what) => this.choose(what));
        this.ways = new Choice(element("explain-way"), (way) => (this.hand.way = way as Way));
        this.ways.show("move");
        this.connect();
    }

    // --- coming and going

    // With what the address asks for, as far as it makes sense.
    open(theme: Theme, hash: string): void {
        this.read(hash);
        if (this.isOpen) return;
        this.isOpen = true;
        this.cover(true);
        this.setTheme(theme);
        const frame = () => {
            if (!this.isOpen) return;
            requestAnimationFrame(frame);
            this.frame();
        };
        requestAnimationFrame(frame);
    }
    private read(hash: string): void {
        const [what, a, b] = pairs[this.pair], asked = readAddress(hash), { shapes } = this;
        this.what = asked.what ?? what;
        this.simplex = asked.simplex;
        if (!shapes[0].read(asked.a ?? "")) shapes[0].read(a);
        if (!shapes[1].read(asked.b ?? "")) shapes[1].read(b);
        this.step = asked.step ?? 1;
        this.playing = asked.step === undefined && !matchMedia("(prefers-reduced-motion: reduce)").matches;
        this.start();
    }
    private start(): void {
        this.whats.show(this.what);
        for (const fields of this.fields) fields.follow();
        this.stepped = performance.now();
        this.aim("at once");
        this.stale = true;
    }
    close(): void {
        this.isOpen = false;
        this.cover(false);
        this.closed();
    }
    // What lies beneath cannot be reached by keys while the mode is open.
    private cover(on: boolean): void {
        element("explain").hidden = !on;
        document.body.toggleAttribute("data-explain", on);
        for (const beneath of ["view", "figures", "transport"]) element(beneath).inert = on;
        if (on) element("explain-open").setAttribute("aria-current", "true");
        else element("explain-open").removeAttribute("aria-current");
    }
    setTheme(theme: Theme): void {
        this.theme = theme;
        document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
        for (const view of [this.left, this.right]) view.apply(theme);
        this.floor.setColorAt(0, new THREE.Color(theme.ground));
        this.floor.instanceColor!.needsUpdate = true;
        this.fresh = true;
    }
    get themeNow(): Theme {
        return this.theme;
    }

    // --- what is done

    choose(what: string): void {
        this.what = what;
        this.step = 1;
        this.start();
    }
    nextPair(): void {
        this.pair = (this.pair + 1) % pairs.length;
        const [what, a, b] = pairs[this.pair];
        this.shapes[0].read(a);
        this.shapes[1].read(b);
        this.choose(what);
    }
    go(step: number): void {
        this.playing = false;
        this.show(step);
    }
    private show(step: number): void {
        const last = this.lastStep;
        this.step = Math.min(Math.max(step, Math.min(1, last)), Math.max(last, 1));
        this.stepped = performance.now();
        this.fresh = true;
    }
    play(on: boolean): void {
        this.playing = on;
        if (on && this.step >= this.lastStep) this.step = 0;
        this.stepped = on ? 0 : performance.now();
        this.fresh = true;
    }
    private changed(done: boolean): void {
        this.stale = true;
        this.playing = false;
        if (done) this.aim("softly");
    }
    private aim(how: "softly" | "at once"): void {
        if (this.aimed !== "at once") this.aimed = how;
        this.fresh = true;
    }
    private pick(ray: THREE.Ray): { shape: number; point: THREE.Vector3 } | null {
        const caster = new THREE.Raycaster(ray.origin, ray.direction), { meshes } = this.left.drawing;
        const [first] = caster.intersectObjects([...meshes.values()]);
        if (!first || !this.sequence) return null;
        return { shape: meshes.get(this.sequence.solids[0]) === first.object ? 0 : 1, point: first.point };
    }
    private get question(): Question {
        const [a, b] = this.shapes.map((shape) => shape.text);
        return { what: this.what, simplex: this.simplex, a, b };
    }
    private get lastStep(): number {
        return (this.sequence?.steps.length ?? 1) - 1;
    }

    // --- frames

    private frame(): void {
        if (this.stale && !this.asking) void this.ask();
        if (this.playing && this.lastStep > 0 && performance.now() - this.stepped > stepTime) {
            if (this.step < this.lastStep) this.show(this.step + 1);
            else this.playing = false, this.fresh = true;
        }
        if (this.fresh && this.sequence) this.draw();
        const views = [this.left, this.right];
        let moved = false;
        for (const view of views) moved = view.stage.update() || moved;
        const orbit = this.leader.looked;
        for (const view of views) moved = view.ease() || moved;
        if (!moved && !this.fresh) return;
        this.fresh = false;
        for (const view of views) {
            view.turn(orbit);
            view.render();
        }
    }
    private async ask(): Promise<void> {
        this.asking = true;
        this.stale = false;
        const atEnd = this.step >= this.lastStep && this.lastStep > 0;
        const { question } = this;
        try {
            this.sequence = await this.explain(question);
            this.say("");
        } catch (error) {
            this.say((error as Error).message);
            if (!(error instanceof Refused)) return console.error(error);
            // The shapes are shown all the same, where they are shapes.
            this.sequence = await this.explain({ ...question, what: "distance" }).then(
                (shown) => ({ ...shown, steps: shown.steps.slice(0, 1) }), () => this.sequence);
        } finally {
            this.asking = false;
        }
        if (!this.stale && this.playing === false && atEnd && this.step > 1) this.step = this.lastStep;
        this.step = Math.min(this.step, Math.max(this.lastStep, 1));
        this.fresh = true;
    }
    private say(sentence: string): void {
        const box = element("explain-refused");
        box.hidden = sentence === "";
        box.textContent = sentence.replace(/^explain \w+: (.)/, (_, first: string) => first.toUpperCase());
    }

    private draw(): void {
        const { steps, solids } = this.sequence!, step = steps[this.step], place = this.shapes[0].matrix;
        if (this.aimed !== "not") this.aimNow(place);
        this.left.show(steps[0], this.theme.dark, place);
        this.left.stage.light(new THREE.Box3().setFromObject(this.left.drawing.group));
        // The difference is a set of ways: it turns with A and stays where O is.
        const turn = new THREE.Matrix4().makeRotationFromQuaternion(this.shapes[0].turn);
        this.right.show(step ?? { title: "", note: "", marks: [] }, this.theme.dark, turn);
        this.right.stage.light(new THREE.Box3().setFromObject(this.right.drawing.group));
        this.describe();
        element("explain").dataset.solids = String(solids.length);
        if (!this.hand.busy) writeAddress(this.question, this.step);
    }
    private aimNow(place: THREE.Matrix4): void {
        const { solids, steps } = this.sequence!, atOnce = this.aimed === "at once";
        const boxOf = (lists: Float32Array[], matrix: THREE.Matrix4) => {
            const box = new THREE.Box3(), point = new THREE.Vector3();
            for (const list of lists)
                for (let i = 0; i < list.length; i += 3)
                    box.expandByPoint(point.fromArray(list, i).applyMatrix4(matrix));
            return box;
        };
        const shapes = boxOf([solids[0].points, solids[1].points], place);
        const turn = new THREE.Matrix4().makeRotationFromQuaternion(this.shapes[0].turn);
        const seen = steps.slice(1).flatMap(({ marks }) => marks.map((mark) => mark.solid?.points ?? mark.points));
        this.left.stage.update();
        this.right.stage.update();
        this.left.aim(shapes, atOnce);
        if (seen.length > 0) this.right.aim(boxOf([...new Set(seen)], turn), atOnce);
        const height = shapes.min.y - 0.12 * this.left.span;
        this.floor.position.y = height;
        this.floor.updateMatrixWorld();
        this.aimed = "not";
    }

    // --- words

    private describe(): void {
        const { steps } = this.sequence!, step = steps[this.step], last = this.lastStep;
        element("explain-distance").textContent = steps[0].note;
        element("explain-title").textContent = step?.title ?? "";
        element("explain-note").textContent = step?.note ?? "";
        const line = element<HTMLInputElement>("explain-line");
        line.max = String(Math.max(last, 1));
        line.value = String(this.step);
        line.disabled = last < 1;
        element("explain-count").textContent = last < 1 ? "–" : `${this.step} of ${last}`;
        const play = element("explain-play");
        element("explain").toggleAttribute("data-playing", this.playing);
        play.setAttribute("aria-label", this.playing ? "Pause (space)" : "Play the steps (space)");
        element("explain-words").textContent = commandOf(this.question);
    }
    private connect(): void {
        const on = (id: string, action: () => void) => element(id).addEventListener("click", action);
        on("explain-close", () => this.close());
        on("explain-next", () => this.go(this.step + 1));
        on("explain-back", () => this.go(this.step - 1));
        on("explain-play", () => this.play(!this.playing));
        on("explain-pair", () => this.nextPair());
        on("explain-theme", () => this.setTheme(this.theme.dark ? light : dark));
        const line = element<HTMLInputElement>("explain-line");
        line.addEventListener("input", () => this.go(Number(line.value)));
        const simplex = element<HTMLSelectElement>("explain-simplex");
        simplex.addEventListener("change", () => {
            this.simplex = simplex.value;
            this.stale = true;
        });
        window.addEventListener("keydown", (event) => this.key(event));
    }
    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement;
        const typing = target.closest("input:not([type=range]), select, dialog");
        if (!this.isOpen || typing || event.ctrlKey || event.metaKey || event.altKey) return;
        if (event.key === " " && target.closest("button, a")) return;
        const hand = target === this.left.canvas;
        if (event.key.startsWith("Arrow") && target === element("explain-line")) return;
        const nudge = (x: number, y: number, z: number) => this.hand.nudge(this.chosen, x, y, z);
        const shapeKeys: Record<string, () => void> = {
            ArrowLeft: () => nudge(-1, 0, 0), ArrowRight: () => nudge(1, 0, 0), ArrowUp: () => nudge(0, 1, 0),
            ArrowDown: () => nudge(0, -1, 0), PageUp: () => nudge(0, 0, -1), PageDown: () => nudge(0, 0, 1),
        };
        const keys: Record<string, () => void> = {
            " ": () => this.play(!this.playing), ArrowLeft: () => this.go(this.step - 1),
            ArrowRight: () => this.go(this.step + 1), ",": () => this.go(this.step - 1),
            ".": () => this.go(this.step + 1), a: () => (this.chosen = 0), b: () => (this.chosen = 1),
            t: () => this.ways.show((this.hand.way = this.hand.way === "move" ? "turn" : "move")),
            n: () => this.nextPair(), f: () => this.aim("softly"), Escape: () => this.close(),
            d: () => this.setTheme(this.theme.dark ? light : dark),
        };
        const action = (hand ? shapeKeys[event.key] : undefined) ?? keys[event.key] ?? keys[event.key.toLowerCase()];
        if (!action) return;
        event.preventDefault();
        action();
    }
}
