// The engine compiled to WebAssembly: its C interface (include/lendulet/lendulet_c.h) as classes. Lists are views of
// the module's memory, not copies: they hold until the next call of the engine.
import { addBody } from "./builder";
import { bodyAt, collidersAt, hashText, jointsAt, putSettings, settingsAt, statisticsAt, vectorAt } from "./decode";
import {
    type BodyState, BodyType, boxStride, type Command, contactStride, groupStride, type Hit, type JointInfo, type Kept,
    type Looks, motionStride, poseStride, Refused, type SceneInfo, type Settings, type Shapes, type Statistics,
    type Surface, type Vec3, type World,
} from "./types";
import { Module, type Started } from "./module";
import { sharedMemory, Threads } from "./threads";

export class Engine extends Module {
    readonly scenes: SceneInfo[] = [];
    readonly stages: string[] = [];
    readonly choices: string[][] = []; // broad phases, simplex solvers, integrators

    static async load(source: BufferSource): Promise<Engine> {
        return new Engine(await Module.start(source), null);
    }
    // The module with threads; new worlds get `usual` of them.
    static async loadShared(source: BufferSource, usual: number): Promise<Engine> {
        const memory = sharedMemory(), started = await Module.start(source, memory);
        return new Engine(started, new Threads(started, memory, usual));
    }

    // Arguments and results are passed through here.
    private readonly room: number;
    private static readonly roomBytes = 512;

    private constructor(started: Started, readonly threads: Threads | null) {
        super(started);
        this.room = this.call("malloc", Engine.roomBytes);
        for (let i = 0; i < this.call("lendulet_scene_count"); ++i)
            this.scenes.push({
                name: this.text(this.call("lendulet_scene_name", i)),
                description: this.text(this.call("lendulet_scene_description", i)),
                size: this.call("lendulet_scene_size", i),
            });
        for (let i = 0, at; (at = this.call("lendulet_stage_name", i)); ++i) this.stages.push(this.text(at));
        for (let kind = 0; kind < 3; ++kind) {
            this.choices.push([]);
            for (let i = 0, at; (at = this.call("lendulet_choice_name", kind, i)); ++i)
                this.choices[kind].push(this.text(at));
        }
    }

    // Calls that may be refused.
    checked(name: string, ...values: (number | bigint)[]): number {
        const result = this.call(name, ...values);
        if (result < 0) throw new Refused(this.error());
        return result;
    }
    error(): string {
        return this.text(this.call("lendulet_error"));
    }

    // Addresses of the room, `slot` blocks of 32 bytes in; what is put there holds for the next call.
    place(slot: number): number {
        return this.room + 32 * slot;
    }
    put(slot: number, values: ArrayLike<number>): number {
        new Float32Array(this.buffer, this.place(slot), values.length).set(values);
        return this.place(slot);
    }
    create(scene: string): PageWorld {
        return this.made(this.withTexts([scene], ([name]) => this.call("lendulet_create_scene", name)));
    }
    createEmpty(gravity: number): PageWorld {
        return this.made(this.call("lendulet_create_world", gravity));
    }
    private made(handle: number): PageWorld {
        if (!handle) throw new Refused(this.error());
        const world = new PageWorld(this, handle);
        if (this.threads) world.set({ workers: this.threads.usual });
        return world;
    }
}

export class PageWorld implements World {
    readonly kind = "page";
    readonly busy = false;
    readonly ahead = 0;
    arrived: (steps: number) => void = () => undefined;
    failed: (sentence: string) => void = () => undefined;
    looks?: Looks;

    constructor(readonly engine: Engine, readonly handle: number) {}
    destroy(): void {
        this.engine.call("lendulet_destroy", this.handle);
    }

    get stepSize(): number {
        return this.engine.call("lendulet_step_size", this.handle);
    }
    get time(): number {
        return this.engine.call("lendulet_time", this.handle);
    }
    get stepCount(): number {
        return Number(this.engine.call("lendulet_step_count", this.handle));
    }
    get hash(): string {
        return hashText(this.engine.call("lendulet_hash", this.handle) as unknown as bigint);
    }

