// glTF 2.0 files with KHR_implicit_shapes and KHR_physics_rigid_bodies, put into a world of the engine in the page. A
// small reader beside the program's (io/gltf.h), which knows more and refuses more: what this one leaves out it names
// in `warnings`. Files without physics become ground of their meshes, with something falling onto it.
import * as THREE from "three";
import type { Engine, PageWorld } from "./engine";
import { addBody, addHull, addJoint, addMesh, type Part } from "./builder";
import { BodyType, JointType, Refused, ShapeType } from "./types";

type Json = Record<string, any>; // of a file: anything

// How numbers of a component type are read, and their bytes.
const kinds: Record<number, [method: string, size: number] | undefined> = {
    5121: ["getUint8", 1], 5123: ["getUint16", 2], 5125: ["getUint32", 4], 5126: ["getFloat32", 4],
};

const rigid = "KHR_physics_rigid_bodies", implicit = "KHR_implicit_shapes";

interface Node {
    json: Json;
    name: string;
    parent: number;
    world: THREE.Matrix4;
    body: number; // the node that moves it, or -1
}

class Document {
    readonly json: Json;
    private readonly buffers: Uint8Array[];

    constructor(bytes: Uint8Array) {
        let binary: Uint8Array | undefined, text = bytes;
        if (new TextDecoder("latin1").decode(bytes.subarray(0, 4)) === "glTF") {
            const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
            if (bytes.length < 20) throw new Refused("The file ends too early.");
            const length = view.getUint32(12, true), next = 20 + length;
            text = bytes.subarray(20, next);
            if (bytes.length > next + 8) binary = bytes.subarray(next + 8, next + 8 + view.getUint32(next, true));
        }
        try {
            this.json = JSON.parse(new TextDecoder().decode(text)) as Json;
        } catch {
            throw new Refused("The file is no glTF: its JSON is malformed.");
        }
        if (!String(this.json.asset?.version ?? "").startsWith("2.")) throw new Refused("The file is no glTF 2.0.");
        this.buffers = (this.json.buffers ?? []).map((buffer: Json) => {
            if (buffer.uri === undefined && binary) return binary;
            const data = /^data:[^,]*;base64,(.*)$/.exec(buffer.uri ?? "");
            if (!data) throw new Refused("Its buffers are in files beside it: a .glb file has all in one.");
            return Uint8Array.from(atob(data[1]), (c) => c.charCodeAt(0));
        });
    }
    // Numbers of an accessor, one after the other.
    numbers(index: number): Float32Array | Uint32Array {
        const accessor = this.json.accessors?.[index];
        if (!accessor || accessor.sparse) throw new Refused("A mesh of the file cannot be read (sparse or missing).");
        const parts = ({ SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 } as Json)[accessor.type] as number;
        const view = this.json.bufferViews?.[accessor.bufferView] ?? {}, buffer = this.buffers[view.buffer ?? 0];
        const kind = kinds[accessor.componentType];
        if (!kind || !parts || !buffer) throw new Refused("A mesh of the file has numbers of an unknown kind.");
        const [method, size] = kind, begin = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
        const stride = view.byteStride ?? parts * size, count = accessor.count as number;
        const out = method === "getFloat32" ? new Float32Array(count * parts) : new Uint32Array(count * parts);
        const data = new DataView(buffer.buffer, buffer.byteOffset, buffer.byteLength) as unknown as
            Record<string, (at: number, little: boolean) => number>;
        if (begin + stride * (count - 1) + parts * size > buffer.byteLength)
            throw new Refused("A mesh lies beyond its buffer.");
        for (let i = 0; i < count; ++i)
            for (let k = 0; k < parts; ++k) out[i * parts + k] = data[method](begin + stride * i + size * k, true);
        return out;
    }
    // Vertices and triangles of a mesh.
    mesh(index: number): { points: number[]; triangles: number[] } {
        const points: number[] = [], triangles: number[] = [];
        for (const primitive of this.json.meshes?.[index]?.primitives ?? []) {
            if ((primitive.mode ?? 4) !== 4 || primitive.attributes?.POSITION === undefined) continue;
            const first = points.length / 3, positions = this.numbers(primitive.attributes.POSITION);
            points.push(...positions);
            const given = primitive.indices !== undefined;
            const indices = given ? this.numbers(primitive.indices)
                : new Uint32Array(positions.length / 3).map((_, i) => i);
            indices.forEach((i) => triangles.push(first + i));
        }
        return { points, triangles };
    }
}

