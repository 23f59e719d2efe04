// Runs a world: asks for steps at the pace of the clock, keeps the last two states for drawing between them, the past,
// and what was done by hand. A fork runs beside it, step for step.
import { type Deed, note, type Script, tidy } from "./deeds";
import { type Command, poseStride, type World } from "./engine/types";
import { History, type Moment } from "./history";

const historyBudget = 96 * 1024 * 1024; // bytes
const frameBudget = 22;                 // ms of steps in a frame; what is left over is lost: the picture slows down
const mostSteps = 4;                    // of one question to a stream

// Worlds that go along with the player's, step for step and change for change.
export interface Companions {
    run(steps: number): void;
    change(command: Command): void;
    jumped(): void; // the world is another one, or elsewhere in its past
}

export class Player {
    world!: World;
    twin: World | null = null;
    sceneName = "";
    playing = true;
    timeScale = 1;
    before = new Float32Array(); // poses of the step before
    now = new Float32Array();
    twinNow = new Float32Array();
    share = 1;       // how far the picture is between the two
    stepTime = 0;    // ms a step took, smoothed
    deeds: Deed[] = [];
    stepped: (poses: Float32Array) => void = () => undefined; // after every step
    companions: Companions | null = null;
    readonly history = new History(historyBudget, (kept) => this.world.forget(kept));
    private left = 0; // s not yet stepped
    private shown: number | null = null;
    private asked = 0; // when the last steps were asked for, ms
    private toDo: Deed[] = []; // of a repro file, in order of steps
    private end: Script["end"]; // of the same file
    private twinToDo: Deed[] = []; // what was done the first time

    // `changed`: bodies came or went, or all are those of another scene; `refused`: a sentence.
    constructor(
        private readonly changed: (otherScene: boolean) => void,
        private readonly refused: (sentence: string) => void,
    ) {}

    // The world is the player's from now on.
    install(world: World, sceneName: string, script: Script = { deeds: [] }): void {
        this.leaveTwin();
        if (this.world) this.world.destroy();
        this.world = world;
        this.sceneName = sceneName;
        this.toDo = [...script.deeds];
        this.end = script.end;
        this.deeds = [];
        this.history.clear();
        this.shown = null;
        this.left = 0;
        this.stepTime = 0;
        world.arrived = (steps) => this.arrived(steps);
        world.failed = (sentence) => {
            this.playing = false;
            this.refused(sentence);
        };
        this.now = new Float32Array();
        this.readPoses();
        this.before = this.now.slice();
        this.remember();
        this.changed(true);
        this.perform(); // what comes before the first step
        this.companions?.jumped();
    }
    // What was done and what is still to be done.
    get allDeeds(): Deed[] {
        return [...this.deeds, ...this.toDo];
    }
    // Whether the run is no longer the scene's own.
    get touched(): boolean {
        return this.deeds.length > 0;
    }

    // --- time

    // Called once a frame; `seconds`: since the last one.
    advance(seconds: number): void {
        if (!this.playing || this.shown !== null) {
            this.share = 1;
            return;
        }
        const dt = this.world.stepSize, start = performance.now();
        this.left += Math.min(seconds, 0.1) * this.timeScale;
        if (this.world.kind === "native") {
            if (this.world.busy) this.left = Math.min(this.left, mostSteps * dt);
            else if (this.left >= dt) this.ask(Math.min(Math.floor(this.left / dt), mostSteps));
        } else {
            while (this.left >= dt && this.playing) {
                this.ask(1);
                if (performance.now() - start > frameBudget) this.left = Math.min(this.left, dt * 0.999);
            }
        }
        this.share = Math.min(this.left / dt, 1);
        if (this.world.length !== undefined && this.world.stepCount >= this.world.length) this.playing = false;
    }
    // One step by hand; the clock stands.
    step(): void {
        this.resume();
        this.playing = false;
        this.left = this.world.stepSize;
        this.ask(1);
        this.share = 1;
    }
    private ask(steps: number): void {
        // Not beyond what is still to be done.
        const count = this.world.stepCount;
        for (const next of [this.toDo[0], this.twinToDo[0], this.end])
            if (next && next.step > count) steps = Math.min(steps, next.step - count);
        this.left -= steps * this.world.stepSize;
        while (this.twin && (this.twinToDo[0]?.step ?? Infinity) <= count)
            this.twin.change(this.twinToDo.shift()!.command);
        this.asked = performance.now();
        this.twin?.run(steps);
        this.companions?.run(steps);
        this.world.run(steps);
    }
    private arrived(steps: number): void {
        if (steps > 0) {
            const took = (performance.now() - this.asked) / steps;
            this.stepTime = this.stepTime === 0 ? took : 0.9 * this.stepTime + 0.1 * took;
            this.before.set(this.now);
        }
        const count = this.now.length;
        this.readPoses();
        if (steps === 0) this.before = this.now.slice();
        else {
            this.remember();
            this.stepped(this.now);
        }
        if (this.now.length !== count) this.changed(false);
        this.perform();
    }
    // What a repro file or an address has done by now.
    private perform(): void {
        while ((this.toDo[0]?.step ?? Infinity) <= this.world.stepCount) this.act(this.toDo.shift()!.command);
        if (!this.end || this.end.step > this.world.stepCount) return;
        void this.world.hash; // a stream sends it to who asks
        if (this.world.busy || this.toDo.length > 0) return;
        const { step, reached } = this.end;
        this.end = undefined;
        if (step === this.world.stepCount) reached();
    }
    private readPoses(): void {
        const poses = this.world.poses();
        if (this.now.length !== poses.length) {
            // Bodies came or went: those that are new do not move yet.
            this.now = poses.slice();
            const before = poses.slice();
            before.set(this.before.subarray(0, Math.min(this.before.length, before.length)));
            this.before = before;
        } else {
            this.now.set(poses);
        }
    }
    private remember(): void {
        const step = this.world.stepCount;
        if (this.world.length !== undefined || !this.history.wants(step)) return;
        this.history.add({ step, time: this.world.time, kept: this.world.keep(), poses: this.now.slice() });
    }

