// Recordings made in the page (io/recording.h), and how files are handed to the visitor.
import { Fnv } from "../engine/fnv";
import { poseStride, type Shapes, type Surface } from "../engine/types";

export function download(name: string, content: BlobPart): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([content]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

class Writer {
    private bytes = new Uint8Array(1 << 16);
    private view = new DataView(this.bytes.buffer);
    private used = 0;

    private room(count: number): number {
        if (this.used + count > this.bytes.length) {
            const wider = new Uint8Array(2 * this.bytes.length + count);
            wider.set(this.bytes.subarray(0, this.used));
            this.bytes = wider;
            this.view = new DataView(wider.buffer);
        }
        this.used += count;
        return this.used - count;
    }
    u8(v: number): void { const at = this.room(1); this.view.setUint8(at, v); }
    u32(v: number): void { const at = this.room(4); this.view.setUint32(at, v, true); }
    u64(v: bigint): void { const at = this.room(8); this.view.setBigUint64(at, v, true); }
    f32(v: number): void { const at = this.room(4); this.view.setFloat32(at, v, true); }
    f64(v: number): void { const at = this.room(8); this.view.setFloat64(at, v, true); }
    i16(v: number): void { const at = this.room(2); this.view.setInt16(at, v, true); }
    put(bytes: Uint8Array): void { const at = this.room(bytes.length); this.bytes.set(bytes, at); }
    kind(letter: string): void { this.u8(letter.charCodeAt(0)); }
    pose(poses: Float32Array, body: number): void {
        const at = poseStride * body;
        for (let k = 0; k < 3; ++k) this.f32(poses[at + k]);
        for (let k = 4; k < 8; ++k) this.i16(Math.round(32767 * Math.min(Math.max(poses[at + k], -1), 1)));
    }
    get written(): Uint8Array<ArrayBuffer> {
        return this.bytes.slice(0, this.used);
    }
}

// Records from when it is made: add() after every step, finish() at the end.
export class Recorder {
    private readonly out = new Writer();
    private bodies = 0;
    private steps = 0;
    private last = new Float32Array();
    private readonly meshes = new Map<number, number>(); // numbers in the file by those of the world

    constructor(scene: string, stepSize: number, shapes: Shapes, poses: Float32Array) {
        const name = new TextEncoder().encode(scene).slice(0, 255);
        this.out.put(new TextEncoder().encode("LENDREC\n"));
        this.out.u32(2);
        this.out.u32(name.length);
        this.out.f64(stepSize);
        this.out.put(name);
        this.announce(shapes, poses);
    }
    private announce(shapes: Shapes, poses: Float32Array): void {
        const types = new Map(shapes.colliders.map((c) => [c.body, c.bodyType]));
        for (let body = this.bodies; body < poses.length / poseStride; ++body) {
            const name = new TextEncoder().encode(shapes.name(body)).slice(0, 255);
            this.out.kind("B");
            this.out.u8(types.get(body) ?? 0);
            this.out.u8(name.length);
            this.out.put(name);
            this.out.pose(poses, body);
            for (const c of shapes.colliders.filter((c) => c.body === body)) {
                const mesh = c.mesh < 0 ? 0xffffffff : this.mesh(c.mesh, shapes.surface);
                this.out.kind("S");
                this.out.u32(body);
                this.out.u8(c.type);
                this.out.u8(+c.trigger);
                this.out.u32(mesh);
                for (const v of [...c.size, c.rounding, ...c.position, ...c.orientation]) this.out.f32(v);
            }
        }
        this.bodies = poses.length / poseStride;
        this.last = poses.slice();
    }
    private mesh(number: number, surface: (mesh: number) => Surface): number {
        const known = this.meshes.get(number);
        if (known !== undefined) return known;
        const { vertices, indices } = surface(number);
        this.out.kind("M");
        this.out.u32(vertices.length / 3);
        this.out.u32(indices.length / 3);
        vertices.forEach((v) => this.out.f32(v));
        indices.forEach((i) => this.out.u32(i));
        this.meshes.set(number, this.meshes.size);
        return this.meshes.size - 1;
    }
    add(poses: Float32Array, shapes: () => Shapes): void {
        if (poses.length > this.last.length) this.announce(shapes(), poses);
        const moved: number[] = [];
        for (let body = 0; body < this.bodies; ++body)
            for (let k = 0; k < poseStride; ++k)
                if (k !== 3 && poses[poseStride * body + k] !== this.last[poseStride * body + k]) {
                    moved.push(body);
                    break;
                }
        this.out.kind("F");
        this.out.u32(moved.length);
        for (const body of moved) {
            this.out.u32(body);
            this.out.pose(poses, body);
        }
        this.last = poses.slice();
        ++this.steps;
    }
    finish(hash: string): Uint8Array<ArrayBuffer> {
        this.out.kind("E");
        this.out.u32(this.steps);
        this.out.u32(this.bodies);
        this.out.u64(BigInt(`0x${hash || "0"}`));
        const fnv = new Fnv();
        fnv.add(this.out.written);
        this.out.u64(fnv.value);
        return this.out.written;
    }
}