const plainPart: Part = {
    type: ShapeType.box, mesh: -1, trigger: false, size: [0.5, 0.5, 0.5, 0], rounding: 0, position: [0, 0, 0],
    orientation: [0, 0, 0, 1], density: 1000, friction: -1, restitution: -1,
};

export function readGltf(engine: Engine, bytes: Uint8Array<ArrayBuffer>, warnings: string[]): PageWorld {
    const world = engine.createEmpty(9.81), bodies = new Map<number, number>();
    try {
        new Reader(new Document(bytes), world, warnings).read(bodies);
        world.looks = { bytes: () => Promise.resolve(bytes), folder: "", bodies };
    } catch (error) {
        world.destroy();
        throw error;
    }
    return world;
}

class Reader {
    private readonly nodes: Node[];
    private readonly order: number[] = [];
    private readonly numbers = new Map<number, bigint>(); // of bodies, by node

    constructor(
        private readonly file: Document, private readonly world: PageWorld, private readonly warnings: string[],
    ) {
        this.nodes = (file.json.nodes ?? []).map((json: Json, i: number) => (
            { json, name: json.name ?? `node ${i}`, parent: -1, world: new THREE.Matrix4(), body: -1 }));
        const { scenes, scene } = file.json;
        for (const root of scenes?.[scene ?? 0]?.nodes ?? []) this.visit(root, -1, 0);
    }
    private visit(index: number, parent: number, depth: number): void {
        const node = this.nodes[index];
        if (!node || depth > 200 || this.order.includes(index)) throw new Refused("The tree of nodes is none.");
        const { json } = node, local = new THREE.Matrix4();
        if (json.matrix) local.fromArray(json.matrix);
        else local.compose(new THREE.Vector3(...(json.translation ?? [0, 0, 0])),
            new THREE.Quaternion(...(json.rotation ?? [0, 0, 0, 1])), new THREE.Vector3(...(json.scale ?? [1, 1, 1])));
        node.parent = parent;
        node.world = parent >= 0 ? this.nodes[parent].world.clone().multiply(local) : local;
        node.body = json.extensions?.[rigid]?.motion ? index : parent >= 0 ? this.nodes[parent].body : -1;
        this.order.push(index);
        for (const child of json.children ?? []) this.visit(child, index, depth + 1);
    }

