// Recordings (io/recording.h) as worlds: read once from end to end and checked, with all poses kept every so many steps
// so that any moment is found quickly.
import { Fnv } from "./fnv";
import { hashText } from "./decode";
import {
    type BodyState, BodyType, type Collider, type Hit, type JointInfo, type Kept, poseStride, Refused, type Settings,
    type Shapes, ShapeType, type Statistics, type Surface, type World,
} from "./types";

const keyframeEvery = 60; // steps
const noMesh = 0xffffffff;

interface RecordedBody {
    type: BodyType;
    name: string;
    first: Float32Array; // its first pose
}

// Reads bytes in order and knows where it is when something is wrong.
class Bytes {
    at = 0;
    private readonly view: DataView;
    constructor(readonly bytes: Uint8Array) {
        this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    }
    take(count: number): number {
        if (this.at + count > this.bytes.length) throw new Refused(`The recording ends too early, at byte ${this.at}.`);
        this.at += count;
        return this.at - count;
    }
    u8 = () => this.view.getUint8(this.take(1));
    u32 = () => this.view.getUint32(this.take(4), true);
    u64 = () => this.view.getBigUint64(this.take(8), true);
    f32 = () => this.view.getFloat32(this.take(4), true);
    f64 = () => this.view.getFloat64(this.take(8), true);
    i16 = () => this.view.getInt16(this.take(2), true);
    text(length: number): string {
        const at = this.take(length);
        return new TextDecoder().decode(this.bytes.subarray(at, at + length));
    }
    refuse(what: string): never {
        throw new Refused(`The recording ${what}, at byte ${this.at}.`);
    }
    // Position and orientation into poses[8 * body ...]; the speed is left alone.
    pose(poses: Float32Array, body: number): void {
        const out = poseStride * body;
        for (let k = 0; k < 3; ++k) poses[out + k] = this.f32();
        let size = 0;
        for (let k = 0; k < 4; ++k) {
            const part = this.i16() / 32767;
            poses[out + 4 + k] = part;
            size += part * part;
        }
        const sound = Number.isFinite(poses[out] + poses[out + 1] + poses[out + 2]) && size > 0.98 && size < 1.02;
        if (!sound) this.refuse("holds a pose that cannot be");
    }
}

export function isRecording(bytes: Uint8Array): boolean {
    return new TextDecoder("latin1").decode(bytes.subarray(0, 8)) === "LENDREC\n";
}

export class RecordingWorld implements World {
    readonly kind = "recording";
    readonly busy = false;
    readonly ahead = 0;
    readonly scene: string;
    readonly stepSize: number;
    stepCount = 0;
    length = 0;
    arrived: (steps: number) => void = () => undefined;
    failed: (sentence: string) => void = () => undefined;
    private readonly file: Bytes;
    private readonly version: number;
    private readonly bodies: RecordedBody[] = [];
    private readonly colliders: Collider[] = [];
    private readonly surfaces: Surface[] = [];
    private readonly steps: { at: number; bodies: number }[] = []; // chunks of steps, and the bodies there are then
    private readonly removed: { step: number; body: number }[] = [];
    private readonly keyframes: Float32Array[] = [];
    private now = new Float32Array();
    private endHash = "";

    constructor(bytes: Uint8Array) {
        this.file = new Bytes(bytes);
        if (!isRecording(bytes)) this.file.refuse("is none");
        this.file.take(8);
        this.version = this.file.u32();
        if (this.version !== 1 && this.version !== 2) this.file.refuse(`is of version ${this.version}`);
        const length = this.file.u32();
        this.stepSize = this.file.f64();
        if (!(this.stepSize > 0 && this.stepSize <= 1) || length > 255) this.file.refuse("has a bad header");
        this.scene = this.file.text(length);
        this.scan();
        this.seek(0);
    }

    // --- reading

