// Surfaces of the engine's shapes for drawing. Colliders whose surfaces differ by scale alone share one geometry.
import * as THREE from "three";
import { type Collider, ShapeType, type Surface } from "../engine/types";

export interface ShapeModel {
    key: string; // equal keys: equal geometry
    scale: [number, number, number];
    make: (surface: (mesh: number) => Surface) => THREE.BufferGeometry;
}

const round = 28; // segments around an axis

// A solid of revolution about y: from the bottom, arcs of the given radii at the given heights, joined by a line.
function spindle(bottom: number, top: number, halfHeight: number): THREE.BufferGeometry {
    // Where the two balls' common tangent touches them: sine of its slope.
    const slope = (bottom - top) / (2 * halfHeight);
    const points: THREE.Vector2[] = [];
    const arc = (radius: number, height: number, from: number, to: number) => {
        for (let i = 0; i <= 10; ++i) {
            const angle = from + ((to - from) * i) / 10;
            points.push(new THREE.Vector2(Math.max(radius * Math.cos(angle), 0), height + radius * Math.sin(angle)));
        }
    };
    const tangent = Math.asin(Math.min(Math.max(slope, -1), 1));
    arc(bottom, -halfHeight, -Math.PI / 2, tangent);
    arc(top, halfHeight, tangent, Math.PI / 2);
    return new THREE.LatheGeometry(points, round);
}

// A box with a sphere swept around it: a cube's surface, each point pushed from the core's nearest one.
function roundedBox(half: number[], radius: number): THREE.BufferGeometry {
    const steps = 10;
    const outer = half.slice(0, 3).map((h) => h + radius);
    const geometry = new THREE.BoxGeometry(2 * outer[0], 2 * outer[1], 2 * outer[2], steps, steps, steps);
    const position = geometry.getAttribute("position") as THREE.BufferAttribute;
    const normal = geometry.getAttribute("normal") as THREE.BufferAttribute;
    const point = new THREE.Vector3(), core = new THREE.Vector3();
    const inner = new THREE.Vector3(half[0], half[1], half[2]);
    for (let i = 0; i < position.count; ++i) {
        point.fromBufferAttribute(position, i);
        core.copy(point).clamp(inner.clone().negate(), inner);
        const out = point.sub(core);
        if (out.lengthSq() === 0) continue;
        out.normalize();
        normal.setXYZ(i, out.x, out.y, out.z);
        position.setXYZ(i, core.x + radius * out.x, core.y + radius * out.y, core.z + radius * out.z);
    }
    return geometry;
}

function facets(surface: Surface, flat: boolean): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.vertices, 3));
    geometry.setIndex(new THREE.BufferAttribute(surface.indices, 1));
    const result = flat ? geometry.toNonIndexed() : geometry;
    result.computeVertexNormals();
    return result;
}

function cylinder(c: Collider, bottom: number, top: number): THREE.BufferGeometry {
    const r = c.rounding;
    return new THREE.CylinderGeometry(top + r, bottom + r, 2 * (c.size[0] + r), round);
}

const same: [number, number, number] = [1, 1, 1];

// What is drawn of a collider; null: nothing (a plane is drawn as ground).
export function modelOf(c: Collider): ShapeModel | null {
    const [a, b, d] = c.size;
    const own = (name: string) => `${name} ${c.size.join(" ")} ${c.rounding}`;
    switch (c.type) {
        case ShapeType.sphere:
            return { key: "sphere", scale: [a, a, a], make: () => new THREE.SphereGeometry(1, 24, 16) };
        case ShapeType.capsule:
            return { key: own("capsule"), scale: same, make: () => new THREE.CapsuleGeometry(b, 2 * a, 6, 20) };
        case ShapeType.taperedCapsule:
            return { key: own("tapered capsule"), scale: same, make: () => spindle(b, d, a) };
        case ShapeType.box:
            if (c.rounding > 0)
                return { key: own("box"), scale: same, make: () => roundedBox(c.size, c.rounding) };
            return { key: "box", scale: [a, b, d], make: () => new THREE.BoxGeometry(2, 2, 2) };
        case ShapeType.cylinder:
            return { key: own("cylinder"), scale: same, make: () => cylinder(c, b, b) };
        case ShapeType.taperedCylinder:
            return { key: own("tapered cylinder"), scale: same, make: () => cylinder(c, b, d) };
        case ShapeType.cone:
            return { key: own("cone"), scale: same, make: () => cylinder(c, b, 0) };
        case ShapeType.hull:
            return { key: `hull ${c.mesh}`, scale: same, make: (surface) => facets(surface(c.mesh), true) };
        case ShapeType.mesh:
        case ShapeType.heightField:
            return { key: `mesh ${c.mesh}`, scale: same, make: (surface) => facets(surface(c.mesh), true) };
        case ShapeType.plane:
            return null;
    }
}
