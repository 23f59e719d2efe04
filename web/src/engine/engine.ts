// The engine's C interface (include/lendulet/lendulet_c.h) as classes. Lists are views of the module's memory, not
// copies: they hold until the next call of the engine.
import { wasiImports } from "./wasi";

export type Vec3 = readonly [number, number, number];
export type BodyNumber = bigint;

export const poseStride = 8; // floats: position, speed (-1: asleep), orientation x y z w
export const contactStride = 8; // floats: position, separation, normal, normal impulse

export enum ShapeType {
    sphere, capsule, taperedCapsule, box, cylinder, taperedCylinder, cone, hull, plane, mesh, heightField,
}
export enum BodyType {
    fixed, kinematic, dynamic,
}

export interface SceneInfo {
    name: string;
    description: string;
    size: number; // default; 0: the scene has none
}

export interface Collider {
    body: number; // index into the poses
    type: ShapeType;
    mesh: number;
    trigger: boolean;
    size: number[];
    rounding: number;
    position: number[];
    orientation: number[];
}

export interface Surface {
    vertices: Float32Array;
    indices: Uint32Array;
}

export interface BodyState {
    position: Vec3;
    centreOfMass: Vec3;
    velocity: Vec3;
    angularVelocity: Vec3;
    momentum: Vec3;
    angularMomentum: Vec3;
    mass: number;
    kineticEnergy: number;
    potentialEnergy: number;
    type: BodyType;
    asleep: boolean;
    name: string;
}

export interface Statistics {
    stages: number[]; // ms
    total: number; // ms
    kineticEnergy: number;
    potentialEnergy: number;
    momentum: number[];
    bodies: number;
    awake: number;
    joints: number;
    pairs: number;
    manifolds: number;
    contacts: number;
    colours: number;
    penetration: number; // m
}

export interface Hit {
    body: BodyNumber;
    fraction: number;
    point: Vec3;
    normal: Vec3;
}

// A call that the engine refused, with its sentence.
export class Refused extends Error {}

type Call = (...values: (number | bigint)[]) => number;

export class Engine {
    readonly scenes: SceneInfo[] = [];
    readonly stages: string[] = [];

    static async load(source: BufferSource): Promise<Engine> {
        const module = await WebAssembly.compile(source);
        let instance: WebAssembly.Instance;
        const memory = () => instance.exports.memory as WebAssembly.Memory;
        instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasiImports(module, memory) });
        (instance.exports._initialize as () => void)();
        return new Engine(instance.exports);
    }

    // Arguments and results are passed through here.
    private readonly room: number;
    private static readonly roomBytes = 512;

    private constructor(private readonly exports: WebAssembly.Exports) {
        this.room = this.call("malloc", Engine.roomBytes);
        for (let i = 0; i < this.call("lendulet_scene_count"); ++i)
            this.scenes.push({
                name: this.text(this.call("lendulet_scene_name", i)),
                description: this.text(this.call("lendulet_scene_description", i)),
                size: this.call("lendulet_scene_size", i),
            });
        for (let i = 0, at; (at = this.call("lendulet_stage_name", i)); ++i) this.stages.push(this.text(at));
    }

    call(name: string, ...values: (number | bigint)[]): number {
        return (this.exports[name] as unknown as Call)(...values);
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

    get buffer(): ArrayBuffer {
        return (this.exports.memory as WebAssembly.Memory).buffer;
    }
    get view(): DataView {
        return new DataView(this.buffer);
    }
    text(at: number): string {
        const bytes = new Uint8Array(this.buffer);
        let end = at;
        while (bytes[end]) ++end;
        return new TextDecoder().decode(bytes.slice(at, end));
    }

    // Addresses of the room, `slot` blocks of 32 bytes in; what is put there holds for the next call.
    place(slot: number): number {
        return this.room + 32 * slot;
    }
    put(slot: number, values: ArrayLike<number>): number {
        new Float32Array(this.buffer, this.place(slot), values.length).set(values);
        return this.place(slot);
    }
    vector(at: number): Vec3 {
        const f = new Float32Array(this.buffer, at, 3);
        return [f[0], f[1], f[2]];
    }

    create(scene: string): World {
        const bytes = new TextEncoder().encode(scene + "\0");
        const at = this.call("malloc", bytes.length);
        new Uint8Array(this.buffer, at, bytes.length).set(bytes);
        const handle = this.call("lendulet_create_scene", at);
        this.call("free", at);
        if (!handle) throw new Refused(this.error());
        return new World(this, handle);
    }
}