    // Goes through all chunks: where steps are, keyframes, and the checksum.
    private scan(): void {
        const poses: number[] = []; // grows with the bodies
        const flat = () => Float32Array.from(poses);
        for (;;) {
            const at = this.file.at, kind = String.fromCharCode(this.file.u8());
            if (kind === "B") {
                const body = this.readBody();
                poses.push(...body.first);
                this.bodies.push(body);
            } else if (kind === "S") this.readShape();
            else if (kind === "M") this.readMesh();
            else if (kind === "X") this.removed.push({ step: this.steps.length + 1, body: this.file.u32() });
            else if (kind === "F") {
                if (this.steps.length === 0) this.keyframes.push(flat());
                this.steps.push({ at: at + 1, bodies: this.bodies.length });
                const array = flat();
                this.readStep(array);
                if (this.steps.length % keyframeEvery === 0) this.keyframes.push(array.slice());
                for (let i = 0; i < array.length; ++i) poses[i] = array[i];
            } else if (kind === "E") {
                this.readEnd(at);
                break;
            } else this.file.refuse("holds a chunk of unknown kind");
        }
        if (this.keyframes.length === 0) this.keyframes.push(flat());
        this.length = this.steps.length;
        if (this.colliders.length === 0) this.standIns();
    }
    private readBody(): RecordedBody {
        const type = this.file.u8(), length = this.file.u8(), name = this.file.text(length);
        const first = new Float32Array(poseStride);
        if (type > 2) this.file.refuse("holds a body of unknown type");
        this.file.pose(first, 0);
        return { type, name, first };
    }
    private readShape(): void {
        const f = this.file, body = f.u32(), type = f.u8(), trigger = f.u8() !== 0, mesh = f.u32();
        if (body >= this.bodies.length || type > ShapeType.heightField) f.refuse("holds a shape that cannot be");
        const numbers = Array.from({ length: 12 }, () => f.f32());
        const needs = [ShapeType.hull, ShapeType.mesh, ShapeType.heightField].includes(type);
        if (needs && mesh >= this.surfaces.length) f.refuse("holds a shape of an unknown mesh");
        this.colliders.push({
            body, type, trigger, mesh: mesh === noMesh ? -1 : mesh, size: numbers.slice(0, 4), rounding: numbers[4],
            position: numbers.slice(5, 8), orientation: numbers.slice(8, 12), bodyType: this.bodies[body].type,
        });
    }
    private readMesh(): void {
        const vertexCount = this.file.u32(), triangleCount = this.file.u32();
        const at = this.file.take(12 * (vertexCount + triangleCount));
        const bytes = this.file.bytes.slice(at, this.file.at);
        const indices = new Uint32Array(bytes.buffer, 12 * vertexCount, 3 * triangleCount);
        if (indices.some((i) => i >= vertexCount)) this.file.refuse("holds a mesh with wrong indices");
        this.surfaces.push({ vertices: new Float32Array(bytes.buffer, 0, 3 * vertexCount), indices });
    }
    private readStep(poses: Float32Array): void {
        const count = this.file.u32();
        for (let i = 0; i < count; ++i) {
            const body = this.file.u32();
            if (body >= this.bodies.length) this.file.refuse("moves a body that is not there");
            this.file.pose(poses, body);
        }
    }
    private readEnd(at: number): void {
        const steps = this.file.u32(), bodies = this.file.u32();
        this.endHash = hashText(this.file.u64());
        const fnv = new Fnv();
        fnv.add(this.file.bytes.subarray(0, this.file.at));
        if (this.file.u64() !== fnv.value) this.file.refuse("does not match its checksum");
        const whole = this.file.at === this.file.bytes.length;
        if (steps !== this.steps.length || bodies !== this.bodies.length || !whole) {
            this.file.at = at;
            this.file.refuse("ends with other numbers than it holds");
        }
    }
    // Recordings of version 1 have no shapes: small boxes stand for all bodies.
    private standIns(): void {
        this.bodies.forEach(({ type }, body) => {
            this.colliders.push({
                body, type: ShapeType.box, mesh: -1, trigger: false, size: [0.25, 0.25, 0.25, 0], rounding: 0,
                position: [0, 0, 0], orientation: [0, 0, 0, 1], bodyType: type,
            });
        });
    }

