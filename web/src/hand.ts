// What is thrown into a scene: balls from the camera, and shapes from above.
import * as THREE from "three";
import { type Command, ShapeType, type Vec3 } from "./engine/types";
import type { Player } from "./player";
import { type Pointer, vector } from "./pointer";
import { say } from "./ui/message";
import type { Stage } from "./view/stage";

const ballSpeed = 22; // in radii of the scene a second, at most 40 m/s
const density = 300;  // kg/m³ of what is dropped

// Shapes of a size `s` (half of it, m) by name.
const shapes: Record<string, (s: number, at: Vec3) => Command> = {
    box: (s, at) => ({ do: "box", half: [s, s, s], at, velocity: [0, 0, 0], density }),
    ball: (s, at) => ({ do: "sphere", radius: s, at, velocity: [0, 0, 0], density }),
    capsule: (s, at) => shape(ShapeType.capsule, [0.8 * s, 0.6 * s], at),
    cylinder: (s, at) => shape(ShapeType.cylinder, [0.6 * s, s], at),
    cone: (s, at) => shape(ShapeType.cone, [s, s], at),
    "soft box": (s, at) => shape(ShapeType.box, [0.7 * s, 0.7 * s, 0.7 * s], at, 0.3 * s),
    pin: (s, at) => shape(ShapeType.taperedCapsule, [s, 0.7 * s, 0.35 * s], at),
    slab: (s, at) => shape(ShapeType.box, [2 * s, 0.3 * s, s], at),
};
function shape(type: ShapeType, size: number[], at: Vec3, rounding = 0): Command {
    return { do: "shape", type, size, rounding, at, velocity: [0, 0, 0], density };
}
export const shapeNames = Object.keys(shapes);

export class Hand {
    shape = "box";

    constructor(
        private readonly stage: Stage, private readonly player: Player, private readonly pointer: Pointer,
    ) {}

    // A ball from the camera towards a point of the page.
    shoot(x: number, y: number): void {
        const ray = this.stage.ray(x, y), span = this.stage.span;
        const speed = Math.min(ballSpeed * span, 40), radius = Math.min(Math.max(span / 12, 0.05), 0.9);
        const from = ray.origin.clone().addScaledVector(ray.direction, Math.min(0.35 * span, 3));
        const velocity = ray.direction.clone().multiplyScalar(speed);
        this.player.change({ do: "sphere", radius, at: vector(from), velocity: vector(velocity), density: 600 });
        if (!this.player.playing) say("The ball is there: press play to see it fly.");
    }
    // The chosen shape above what lies under a point of the page.
    drop(x: number, y: number): void {
        const span = this.stage.span, half = Math.min(Math.max(span / 16, 0.05), 0.6);
        const { camera, controls } = this.stage, above = new THREE.Vector3();
        this.player.resume();
        const hit = this.pointer.hit(x, y);
        if (hit) above.set(...hit.point);
        else this.stage.ray(x, y).at(camera.position.distanceTo(controls.target), above);
        above.y += 6 * half;
        this.player.change(shapes[this.shape](half, vector(above)));
    }
}