    read(bodies: Map<number, number>): void {
        const parts = new Map<number, Part[]>(); // by the node of the body
        for (const index of this.order) {
            const node = this.nodes[index], physics = node.json.extensions?.[rigid];
            const geometry = (physics?.collider ?? physics?.trigger)?.geometry;
            if (!geometry) continue;
            const owner = node.body >= 0 ? node.body : index;
            const part = this.part(node, geometry, physics, owner);
            if (part) parts.set(owner, [...(parts.get(owner) ?? []), part]);
        }
        for (const [owner, list] of parts) this.add(owner, list);
        if (parts.size === 0) this.withoutPhysics();
        for (const index of this.order) {
            const joint = this.nodes[index].json.extensions?.[rigid]?.joint;
            if (joint) this.join(index, joint);
        }
        const owners = [...this.numbers.keys()];
        for (const index of this.order) {
            const owner = this.ownerOf(index);
            if (owner >= 0) bodies.set(index, owners.indexOf(owner));
        }
    }
    private frame(index: number): { position: THREE.Vector3; turn: THREE.Quaternion; scale: THREE.Vector3 } {
        const position = new THREE.Vector3(), turn = new THREE.Quaternion(), scale = new THREE.Vector3();
        this.nodes[index].world.decompose(position, turn, scale);
        return { position, turn, scale };
    }
    private part(node: Node, geometry: Json, physics: Json, owner: number): Part | null {
        const index = this.nodes.indexOf(node), own = this.frame(index), body = this.frame(owner);
        const back = body.turn.clone().invert();
        const { physicsMaterials } = this.file.json.extensions?.[rigid] ?? {};
        const material = physicsMaterials?.[physics.collider?.physicsMaterial] ?? {};
        const part: Part = {
            ...plainPart, trigger: physics.trigger !== undefined,
            position: own.position.clone().sub(body.position).applyQuaternion(back).toArray(),
            orientation: back.clone().multiply(own.turn).toArray(),
            friction: material.staticFriction ?? material.dynamicFriction ?? -1,
            restitution: material.restitution ?? -1,
        };
        if (geometry.shape !== undefined) return this.implicitShape(part, geometry.shape, own.scale, node.name);
        const source = geometry.node ?? index, mesh = geometry.mesh ?? this.nodes[source]?.json.mesh;
        if (mesh === undefined) return this.warn(`${node.name}: its collider has no mesh`);
        const hull = geometry.convexHull === true || node.body >= 0;
        return this.meshShape(part, mesh, own.scale, hull);
    }
    private warn(sentence: string): null {
        this.warnings.push(sentence);
        return null;
    }
    private meshShape(part: Part, mesh: number, scale: THREE.Vector3, hull: boolean): Part {
        const { points, triangles } = this.file.mesh(mesh), stretch = scale.toArray();
        const scaled = Float32Array.from(points, (v, i) => v * stretch[i % 3]);
        part.type = hull ? ShapeType.hull : ShapeType.mesh;
        if (hull) part.mesh = this.hull(scaled);
        else part.mesh = addMesh(this.world, scaled, Uint32Array.from(triangles));
        return part;
    }
    // A flat one becomes a thin slab.
    private hull(points: Float32Array): number {
        try {
            return addHull(this.world, points);
        } catch (error) {
            if (!(error instanceof Refused)) throw error;
            const at = (i: number) => new THREE.Vector3().fromArray(points, 3 * i), normal = new THREE.Vector3();
            const box = new THREE.Box3().setFromArray(points), size = box.getSize(new THREE.Vector3()).length();
            for (let i = 2; i < points.length / 3; ++i) {
                const across = at(1).sub(at(0)).cross(at(i).sub(at(0)));
                if (across.length() > normal.length()) normal.copy(across);
            }
            normal.normalize().multiplyScalar(0.005 * size);
            const shift = normal.toArray(), moved = (sign: number) => points.map((v, i) => v + sign * shift[i % 3]);
            this.warnings.push("a flat hull collides as a thin slab");
            return addHull(this.world, Float32Array.of(...moved(1), ...moved(-1)));
        }
    }
    private implicitShape(part: Part, number: number, scale: THREE.Vector3, name: string): Part | null {
        const shape = this.file.json.extensions?.[implicit]?.shapes?.[number];
        const kind = shape?.type, data = shape?.[kind] ?? {};
        const [x, y, z] = scale.toArray().map(Math.abs);
        if (kind !== "box" && Math.max(x, y, z) > 1.001 * Math.min(x, y, z))
            this.warnings.push(`${name}: stretched unevenly; it collides as if it were not`);
        const round = () => {
            const { height = 0.5, radiusBottom = 0.25, radiusTop = 0.25 } = data;
            part.size = [0.5 * y * height, x * radiusBottom, x * radiusTop, 0];
            return part.size[1] === part.size[2];
        };
        switch (kind) {
            case "box": {
                const [a, b, c] = data.size ?? [1, 1, 1];
                part.size = [0.5 * a * x, 0.5 * b * y, 0.5 * c * z, 0];
                return part;
            }
            case "sphere":
                part.type = ShapeType.sphere;
                part.size = [x * (data.radius ?? 0.5), 0, 0, 0];
                return part;
            case "capsule":
                part.type = round() ? ShapeType.capsule : ShapeType.taperedCapsule;
                return part;
            case "cylinder":
                part.type = round() ? ShapeType.cylinder
                    : part.size[2] === 0 ? ShapeType.cone : ShapeType.taperedCylinder;
                return part;
            case "plane":
                if (data.sizeX === undefined && data.sizeZ === undefined) {
                    part.type = ShapeType.plane;
                    part.size = [0, 1, 0, 0];
                } else {
                    const thin = 0.01;
                    part.size = [0.5 * x * (data.sizeX ?? 1000), thin, 0.5 * z * (data.sizeZ ?? 1000), 0];
                }
                return part;
            default:
                return this.warn(`${name}: shapes of type ${String(kind)} are not known`);
        }
    }
    private add(owner: number, parts: Part[]): void {
        const { json, name } = this.nodes[owner], motion = json.extensions?.[rigid]?.motion as Json | undefined;
        const { position, turn } = this.frame(owner);
        const turned = (v: number[] = [0, 0, 0]) => new THREE.Vector3(...v).applyQuaternion(turn).toArray();
        this.numbers.set(owner, addBody(this.world, {
            type: !motion ? BodyType.fixed : motion.isKinematic ? BodyType.kinematic : BodyType.dynamic,
            position: position.toArray(), orientation: turn.toArray(), velocity: turned(motion?.linearVelocity),
            angularVelocity: turned(motion?.angularVelocity), mass: motion?.isKinematic ? 0 : motion?.mass ?? 0,
            gravityFactor: motion?.gravityFactor ?? 1, name,
        }, parts));
    }