    // --- time

    seek(step: number): void {
        const wanted = Math.min(Math.max(Math.round(step), 0), this.length);
        const key = Math.floor(wanted / keyframeEvery);
        // Forward from where we are, or from the keyframe before.
        const goOn = wanted >= this.stepCount && this.stepCount >= key * keyframeEvery && this.now.length > 0;
        let done = goOn ? this.stepCount : key * keyframeEvery;
        if (!goOn) this.now = this.keyframes[key].slice();
        const before = this.now.slice();
        for (; done < wanted; ++done) {
            const { at, bodies } = this.steps[done];
            this.grow(bodies);
            this.file.at = at;
            if (done === wanted - 1) before.set(this.now.subarray(0, before.length));
            this.readStep(this.now);
        }
        this.stepCount = wanted;
        this.speeds(before);
        for (const { step: at, body } of this.removed)
            if (at <= wanted) this.now.fill(0, poseStride * body, poseStride * (body + 1));
        this.arrived(0);
    }
    private grow(bodies: number): void {
        const old = this.now;
        if (old.length >= poseStride * bodies) return;
        this.now = new Float32Array(poseStride * bodies);
        this.now.set(old);
        for (let i = old.length / poseStride; i < bodies; ++i) this.now.set(this.bodies[i].first, poseStride * i);
    }
    // Of the bodies' origins: what a recording can tell.
    private speeds(before: Float32Array): void {
        for (let at = 0; at < this.now.length; at += poseStride) {
            const way = (k: number) => this.now[at + k] - (before[at + k] ?? this.now[at + k]);
            this.now[at + 3] = Math.hypot(way(0), way(1), way(2)) / this.stepSize;
        }
    }
    get time(): number {
        return this.stepCount * this.stepSize;
    }
    get hash(): string {
        return this.stepCount === this.length ? this.endHash : "";
    }
    run(steps: number): void {
        const before = this.stepCount, arrived = this.arrived;
        this.arrived = () => undefined;
        this.seek(before + steps);
        this.arrived = arrived;
        this.arrived(this.stepCount - before);
    }

    // --- what is shown

    poses(): Float32Array {
        return this.now;
    }
    shapes(): Shapes {
        const bodies = this.now.length / poseStride;
        return {
            bodies, colliders: this.colliders.filter((c) => c.body < bodies),
            surface: (mesh) => this.surfaces[mesh], name: (body) => this.bodies[body]?.name ?? "",
        };
    }
    body(index: number): BodyState | null {
        if (poseStride * index >= this.now.length) return null;
        const p = this.now.subarray(poseStride * index, poseStride * (index + 1));
        const { type, name } = this.bodies[index], at = [p[0], p[1], p[2]] as const, none = [0, 0, 0] as const;
        return {
            position: at, centreOfMass: at, velocity: none, angularVelocity: none, momentum: none,
            angularMomentum: none, mass: NaN, kineticEnergy: NaN, potentialEnergy: NaN, type, asleep: false, name,
        };
    }
    statistics(): Statistics | null {
        return null;
    }
    settings(): Settings | null {
        return null;
    }
    contacts(): Float32Array {
        return new Float32Array();
    }
    joints(): JointInfo[] {
        return [];
    }
    boxes(): Float32Array {
        return new Float32Array();
    }
    groups(): Int32Array {
        return new Int32Array();
    }
    motions(): Float32Array {
        return new Float32Array();
    }
    grabbed(): null {
        return null;
    }
    castRay(): Hit | null | undefined {
        return undefined;
    }
    change(): void {
        throw new Refused("This is a recording: it can be looked at, not changed.");
    }
    keep(): Kept {
        return { bytes: 0, key: this.stepCount, settings: null };
    }
    go(kept: Kept): void {
        this.seek(kept.key!);
    }
    forget(): void {}
    fork(): null {
        return null;
    }
    destroy(): void {}
}
