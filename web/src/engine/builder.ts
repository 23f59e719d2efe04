// Building in a world of the engine in the page: shapes, bodies, joints (lendulet_add_… of lendulet_c.h).
import type { PageWorld } from "./engine";
import type { BodyType, Collider, JointType } from "./types";

export interface Part extends Omit<Collider, "body" | "bodyType"> {
    density: number;
    friction: number; // negative: the world's
    restitution: number;
}
export interface BodyDefinition {
    type: BodyType;
    position: number[];
    orientation: number[];
    velocity: number[];
    angularVelocity: number[];
    mass: number; // 0: from the densities
    gravityFactor: number;
    name: string;
}
export interface JointDefinition {
    bodyA: bigint;
    bodyB: bigint;
    type: JointType;
    collide: boolean;
    a: { position: number[]; orientation: number[] };
    b: { position: number[]; orientation: number[] };
    limit: [number, number];
    swing: number;
    twist: [number, number];
    motor: [number, number];  // velocity, greatest force
    spring: [number, number]; // stiffness, damping
    target: number;
}

const partBytes = 76, bodyBytes = 136, jointBytes = 128;
const bytes = (array: Float32Array | Uint32Array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

export function addHull({ engine, handle }: PageWorld, points: Float32Array): number {
    return engine.with(bytes(points), (at) => engine.checked("lendulet_add_hull", handle, at, points.length / 3, 0));
}
export function addMesh({ engine, handle }: PageWorld, vertices: Float32Array, indices: Uint32Array): number {
    return engine.with(bytes(vertices), (v) => engine.with(bytes(indices), (i) =>
        engine.checked("lendulet_add_mesh", handle, v, vertices.length / 3, i, indices.length / 3)));
}

export function addBody({ engine, handle }: PageWorld, body: BodyDefinition, parts: Part[]): bigint {
    const definition = new Uint8Array(bodyBytes), floats = new Float32Array(definition.buffer, 0, 18);
    floats.set([...body.position, ...body.orientation, ...body.velocity, ...body.angularVelocity, body.mass]);
    floats[16] = body.gravityFactor;
    new Int32Array(definition.buffer, 68, 1)[0] = body.type;
    definition.set(new TextEncoder().encode(body.name).slice(0, 63), 72);
    const list = new Uint8Array(partBytes * parts.length);
    parts.forEach((part, i) => {
        const ints = new Int32Array(list.buffer, partBytes * i, 3);
        ints.set([part.type, part.mesh, +part.trigger]);
        new Float32Array(list.buffer, partBytes * i + 12, 15).set([
            ...part.size, part.rounding, ...part.position, ...part.orientation,
            part.density, part.friction, part.restitution,
        ]);
    });
    return engine.with(definition, (at) => engine.with(list, (first) => {
        engine.checked("lendulet_add_body", handle, at, first, parts.length, engine.place(0));
        return engine.view.getBigUint64(engine.place(0), true);
    }));
}

export function addJoint({ engine, handle }: PageWorld, joint: JointDefinition): void {
    const definition = new Uint8Array(jointBytes), view = new DataView(definition.buffer);
    view.setBigUint64(0, joint.bodyA, true);
    view.setBigUint64(8, joint.bodyB, true);
    view.setInt32(16, joint.type, true);
    view.setInt32(20, +joint.collide, true);
    new Float32Array(definition.buffer, 24, 24).set([
        ...joint.a.position, ...joint.a.orientation, ...joint.b.position, ...joint.b.orientation,
        ...joint.limit, joint.swing, ...joint.twist, ...joint.motor, ...joint.spring, joint.target,
    ]);
    engine.with(definition, (at) => engine.checked("lendulet_add_joint", handle, at));
}
