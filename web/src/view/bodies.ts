// All colliders as instanced meshes: one for each geometry. Poses between two steps are interpolated here.
import * as THREE from "three";
import { BodyType, type Collider, groupStride, poseStride, type Shapes, ShapeType } from "../engine/types";
import { modelOf } from "./geometry";
import { bodyMaterial, glassMaterial, wallMaterial } from "./materials";
import { type Colouring, colourOf, colourOfGroup, driven, highlight } from "./theme";

interface Batch {
    mesh: THREE.InstancedMesh;
    colliders: Collider[];
    scales: THREE.Vector3[];
    locals: (THREE.Matrix4 | null)[]; // pose on the body; null: the body's own
    reaches: number[]; // rough sizes, m; infinite: ground without end
    fixed: boolean;
}

// How colliders are drawn: what moves, what it stands on, and containers, into which one must see.
type Kind = "body" | "ground" | "glass" | "wall";

const materials = { glass: glassMaterial, wall: wallMaterial, body: bodyMaterial };

function kindOf(c: Collider, name: string, parts: number): Kind {
    const type = c.bodyType;
    if (name === "glass") return "glass";
    if (type === BodyType.kinematic) return name === "drum" && parts > 2 ? "glass" : "body";
    if (type === BodyType.dynamic) return "body";
    const wall = c.type === ShapeType.box && c.size[1] > 1.5 * Math.min(c.size[0], c.size[2]);
    return wall ? "wall" : "ground";
}
// Ground takes shadows; only what stands on it casts them.
function isSmall(c: Collider): boolean {
    const unbounded = [ShapeType.plane, ShapeType.mesh, ShapeType.heightField];
    return !unbounded.includes(c.type) && Math.max(...c.size) < 40;
}

const one = new THREE.Vector3(1, 1, 1);

export class Bodies {
    readonly group = new THREE.Group();
    hidden: ReadonlyMap<number, unknown> = new Map(); // bodies that are drawn by somebody else
    // Of what moves, and of what is drawn of the rest, at the last rebuild.
    readonly bounds = new THREE.Box3();
    private batches: Batch[] = [];
    private types: BodyType[] = [];
    private readonly geometries = new Map<string, THREE.BufferGeometry>(); // by ShapeModel.key

    constructor(private readonly groundMaterial: () => THREE.Material) {}

    // Anew from the world's colliders. `other`: of another scene, whose surfaces must be read again.
    build(shapes: Shapes, other: boolean): void {
        this.clear();
        if (other) {
            for (const geometry of this.geometries.values()) geometry.dispose();
            this.geometries.clear();
        }
        const { colliders } = shapes, batches = new Map<string, [Kind, Collider[]]>();
        const parts = new Map<number, number>(); // colliders by body
        this.types = new Array(shapes.bodies).fill(BodyType.fixed);
        for (const { body, bodyType } of colliders) {
            this.types[body] = bodyType;
            parts.set(body, (parts.get(body) ?? 0) + 1);
        }
        const names = new Map<number, string>();
        for (const body of parts.keys()) names.set(body, shapes.name(body));
        for (const c of colliders) {
            if (c.trigger) continue;
            const kind = kindOf(c, names.get(c.body)!, parts.get(c.body)!);
            const key = `${kind} ${+(c.bodyType === BodyType.fixed)} ${modelOf(c)?.key ?? "plane"}`;
            if (!batches.has(key)) batches.set(key, [kind, []]);
            batches.get(key)![1].push(c);
        }
        for (const [kind, list] of batches.values()) this.add(shapes, list, kind);
    }

