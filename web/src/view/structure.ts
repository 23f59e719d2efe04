// What the engine thinks, drawn from its own lists: boxes of the broad phase and the levels of its tree, intervals of
// sort-and-sweep, frames and limits of joints, manifolds, centres of mass, momenta, and where bodies have been.
import * as THREE from "three";
import {
    boxStride, contactStride, type JointInfo, JointType, motionStride, poseStride, type World,
} from "../engine/types";
import { Lines } from "./lines";

export type BoxView = "none" | "leaves" | "levels" | "intervals";
export const boxViews: BoxView[] = ["none", "leaves", "levels", "intervals"];
export const drawings = ["joints", "manifolds", "centres", "momenta", "trails"] as const;
export type Drawing = (typeof drawings)[number];

const trailSteps = 40, trailBodies = 1500;
const levels = [0xd6493f, 0xe08a3c, 0xd8b93f, 0x6fa84f, 0x3f9c9c, 0x4a78c2, 0x8a5fb8].map((c) => new THREE.Color(c));
const leafColour = new THREE.Color(0x8894a0), red = new THREE.Color(0xd6493f), green = new THREE.Color(0x4f9d4f);
const blue = new THREE.Color(0x3f74c9), amber = new THREE.Color(0xe0a23c), violet = new THREE.Color(0x9a5fc0);
const teal = new THREE.Color(0x2fa36b);

export class Structure {
    readonly group = new THREE.Group();
    boxes: BoxView = "none";
    joints = false;
    manifolds = false;
    centres = false;
    momenta = false;
    trails = false;
    private readonly boxLines = new Lines(5, 0.75);
    private readonly jointLines = new Lines(6);
    private readonly momentumLines = new Lines(7);
    private readonly trailLines = new Lines(1, 0.8);
    private readonly manifoldLines = new Lines(6);
    private readonly centreLines = new Lines(7);
    private past: Float32Array[] = []; // positions of the first bodies, a step each

    constructor() {
        for (const lines of [this.boxLines, this.jointLines, this.momentumLines, this.trailLines, this.manifoldLines,
            this.centreLines])
            this.group.add(lines.mesh);
    }
    get any(): boolean {
        return this.boxes !== "none" || drawings.some((what) => this[what]);
    }

    // After every step.
    remember(poses: Float32Array): void {
        if (!this.trails) return;
        const count = Math.min(poses.length / poseStride, trailBodies), kept = new Float32Array(3 * count);
        for (let i = 0; i < count; ++i) kept.set(poses.subarray(poseStride * i, poseStride * i + 3), 3 * i);
        this.past.push(kept);
        if (this.past.length > trailSteps) this.past.shift();
    }
    forget(): void {
        this.past = [];
    }

    show(world: World, span: number): void {
        this.boxLines.begin();
        if (this.boxes === "intervals") this.drawIntervals(world.boxes(), span);
        else if (this.boxes !== "none") this.drawBoxes(world.boxes());
        this.boxLines.end();
        this.jointLines.begin();
        if (this.joints) for (const joint of world.joints()) this.drawJoint(joint, span / 30);
        this.jointLines.end();
        this.manifoldLines.begin();
        if (this.manifolds) this.drawManifolds(world.contacts(), span);
        this.manifoldLines.end();
        this.centreLines.begin();
        if (this.centres) this.drawCentres(world.motions(), span / 45);
        this.centreLines.end();
        this.momentumLines.begin();
        if (this.momenta) this.drawMomenta(world.motions(), span);
        this.momentumLines.end();
        this.trailLines.begin();
        if (this.trails) this.drawTrails();
        this.trailLines.end();
    }

