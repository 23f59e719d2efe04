// Runs a world: steps at the pace of the clock, keeps the last two states for drawing between them, and the past.
import { type Engine, poseStride, type World } from "./engine/engine";
import { History, type Moment } from "./history";

const historyBudget = 96 * 1024 * 1024; // bytes
const frameBudget = 22;                 // ms of steps in a frame; what is left over is lost: the picture slows down

export class Player {
    world!: World;
    sceneName = "";
    playing = true;
    timeScale = 1;
    before = new Float32Array(); // poses of the step before
    now = new Float32Array();
    share = 1;       // how far the picture is between the two
    stepTime = 0;    // ms a step took, smoothed
    touched = false; // something was changed by hand since the start: the run is no longer the scene's own
    readonly history = new History(historyBudget);
    private left = 0; // s not yet stepped
    private shown: number | null = null;

    // `changed`: bodies came or went, or all are those of another scene.
    constructor(private readonly engine: Engine, private readonly changed: (otherScene: boolean) => void) {}

    // Throws Refused, and leaves the world that there is, where the engine knows no such scene.
    open(scene: string): void {
        const world = this.engine.create(scene);
        if (this.world) this.world.destroy();
        this.world = world;
        this.sceneName = scene;
        this.begin();
    }
    restart(): void {
        this.open(this.sceneName);
    }
    private begin(): void {
        this.history.clear();
        this.shown = null;
        this.touched = false;
        this.left = 0;
        this.stepTime = 0;
        this.readPoses();
        this.before = this.now.slice();
        this.remember();
        this.changed(true);
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
        while (this.left >= dt) {
            this.left -= dt;
            this.stepOnce();
            if (performance.now() - start > frameBudget) this.left = Math.min(this.left, dt * 0.999);
        }
        this.share = this.left / dt;
    }
    // One step by hand; the clock stands.
    step(): void {
        this.resume();
        this.playing = false;
        this.stepOnce();
        this.share = 1;
    }
    private stepOnce(): void {
        const start = performance.now();
        this.world.step();
        const took = performance.now() - start;
        this.stepTime = this.stepTime === 0 ? took : 0.9 * this.stepTime + 0.1 * took;
        this.before.set(this.now);
        this.readPoses();
        this.remember();
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
        if (!this.history.wants(step)) return;
        this.history.add({
            step, time: this.world.time, snapshot: this.world.snapshot().slice(), poses: this.now.slice(),
        });
    }

    // --- the past

    // The moment that is looked at, or null: the present.
    get moment(): Moment | null {
        return this.shown === null ? null : this.history.moments[this.shown];
    }
    // Shows a moment of the past without going there yet.
    look(index: number): void {
        this.playing = false;
        this.shown = index >= this.history.moments.length - 1 && this.atLast() ? null : index;
    }
    private atLast(): boolean {
        return this.history.last?.step === this.world.stepCount;
    }
    // Goes to the moment that is looked at: what came after it is forgotten, and the run branches off there.
    resume(): void {
        if (this.shown === null) return;
        const moment = this.history.moments[this.shown];
        this.history.cut(this.shown);
        this.shown = null;
        this.left = 0;
        this.world.restore(moment.snapshot);
        const bodies = this.now.length;
        this.readPoses();
        this.before = this.now.slice();
        if (this.now.length !== bodies) this.changed(false);
    }
    play(on: boolean): void {
        if (on) this.resume();
        this.playing = on;
    }

    // --- changes by hand

    // Runs an action that changes the world.
    change<T>(action: (world: World) => T): T {
        this.resume();
        const count = this.now.length;
        const result = action(this.world);
        this.touched = true;
        this.readPoses();
        if (this.now.length !== count) this.changed(false);
        return result;
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