    private add(shapes: Shapes, colliders: Collider[], kind: Kind): void {
        const fixed = this.types[colliders[0].body] === BodyType.fixed;
        const model = modelOf(colliders[0]);
        const key = model?.key ?? "plane";
        let geometry = this.geometries.get(key);
        if (!geometry) {
            geometry = model ? model.make(shapes.surface) : new THREE.PlaneGeometry(2e3, 2e3);
            this.geometries.set(key, geometry);
        }
        const material = kind === "ground" ? this.groundMaterial() : materials[kind]();
        const isClear = kind === "glass" || kind === "wall";
        const mesh = new THREE.InstancedMesh(geometry, material, colliders.length);
        mesh.instanceMatrix.setUsage(fixed ? THREE.StaticDrawUsage : THREE.DynamicDrawUsage);
        mesh.frustumCulled = false; // bounds change with every step
        mesh.userData.glass = isClear;
        mesh.receiveShadow = !isClear;
        mesh.castShadow = kind === "body" || (kind === "ground" && colliders.every(isSmall));
        const white = new THREE.Color(1, 1, 1);
        for (let i = 0; i < colliders.length; ++i) mesh.setColorAt(i, white);
        const locals = colliders.map((c) => {
            if (c.type === ShapeType.plane) return planeMatrix(c);
            const [x, y, z, w] = c.orientation;
            if (!c.position.some((v) => v !== 0) && w === 1) return null;
            return new THREE.Matrix4().compose(
                new THREE.Vector3(...c.position), new THREE.Quaternion(x, y, z, w), one);
        });
        const scales = colliders.map((c) => new THREE.Vector3(...(modelOf(c)?.scale ?? [1, 1, 1])));
        const reaches = colliders.map((c) => (c.type === ShapeType.plane ? Infinity : 0.9 * Math.max(...c.size)));
        this.batches.push({ mesh, colliders, scales, locals, reaches, fixed });
        this.group.add(mesh);
    }

    clear(): void {
        for (const { mesh } of this.batches) {
            this.group.remove(mesh);
            (mesh.material as THREE.Material).dispose();
            mesh.dispose();
        }
        this.batches = [];
    }

    private readonly matrix = new THREE.Matrix4();
    private readonly position = new THREE.Vector3();
    private readonly rotation = new THREE.Quaternion();
    private readonly colour = new THREE.Color();

    // `share` of the way from `before` to `now`; bodies that are in only one of them are drawn where they are in `now`,
    // or not at all. `all`: static bodies too.
    place(before: Float32Array, now: Float32Array, share: number, all: boolean): void {
        const there = now.length / poseStride, both = Math.min(there, before.length / poseStride);
        for (const batch of this.batches) {
            if (batch.fixed && !all) continue;
            const array = batch.mesh.instanceMatrix.array as Float32Array;
            for (let i = 0; i < batch.colliders.length; ++i) {
                const body = batch.colliders[i].body;
                // Not there yet, or no more: recordings say so by a rotation of nothing.
                if (body >= there || this.hidden.has(body) || isGone(now, poseStride * body + 4)) {
                    array.fill(0, 16 * i, 16 * i + 16);
                    continue;
                }
                this.blend(body < both ? before : now, now, poseStride * body, share);
                this.matrix.compose(this.position, this.rotation, batch.locals[i] ? one : batch.scales[i]);
                const local = batch.locals[i];
                if (local) this.matrix.multiply(local).scale(batch.scales[i]);
                this.matrix.toArray(array, 16 * i);
            }
            batch.mesh.instanceMatrix.needsUpdate = true;
        }
    }

    // Where a body is drawn.
    pose(before: Float32Array, now: Float32Array, body: number, share: number): THREE.Matrix4 {
        const at = poseStride * body;
        this.blend(at < before.length ? before : now, now, at, share);
        return this.matrix.compose(this.position, this.rotation, one);
    }

    // Quaternions by their normalised mean: within a step bodies turn little.
    private blend(a: Float32Array, b: Float32Array, at: number, t: number): void {
        const s = 1 - t;
        this.position.set(
            s * a[at] + t * b[at], s * a[at + 1] + t * b[at + 1], s * a[at + 2] + t * b[at + 2]);
        const q = at + 4;
        const dot = a[q] * b[q] + a[q + 1] * b[q + 1] + a[q + 2] * b[q + 2] + a[q + 3] * b[q + 3];
        const u = dot < 0 ? -s : s;
        this.rotation.set(
            u * a[q] + t * b[q], u * a[q + 1] + t * b[q + 1], u * a[q + 2] + t * b[q + 2],
            u * a[q + 3] + t * b[q + 3]);
        this.rotation.normalize();
    }