export class World {
    readonly stepSize: number; // s

    constructor(private readonly engine: Engine, private readonly handle: number) {
        this.stepSize = engine.call("lendulet_step_size", handle);
    }
    destroy(): void {
        this.engine.call("lendulet_destroy", this.handle);
    }

    step(): void {
        this.engine.checked("lendulet_step", this.handle);
    }
    get time(): number {
        return this.engine.call("lendulet_time", this.handle);
    }
    get stepCount(): number {
        return Number(this.engine.call("lendulet_step_count", this.handle));
    }
    // Sixteen hexadecimal digits, as `lendulet run` prints them.
    get hash(): string {
        const hash = this.engine.call("lendulet_hash", this.handle) as unknown as bigint;
        return BigInt.asUintN(64, hash).toString(16).padStart(16, "0");
    }
    get gravity(): Vec3 {
        this.engine.checked("lendulet_read_gravity", this.handle, this.engine.place(1));
        return this.engine.vector(this.engine.place(1));
    }
    set gravity(g: Vec3) {
        this.engine.checked("lendulet_set_gravity", this.handle, this.engine.put(1, g));
    }

    // A list by its read function: how many elements there are, and where they are.
    private list(name: string): [count: number, at: number] {
        const out = this.engine.place(0);
        const count = this.engine.checked(name, this.handle, out);
        return [count, this.engine.view.getUint32(out, true)];
    }
    poses(): Float32Array {
        const [count, at] = this.list("lendulet_read_poses");
        return new Float32Array(this.engine.buffer, at, poseStride * count);
    }
    contacts(): Float32Array {
        const [count, at] = this.list("lendulet_read_contacts");
        return new Float32Array(this.engine.buffer, at, contactStride * count);
    }
    bodies(): BigUint64Array {
        const [count, at] = this.list("lendulet_read_bodies");
        return new BigUint64Array(this.engine.buffer, at, count);
    }
    snapshot(): Uint8Array {
        const [size, at] = this.list("lendulet_read_snapshot");
        return new Uint8Array(this.engine.buffer, at, size);
    }
    restore(bytes: Uint8Array): void {
        const at = this.engine.call("malloc", bytes.length);
        new Uint8Array(this.engine.buffer, at, bytes.length).set(bytes);
        try {
            this.engine.checked("lendulet_restore", this.handle, at, bytes.length);
        } finally {
            this.engine.call("free", at);
        }
    }

    colliders(): Collider[] {
        const [count, at] = this.list("lendulet_read_colliders");
        const list: Collider[] = [];
        for (let i = 0; i < count; ++i) {
            const n = new Int32Array(this.engine.buffer, at + 64 * i, 4);
            const f = new Float32Array(this.engine.buffer, at + 64 * i + 16, 12);
            list.push({
                body: n[0], type: n[1], mesh: n[2], trigger: n[3] !== 0,
                size: [f[0], f[1], f[2], f[3]], rounding: f[4],
                position: [f[5], f[6], f[7]], orientation: [f[8], f[9], f[10], f[11]],
            });
        }
        return list;
    }
    // Copies: surfaces are read once.
    surface(mesh: number): Surface {
        const out = this.engine.place(0);
        this.engine.checked("lendulet_read_mesh", this.handle, mesh, out);
        const [vertices, indices, vertexCount, triangleCount] = new Uint32Array(this.engine.buffer, out, 4);
        return {
            vertices: new Float32Array(this.engine.buffer, vertices, 3 * vertexCount).slice(),
            indices: new Uint32Array(this.engine.buffer, indices, 3 * triangleCount).slice(),
        };
    }