    private drawBoxes(list: Float32Array): void {
        const ints = new Int32Array(list.buffer, list.byteOffset, list.length);
        for (let at = 0; at < list.length; at += boxStride) {
            const leaf = ints[at + 7] !== 0, depth = ints[at + 3];
            if (leaf !== (this.boxes === "leaves")) continue;
            const size = list[at + 4] - list[at];
            if (!(size < 1e5)) continue; // planes have no end
            this.drawBox(list, at, leaf ? leafColour : levels[depth % levels.length]);
        }
    }
    private drawBox(b: Float32Array, at: number, colour: THREE.Color): void {
        const x = [b[at], b[at + 4]], y = [b[at + 1], b[at + 5]], z = [b[at + 2], b[at + 6]];
        for (let i = 0; i < 4; ++i) {
            const s = i & 1, t = i >> 1;
            this.boxLines.add(x[0], y[s], z[t], x[1], y[s], z[t], colour);
            this.boxLines.add(x[s], y[0], z[t], x[s], y[1], z[t], colour);
            this.boxLines.add(x[s], y[t], z[0], x[s], y[t], z[1], colour);
        }
    }
    // Intervals of all boxes along x, y and z, in the order in which they begin, beside the scene: pairs that overlap
    // on an axis are what sweeping along it must look at.
    private drawIntervals(list: Float32Array, span: number): void {
        const ints = new Int32Array(list.buffer, list.byteOffset, list.length), leaves: number[] = [];
        const low = [Infinity, Infinity, Infinity];
        for (let at = 0; at < list.length; at += boxStride) {
            if (ints[at + 7] === 0 || !(list[at + 4] - list[at] < 20 * span)) continue;
            leaves.push(at);
            for (let k = 0; k < 3; ++k) low[k] = Math.min(low[k], list[at + k]);
        }
        const shown = leaves.slice(0, 4000), row = Math.min(span / 40, (1.2 * span) / Math.max(shown.length, 1));
        const [x0, , z0] = low, y0 = Math.max(low[1], 0) + 0.02 * span;
        [0, 1, 2].forEach((axis) => {
            const order = [...shown].sort((a, b) => list[a + axis] - list[b + axis]);
            order.forEach((at, i) => {
                const from = list[at + axis], to = list[at + 4 + axis], off = row * (i + 1) + 0.05 * span;
                if (axis === 0) this.boxLines.add(from, y0, z0 - off, to, y0, z0 - off, red);
                else if (axis === 1) this.boxLines.add(x0 - off, from, z0, x0 - off, to, z0, green);
                else this.boxLines.add(x0 - off, y0, from, x0 - off, y0, to, blue);
            });
        });
    }

