// The pointer on the scene: a click picks a body, a drag from a dynamic one pulls it, a drag from elsewhere turns the
// camera. Lets go in motion throw the body.
import * as THREE from "three";
import { type Hit, type Vec3 } from "./engine/types";
import type { Picture } from "./picture";
import type { Player } from "./player";

const clickReach = 6; // pixels; a pointer that moves farther drags

export const vector = (v: THREE.Vector3): Vec3 => [v.x, v.y, v.z];

export class Pointer {
    private held: number | null = null; // pointer id
    private readonly target = new THREE.Vector3();
    private readonly plane = new THREE.Plane();
    private down: { x: number; y: number; body: number | null } | null = null;

    constructor(
        private readonly picture: Picture,
        private readonly player: Player,
        private readonly pick: (body: number | null) => void,
        private readonly guarded: (action: () => void) => void,
    ) {
        const { canvas } = picture.stage;
        // Before the camera's own listeners, so that a drag of a body does not turn the camera.
        canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
        canvas.addEventListener("pointermove", (event) => this.guarded(() => this.move(event)));
        canvas.addEventListener("pointerup", (event) => this.guarded(() => this.lift(event)));
        canvas.addEventListener("pointercancel", () => this.guarded(() => this.release()));
    }

    // What the ray through a point of the page meets in the present.
    hit(x: number, y: number): Hit | null {
        const ray = this.picture.stage.ray(x, y);
        const far = ray.direction.clone().multiplyScalar(this.picture.stage.far);
        const hit = this.player.world.castRay(vector(ray.origin), vector(far));
        if (hit !== undefined) return hit;
        const seen = this.picture.bodies.hit(ray);
        return seen && { body: seen.body, point: vector(seen.point) };
    }

    private press(event: PointerEvent): void {
        if (event.button !== 0 || this.held !== null || !event.isPrimary) return;
        const hit = this.player.moment ? null : this.hit(event.clientX, event.clientY);
        this.down = { x: event.clientX, y: event.clientY, body: hit?.body ?? null };
        if (!hit || !this.picture.bodies.isDynamic(hit.body)) return;
        event.stopImmediatePropagation();
        this.picture.stage.canvas.setPointerCapture(event.pointerId);
        this.held = event.pointerId;
        this.target.set(...hit.point);
        const facing = this.picture.stage.camera.getWorldDirection(new THREE.Vector3());
        this.plane.setFromNormalAndCoplanarPoint(facing, this.target);
    }
    private move(event: PointerEvent): void {
        if (event.pointerId !== this.held || !this.down) return;
        const far = Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y) > clickReach;
        if (!this.grabbing) {
            if (!far || this.down.body === null) return;
            const body = this.down.body;
            this.player.change({ do: "grab", body, point: vector(this.target) });
            this.grabbing = true;
            this.picture.stage.canvas.classList.add("grabbing");
            this.pick(body);
        }
        const ray = this.picture.stage.ray(event.clientX, event.clientY);
        if (ray.intersectPlane(this.plane, this.target))
            this.player.change({ do: "drag", target: vector(this.target) });
    }
    private grabbing = false;
    // Whether the line of the grip is drawn, or was a moment ago.
    get active(): boolean {
        return this.grabbing || this.picture.grip.line.visible;
    }
    private lift(event: PointerEvent): void {
        const still = this.down && Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y) <= clickReach;
        if (still && !this.grabbing && event.button === 0 && !this.player.moment) this.pick(this.down!.body);
        if (event.pointerId === this.held || this.held === null) this.release();
    }
    release(): void {
        if (this.grabbing) this.player.change({ do: "release" });
        this.forget();
    }
    // Without a word to the world, which may be another one by now.
    forget(): void {
        this.grabbing = false;
        this.held = null;
        this.down = null;
        this.picture.stage.canvas.classList.remove("grabbing");
    }

    // Called once a frame.
    draw(): void {
        this.picture.grip.show(this.grabbing ? this.player.world.grabbed() : null, this.target);
    }
}