    // Meshes become ground, and balls fall onto it.
    private withoutPhysics(): void {
        const box = new THREE.Box3();
        for (const index of this.order) {
            const { json } = this.nodes[index];
            if (json.mesh === undefined) continue;
            const { scale } = this.frame(index), { points } = this.file.mesh(json.mesh);
            for (let i = 0; i < points.length; i += 3)
                box.expandByPoint(new THREE.Vector3().fromArray(points, i).applyMatrix4(this.nodes[index].world));
            const part = this.meshShape({ ...plainPart }, json.mesh, scale, false);
            this.add(index, [part]);
        }
        if (box.isEmpty()) throw new Refused("The file has neither physics nor meshes.");
        const size = box.getSize(new THREE.Vector3()), centre = box.getCenter(new THREE.Vector3());
        const radius = Math.max(0.03 * Math.max(size.x, size.y, size.z), 1e-3);
        for (let i = 0; i < 60; ++i)
            this.world.change({
                do: "sphere", radius, density: 1000, velocity: [0, 0, 0],
                at: [centre.x + 0.6 * size.x * (((i * 0.618) % 1) - 0.5), box.max.y + radius * (2 + 1.5 * i),
                    centre.z + 0.6 * size.z * (((i * 0.4142) % 1) - 0.5)],
            });
        this.warnings.push("without physics: its meshes are ground");
    }

    // --- joints

    private ownerOf(index: number): number {
        for (let at = index; at >= 0; at = this.nodes[at].parent) if (this.numbers.has(at)) return at;
        return -1;
    }
    private join(index: number, joint: Json): void {
        const description = this.file.json.extensions?.[rigid]?.physicsJoints?.[joint.joint];
        const other = joint.connectedNode as number, a = this.ownerOf(index), b = this.ownerOf(other);
        const { name } = this.nodes[index];
        if (!description || !this.nodes[other] || a < 0 || b < 0) return void this.warn(`${name}: a joint of nothing`);
        const linear = [false, false, false], angular: ([number, number] | null)[] = [null, null, null];
        let range: [number, number] | null = null;
        for (const limit of description.limits ?? []) {
            const pair: [number, number] = [limit.min ?? -1e30, limit.max ?? 1e30];
            for (const axis of limit.linearAxes ?? []) {
                if (pair[0] === pair[1]) linear[axis] = true;
                else range = pair;
            }
            for (const axis of limit.angularAxes ?? []) angular[axis] = pair;
        }
        const locked = angular.map((pair) => pair !== null && pair[0] === pair[1]);
        const freeTurn = locked.indexOf(false), freeWay = linear.indexOf(false);
        const turns = locked.filter((l) => !l).length;
        let type = JointType.ball, axis = 0;
        if (freeWay < 0 && turns === 0) type = JointType.rigid;
        else if (freeWay < 0 && turns === 1) [type, axis, range] = [JointType.hinge, freeTurn, angular[freeTurn]];
        else if (freeWay >= 0 && turns === 0) [type, axis] = [JointType.slider, freeWay];
        else if (freeWay >= 0) return void this.warn(`${name}: a joint of no known kind`);
        const drive = (description.drives ?? []).find((d: Json) => d.axis === axis) as Json | undefined;
        const side = (node: number, owner: number) => {
            const frame = this.frame(node), body = this.frame(owner), back = body.turn.clone().invert();
            const to = new THREE.Vector3(+(axis === 0), +(axis === 1), +(axis === 2));
            const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(1, 0, 0), to);
            return {
                position: frame.position.sub(body.position).applyQuaternion(back).toArray(),
                orientation: back.multiply(frame.turn).multiply(turn).toArray(),
            };
        };
        addJoint(this.world, {
            bodyA: this.numbers.get(a)!, bodyB: this.numbers.get(b)!, type, collide: joint.enableCollision === true,
            a: side(index, a), b: side(other, b), limit: range && range[0] < range[1] ? range : [1, -1],
            swing: type === JointType.ball && angular[1] ? angular[1][1] : 4,
            twist: type === JointType.ball && angular[0] ? angular[0] : [1, -1],
            motor: [drive?.velocityTarget ?? 0, drive?.damping && !drive.stiffness ? (drive.maxForce ?? 1e6) : 0],
            spring: [drive?.stiffness ?? 0, drive?.stiffness ? (drive.damping ?? 0) : 0],
            target: drive?.positionTarget ?? 0,
        });
    }
}