    private drawJoint(joint: JointInfo, size: number): void {
        const a = new THREE.Vector3(...joint.position), b = new THREE.Vector3(...joint.positionB);
        const turn = new THREE.Quaternion(...(joint.orientation as [number, number, number, number]));
        const axes = [red, green, blue];
        const along = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z).applyQuaternion(turn);
        const line = (p: THREE.Vector3, q: THREE.Vector3, colour: THREE.Color) =>
            this.jointLines.add(p.x, p.y, p.z, q.x, q.y, q.z, colour);
        const out = (way: THREE.Vector3, far: number) => a.clone().addScaledVector(way, far);
        axes.forEach((colour, k) => line(a, out(along(+(k === 0), +(k === 1), +(k === 2)), size), colour));
        if (a.distanceTo(b) > 1e-4) line(a, b, violet);
        const [lower, upper] = joint.limit;
        if (joint.type === JointType.hinge && lower < upper && upper - lower < 6.3) {
            const spoke = (angle: number) => out(along(0, Math.cos(angle), Math.sin(angle)), 1.6 * size);
            let before = spoke(lower);
            line(a, before, amber);
            for (let i = 1; i <= 16; ++i) {
                const next = spoke(lower + ((upper - lower) * i) / 16);
                line(before, next, amber);
                before = next;
            }
            line(a, before, amber);
        } else if (joint.type === JointType.slider && lower < upper) {
            line(out(along(1, 0, 0), lower), out(along(1, 0, 0), upper), amber);
        } else if (joint.type === JointType.ball && joint.swing < Math.PI) {
            const [cos, sin] = [Math.cos(joint.swing), Math.sin(joint.swing)];
            const rim = (angle: number) => out(along(cos, sin * Math.cos(angle), sin * Math.sin(angle)), 1.6 * size);
            for (let i = 0; i < 16; ++i) {
                line(rim((i * Math.PI) / 8), rim(((i + 1) * Math.PI) / 8), amber);
                if (i % 4 === 0) line(a, rim((i * Math.PI) / 8), amber);
            }
        }
    }

    // The outline of each manifold, and its normal from the middle.
    private drawManifolds(list: Float32Array, span: number): void {
        const ints = new Int32Array(list.buffer, list.byteOffset, list.length);
        const point = (at: number) => new THREE.Vector3(list[at], list[at + 1], list[at + 2]);
        for (let at = 0; at < list.length; ) {
            const points: THREE.Vector3[] = [], normal = point(at + 4), manifold = ints[at + 10];
            for (; at < list.length && ints[at + 10] === manifold; at += contactStride) points.push(point(at));
            const middle = new THREE.Vector3();
            for (const p of points) middle.addScaledVector(p, 1 / points.length);
            // In order around the normal.
            const first = points[0].clone().sub(middle), second = new THREE.Vector3().crossVectors(normal, first);
            const angle = (p: THREE.Vector3) => {
                const way = p.clone().sub(middle);
                return Math.atan2(way.dot(second), way.dot(first));
            };
            points.sort((a, b) => angle(a) - angle(b));
            const line = (a: THREE.Vector3, b: THREE.Vector3, colour: THREE.Color) =>
                this.manifoldLines.add(a.x, a.y, a.z, b.x, b.y, b.z, colour);
            points.forEach((p, i) => line(p, points[(i + 1) % points.length], amber));
            line(middle, middle.clone().addScaledVector(normal, span / 28), teal);
        }
    }

    // A cross at each centre of mass.
    private drawCentres(list: Float32Array, size: number): void {
        for (let at = 0; at < list.length; at += motionStride) {
            if (list[at + 3] === 0) continue;
            const [x, y, z] = list.subarray(at, at + 3);
            this.centreLines.add(x - size, y, z, x + size, y, z, red);
            this.centreLines.add(x, y - size, z, x, y + size, z, green);
            this.centreLines.add(x, y, z - size, x, y, z + size, blue);
        }
    }

    // Momentum in blue, angular momentum in violet; lengths grow with the root, the strongest are a fifth of the scene.
    private drawMomenta(list: Float32Array, span: number): void {
        let p = 0, l = 0;
        for (let at = 0; at < list.length; at += motionStride) {
            p = Math.max(p, Math.hypot(list[at + 4], list[at + 5], list[at + 6]));
            l = Math.max(l, Math.hypot(list[at + 8], list[at + 9], list[at + 10]));
        }
        const arrow = (at: number, from: number, most: number, colour: THREE.Color) => {
            const size = Math.hypot(list[from], list[from + 1], list[from + 2]);
            if (!(size > 1e-4 * most) || most === 0) return;
            const s = ((span / 5) * Math.sqrt(size / most)) / size;
            const [x, y, z] = list.subarray(at, at + 3);
            this.momentumLines.add(x, y, z, x + s * list[from], y + s * list[from + 1], z + s * list[from + 2], colour);
        };
        for (let at = 0; at < list.length; at += motionStride) {
            arrow(at, at + 4, p, blue);
            arrow(at, at + 8, l, violet);
        }
    }

    private drawTrails(): void {
        const colour = new THREE.Color();
        for (let s = 1; s < this.past.length; ++s) {
            const a = this.past[s - 1], b = this.past[s];
            colour.setRGB(0.93, 0.55, 0.25).multiplyScalar(0.25 + (0.75 * s) / this.past.length);
            for (let i = 0; i < Math.min(a.length, b.length); i += 3)
                if (a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2])
                    this.trailLines.add(a[i], a[i + 1], a[i + 2], b[i], b[i + 1], b[i + 2], colour);
        }
    }
}