    body(number: BodyNumber): BodyState | null {
        const out = this.engine.place(1);
        if (this.engine.call("lendulet_read_body", this.handle, number, out) < 0) return null;
        const view = this.engine.view;
        const name = new Uint8Array(this.engine.buffer, out + 108, 64);
        return {
            position: this.engine.vector(out),
            centreOfMass: this.engine.vector(out + 28),
            velocity: this.engine.vector(out + 40),
            angularVelocity: this.engine.vector(out + 52),
            momentum: this.engine.vector(out + 64),
            angularMomentum: this.engine.vector(out + 76),
            mass: view.getFloat32(out + 88, true),
            kineticEnergy: view.getFloat32(out + 92, true),
            potentialEnergy: view.getFloat32(out + 96, true),
            type: view.getInt32(out + 100, true),
            asleep: view.getInt32(out + 104, true) !== 0,
            name: new TextDecoder().decode(name.slice(0, name.indexOf(0))),
        };
    }
    statistics(): Statistics {
        const out = this.engine.place(1);
        this.engine.checked("lendulet_read_statistics", this.handle, out);
        const d = new Float64Array(this.engine.buffer, out, 17);
        const n = new Int32Array(this.engine.buffer, out + 136, 7);
        return {
            stages: Array.from(d.subarray(0, 8)), total: d[8], kineticEnergy: d[9], potentialEnergy: d[10],
            momentum: [d[11], d[12], d[13]], bodies: n[0], awake: n[1], joints: n[2], pairs: n[3], manifolds: n[4],
            contacts: n[5], colours: n[6], penetration: this.engine.view.getFloat32(out + 164, true),
        };
    }

    addSphere(radius: number, position: Vec3, velocity: Vec3, density: number): BodyNumber {
        const e = this.engine, out = e.place(0);
        e.checked("lendulet_add_sphere", this.handle, radius, e.put(1, position), e.put(2, velocity), density, out);
        return e.view.getBigUint64(out, true);
    }
    addBox(half: Vec3, position: Vec3, velocity: Vec3, density: number): BodyNumber {
        const e = this.engine, out = e.place(0);
        const at = [e.put(1, half), e.put(2, position), e.put(3, velocity)];
        e.checked("lendulet_add_box", this.handle, ...at, density, out);
        return e.view.getBigUint64(out, true);
    }
    remove(body: BodyNumber): void {
        this.engine.checked("lendulet_remove_body", this.handle, body);
    }

    castRay(origin: Vec3, translation: Vec3): Hit | null {
        const e = this.engine, out = e.place(0);
        if (!e.checked("lendulet_cast_ray", this.handle, e.put(3, origin), e.put(4, translation), out)) return null;
        return {
            body: e.view.getBigUint64(out, true), fraction: e.view.getFloat32(out + 8, true),
            point: e.vector(out + 12), normal: e.vector(out + 24),
        };
    }
    // False where that body is none that can be moved.
    grab(body: BodyNumber, point: Vec3): boolean {
        return this.engine.call("lendulet_grab", this.handle, body, this.engine.put(1, point)) >= 0;
    }
    drag(target: Vec3): void {
        this.engine.call("lendulet_drag", this.handle, this.engine.put(1, target));
    }
    release(): void {
        this.engine.call("lendulet_release", this.handle);
    }
    // Where the grabbed point is now.
    grabbed(): Vec3 | null {
        const out = this.engine.place(1);
        return this.engine.call("lendulet_read_grab", this.handle, out) > 0 ? this.engine.vector(out) : null;
    }
}