    // --- the past

    // The moment that is looked at, or null: the present. Recordings are there at once.
    get moment(): Moment | null {
        return this.shown === null ? null : this.history.moments[this.shown];
    }
    // How far the time line goes, and where we are on it.
    get timeline(): [last: number, at: number] {
        if (this.world.length !== undefined) return [this.world.length, this.world.stepCount];
        const last = Math.max(this.history.moments.length - 1, 0);
        return [last, this.shown ?? last];
    }
    // Shows a moment of the past without going there yet.
    look(index: number): void {
        this.playing = false;
        if (this.world.seek) return this.world.seek(index);
        this.shown = index >= this.history.moments.length - 1 && this.atLast() ? null : index;
    }
    private atLast(): boolean {
        return this.history.last?.step === this.world.stepCount;
    }
    // Goes to the moment that is looked at: what came after it is forgotten, and the run branches off there.
    resume(): void {
        if (this.shown === null) return;
        const moment = this.history.moments[this.shown];
        this.leaveTwin();
        this.history.cut(this.shown);
        this.shown = null;
        this.left = 0;
        this.deeds = this.deeds.filter((deed) => deed.step < moment.step);
        this.toDo = [];
        this.end = undefined;
        // Where results depended on other settings then, these come first.
        const { settings } = moment.kept;
        if (settings && JSON.stringify(settings) !== JSON.stringify(this.world.settings()))
            this.world.change({ do: "set", ...settings });
        this.world.go(moment.kept);
        this.companions?.jumped();
    }
    play(on: boolean): void {
        if (on) this.resume();
        if (on && this.world.length !== undefined && this.world.stepCount >= this.world.length) this.world.seek!(0);
        this.playing = on;
    }

    // --- changes by hand

    change(command: Command): void {
        this.resume();
        this.act(tidy(command));
    }
    private act(command: Command): void {
        const step = this.world.stepCount + this.world.ahead;
        this.world.change(command);
        note(this.deeds, { step, command });
        this.companions?.change(command);
    }

    // --- two futures

    // A second world from here on, left alone while this one is played with. From the past on, what was done by hand
    // the first time is done in it again: it is what happened, beside what may.
    fork(): void {
        const moment = this.moment, later = moment ? this.deeds.filter((deed) => deed.step >= moment.step) : [];
        this.resume();
        this.leaveTwin();
        this.twin = this.world.fork(1);
        if (!this.twin) return this.refused("A recording has but one future.");
        this.twinToDo = later;
        this.twin.failed = this.refused;
        this.twinNow = this.now.slice();
        this.twin.arrived = () => {
            if (!this.twin) return;
            const count = this.twinNow.length;
            this.twinNow = this.twin.poses().slice();
            if (this.twinNow.length !== count) this.changed(false);
        };
        this.changed(false);
    }
    leaveTwin(): void {
        if (!this.twin) return;
        this.twin.arrived = () => undefined;
        this.twin.destroy();
        this.twin = null;
        this.twinToDo = [];
        this.changed(false);
    }
    // The greatest distance between the same body in both, m.
    get apart(): number {
        let most = 0;
        for (let at = 0; at + 2 < Math.min(this.now.length, this.twinNow.length); at += poseStride) {
            const dx = this.now[at] - this.twinNow[at], dy = this.now[at + 1] - this.twinNow[at + 1];
            most = Math.max(most, dx * dx + dy * dy + (this.now[at + 2] - this.twinNow[at + 2]) ** 2);
        }
        return Math.sqrt(most);
    }

    // Poses to draw, from the past or of the present.
    get picture(): { before: Float32Array; now: Float32Array; share: number } {
        const moment = this.moment;
        if (moment) return { before: moment.poses, now: moment.poses, share: 1 };
        return { before: this.before, now: this.now, share: this.playing ? this.share : 1 };
    }
    position(index: number): [number, number, number] {
        const { now } = this.picture, at = poseStride * index;
        return [now[at], now[at + 1], now[at + 2]];
    }
}
