// The pointer on the scene: a click picks a body, a drag from a dynamic one pulls it, a drag from elsewhere turns the
// camera. Lets go in motion throw the body.
import * as THREE from "three";
import { type BodyNumber, BodyType, type Vec3 } from "./engine/engine";
import type { Player } from "./player";
import { GripLine } from "./view/marks";
import type { Stage } from "./view/stage";

const clickReach = 6; // pixels; a pointer that moves farther drags

export const vector = (v: THREE.Vector3): Vec3 => [v.x, v.y, v.z];

export class Pointer {
    readonly grip = new GripLine();
    private held: number | null = null; // pointer id
    private readonly target = new THREE.Vector3();
    private readonly plane = new THREE.Plane();
    private down: { x: number; y: number; body: BodyNumber | null } | null = null;

    constructor(
        private readonly stage: Stage,
        private readonly player: Player,
        private readonly pick: (body: BodyNumber | null) => void,
    ) {
        const canvas = stage.canvas;
        stage.scene.add(this.grip.line);
        // Before the camera's own listeners, so that a drag of a body does not turn the camera.
        canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", (event) => this.lift(event));
        canvas.addEventListener("pointercancel", () => this.release());
    }

    // What the ray through a point of the page meets in the present.
    hit(x: number, y: number): { body: BodyNumber; point: Vec3 } | null {
        const ray = this.stage.ray(x, y);
        const far = ray.direction.clone().multiplyScalar(this.stage.far);
        return this.player.world.castRay(vector(ray.origin), vector(far));
    }

    private press(event: PointerEvent): void {
        if (event.button !== 0 || this.held !== null || !event.isPrimary) return;
        const hit = this.player.moment ? null : this.hit(event.clientX, event.clientY);
        this.down = { x: event.clientX, y: event.clientY, body: hit?.body ?? null };
        if (!hit || this.player.world.body(hit.body)?.type !== BodyType.dynamic) return;
        event.stopImmediatePropagation();
        this.stage.canvas.setPointerCapture(event.pointerId);
        this.held = event.pointerId;
        this.target.set(...hit.point);
        const facing = this.stage.camera.getWorldDirection(new THREE.Vector3());
        this.plane.setFromNormalAndCoplanarPoint(facing, this.target);
    }
    private move(event: PointerEvent): void {
        if (event.pointerId !== this.held || !this.down) return;
        const far = Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y) > clickReach;
        if (!this.grabbing) {
            if (!far || this.down.body === null) return;
            const body = this.down.body, point = vector(this.target);
            this.grabbing = this.player.change((world) => world.grab(body, point));
            if (!this.grabbing) return;
            this.stage.canvas.classList.add("grabbing");
            this.pick(body);
        }
        const ray = this.stage.ray(event.clientX, event.clientY);
        if (ray.intersectPlane(this.plane, this.target)) this.player.world.drag(vector(this.target));
    }
    private grabbing = false;
    // Whether the line of the grip is drawn, or was a moment ago.
    get active(): boolean {
        return this.grabbing || this.grip.line.visible;
    }
    private lift(event: PointerEvent): void {
        const still = this.down && Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y) <= clickReach;
        if (still && !this.grabbing && event.button === 0 && !this.player.moment) this.pick(this.down!.body);
        if (event.pointerId === this.held || this.held === null) this.release();
    }
    release(): void {
        if (this.grabbing) this.player.world.release();
        this.grabbing = false;
        this.held = null;
        this.down = null;
        this.stage.canvas.classList.remove("grabbing");
    }

    // Called once a frame.
    draw(): void {
        this.grip.show(this.grabbing ? this.player.world.grabbed() : null, this.target);
    }
}