    run(steps: number): void {
        for (let i = 0; i < steps; ++i) this.engine.checked("lendulet_step", this.handle);
        this.arrived(steps);
    }
    change(command: Command): void {
        this.apply(command);
        this.arrived(0);
    }
    private apply(command: Command): void {
        const e = this.engine, handle = this.handle;
        switch (command.do) {
            case "sphere":
                e.checked("lendulet_add_sphere", handle, command.radius, e.put(1, command.at),
                    e.put(2, command.velocity), command.density, 0);
                break;
            case "box":
                e.checked("lendulet_add_box", handle, e.put(1, command.half), e.put(2, command.at),
                    e.put(3, command.velocity), command.density, 0);
                break;
            case "shape":
                addBody(this, {
                    type: BodyType.dynamic, position: [...command.at], orientation: [0, 0, 0, 1],
                    velocity: [...command.velocity], angularVelocity: [0, 0, 0], mass: 0, gravityFactor: 1, name: "",
                }, [{
                    type: command.type, mesh: -1, trigger: false, size: [0, 1, 2, 3].map((k) => command.size[k] ?? 0),
                    rounding: command.rounding, position: [0, 0, 0], orientation: [0, 0, 0, 1],
                    density: command.density, friction: -1, restitution: -1,
                }]);
                break;
            case "grab":
                e.checked("lendulet_grab", handle, this.number(command.body), e.put(1, command.point));
                break;
            case "drag":
                e.call("lendulet_drag", handle, e.put(1, command.target)); // may have been let go by a restore
                break;
            case "release":
                e.call("lendulet_release", handle);
                break;
            case "set":
                this.set(command);
        }
    }
    set(changes: Partial<Settings>): void {
        const { engine: e, handle } = this, settings = { ...this.settings(), ...changes };
        putSettings(settings, e.buffer, e.place(1));
        e.checked("lendulet_set_settings", handle, e.place(1));
        e.threads?.want(settings.workers);
    }
    get threads(): number {
        return Math.min(this.engine.threads?.there ?? 1, this.settings().workers);
    }
    fork(): World {
        const handle = this.engine.call("lendulet_fork", this.handle);
        if (!handle) throw new Refused(this.engine.error());
        return new PageWorld(this.engine, handle);
    }

    keep(): Kept {
        const [size, at] = this.list("lendulet_read_snapshot");
        const data = new Uint8Array(this.engine.buffer, at, size).slice();
        return { bytes: size, data, settings: this.settings() };
    }
    go(kept: Kept): void {
        const data = kept.data!;
        this.engine.with(data, (at) => this.engine.checked("lendulet_restore", this.handle, at, data.length));
        this.arrived(0);
    }
    forget(): void {}

    // A list by its read function: how many elements there are, and where they are.
    private list(name: string): [count: number, at: number] {
        const out = this.engine.place(0);
        const count = this.engine.checked(name, this.handle, out);
        return [count, this.engine.view.getUint32(out, true)];
    }
    private floats(name: string, stride: number): Float32Array {
        const [count, at] = this.list(name);
        return new Float32Array(this.engine.buffer, at, stride * count);
    }
    private number(body: number): bigint {
        const [count, at] = this.list("lendulet_read_bodies");
        return body >= 0 && body < count ? new BigUint64Array(this.engine.buffer, at, count)[body] : 0n;
    }
    poses(): Float32Array {
        return this.floats("lendulet_read_poses", poseStride);
    }
    contacts(): Float32Array {
        return this.floats("lendulet_read_contacts", contactStride);
    }
    boxes(): Float32Array {
        return this.floats("lendulet_read_boxes", boxStride);
    }
    motions(): Float32Array {
        return this.floats("lendulet_read_motions", motionStride);
    }
    groups(): Int32Array {
        const [count, at] = this.list("lendulet_read_groups");
        return new Int32Array(this.engine.buffer, at, groupStride * count);
    }
    joints(): JointInfo[] {
        const [count, at] = this.list("lendulet_read_joints");
        return jointsAt(this.engine.buffer, at, count);
    }

    shapes(): Shapes {
        const [bodies] = this.list("lendulet_read_bodies");
        const [count, at] = this.list("lendulet_read_colliders");
        return {
            bodies, colliders: collidersAt(this.engine.buffer, at, count),
            surface: (mesh) => this.surface(mesh), name: (body) => this.body(body)?.name ?? "",
        };
    }
    // Copies: surfaces are read once.
    private surface(mesh: number): Surface {
        const out = this.engine.place(0);
        this.engine.checked("lendulet_read_mesh", this.handle, mesh, out);
        const [vertices, indices, vertexCount, triangleCount] = new Uint32Array(this.engine.buffer, out, 4);
        return {
            vertices: new Float32Array(this.engine.buffer, vertices, 3 * vertexCount).slice(),
            indices: new Uint32Array(this.engine.buffer, indices, 3 * triangleCount).slice(),
        };
    }

    body(index: number): BodyState | null {
        const out = this.engine.place(1), number = this.number(index);
        if (this.engine.call("lendulet_read_body", this.handle, number, out) < 0) return null;
        return bodyAt(this.engine.buffer, out);
    }
    statistics(): Statistics {
        const out = this.engine.place(1);
        this.engine.checked("lendulet_read_statistics", this.handle, out);
        return statisticsAt(this.engine.buffer, out);
    }
    settings(): Settings {
        const out = this.engine.place(1);
        this.engine.checked("lendulet_read_settings", this.handle, out);
        return settingsAt(this.engine.buffer, out);
    }

    castRay(origin: Vec3, translation: Vec3): Hit | null {
        const e = this.engine, out = e.place(0);
        if (!e.checked("lendulet_cast_ray", this.handle, e.put(3, origin), e.put(4, translation), out)) return null;
        const number = e.view.getBigUint64(out, true), point = vectorAt(e.buffer, out + 12);
        const [count, at] = this.list("lendulet_read_bodies");
        return { body: new BigUint64Array(e.buffer, at, count).indexOf(number), point };
    }
    // Where the grabbed point is now.
    grabbed(): Vec3 | null {
        const out = this.engine.place(1);
        const held = this.engine.call("lendulet_read_grab", this.handle, out) > 0;
        return held ? vectorAt(this.engine.buffer, out) : null;
    }
}