    // `groups`: islands and colours of contacts, where they are asked for.
    paint(how: Colouring, poses: Float32Array, groups: Int32Array, selected: number, ground: number): void {
        for (const { mesh, colliders, fixed } of this.batches) {
            const array = mesh.instanceColor!.array as Float32Array;
            for (let i = 0; i < colliders.length; ++i) {
                const body = colliders[i].body;
                if (fixed) this.colour.setHex(ground);
                else if (this.types[body] === BodyType.kinematic) this.colour.copy(driven);
                else if (how === "island") colourOfGroup(this.colour, groups[groupStride * body] ?? -1);
                else if (how === "colour") colourOfGroup(this.colour, groups[groupStride * body + 1] ?? -1);
                else colourOf(this.colour, how, body, poses[poseStride * body + 3] ?? 0);
                if (body === selected) highlight(this.colour);
                this.colour.toArray(array, 3 * i);
            }
            mesh.instanceColor!.needsUpdate = true;
        }
    }

    // The body that a ray meets first in the picture, static ones too: for worlds that cannot be asked.
    hit(ray: THREE.Ray): { body: number; point: THREE.Vector3 } | null {
        const caster = new THREE.Raycaster(ray.origin, ray.direction);
        let best: { body: number; point: THREE.Vector3 } | null = null, nearest = Infinity;
        for (const { mesh, colliders } of this.batches) {
            mesh.computeBoundingSphere(); // it moves, and three.js keeps the first one
            for (const { distance, instanceId, point } of caster.intersectObject(mesh)) {
                if (distance >= nearest || instanceId === undefined) continue;
                nearest = distance;
                best = { body: colliders[instanceId].body, point };
            }
        }
        return best;
    }
    isDynamic(body: number): boolean {
        return this.types[body] === BodyType.dynamic;
    }
    typeOf(body: number): BodyType {
        return this.types[body];
    }

    // Bounds of what moves; of everything where nothing does. Shapes without end are left out.
    measure(poses: Float32Array): THREE.Box3 {
        const { min, max } = this.bounds.makeEmpty();
        for (const movingOnly of [true, false]) {
            for (const { colliders, reaches, fixed } of this.batches) {
                if (movingOnly && fixed) continue;
                for (let i = 0; i < colliders.length; ++i) {
                    const c = colliders[i], at = poseStride * c.body, reach = reaches[i];
                    if (at >= poses.length || !Number.isFinite(reach)) continue;
                    // Colliders on moving bodies are near enough to their bodies' origins.
                    const x = poses[at] + (fixed ? c.position[0] : 0), y = poses[at + 1] + (fixed ? c.position[1] : 0);
                    const z = poses[at + 2] + (fixed ? c.position[2] : 0);
                    min.set(Math.min(min.x, x - reach), Math.min(min.y, y - reach), Math.min(min.z, z - reach));
                    max.set(Math.max(max.x, x + reach), Math.max(max.y, y + reach), Math.max(max.z, z + reach));
                }
            }
            if (!this.bounds.isEmpty()) break;
        }
        return this.bounds;
    }
}

function isGone(poses: Float32Array, q: number): boolean {
    return poses[q + 3] === 0 && poses[q] === 0 && poses[q + 1] === 0 && poses[q + 2] === 0;
}

// A square of the plane around the point that is nearest to the body's origin.
function planeMatrix(c: Collider): THREE.Matrix4 {
    const normal = new THREE.Vector3(c.size[0], c.size[1], c.size[2]);
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    return new THREE.Matrix4().compose(normal.clone().multiplyScalar(c.size[3]), turn, one);
}
