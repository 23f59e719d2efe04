// The hand on the two shapes: drags move one or turn it, keys do the same in small steps.
import * as THREE from "three";
import type { HeldShape } from "./shapes";
import type { View } from "./view";

export type Way = "move" | "turn";

export class Hand {
    way: Way = "move";
    private held: { shape: number; x: number; y: number; pointer: number } | null = null;
    private readonly plane = new THREE.Plane();
    private readonly grip = new THREE.Vector3();

    // `pick`: which shape the ray through a point of the page meets, and where; `changed`: a shape has moved, `done`:
    // the hand has let go.
    constructor(
        private readonly view: View, private readonly shapes: HeldShape[],
        private readonly pick: (ray: THREE.Ray) => { shape: number; point: THREE.Vector3 } | null,
        private readonly chosen: (shape: number) => void, private readonly changed: (done: boolean) => void,
    ) {
        const { canvas } = view;
        // Before the camera's own listeners, so that a drag of a shape does not turn the camera.
        canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
        canvas.addEventListener("pointermove", (event) => this.move(event));
        for (const name of ["pointerup", "pointercancel"] as const)
            canvas.addEventListener(name, (event) => this.lift(event));
    }
    get busy(): boolean {
        return this.held !== null;
    }

    private press(event: PointerEvent): void {
        if (this.held || !event.isPrimary || event.button > 2) return;
        const hit = this.pick(this.view.stage.ray(event.clientX, event.clientY));
        if (!hit) return;
        event.stopImmediatePropagation();
        event.preventDefault();
        this.view.canvas.focus();
        this.view.canvas.setPointerCapture(event.pointerId);
        this.held = { shape: hit.shape, x: event.clientX, y: event.clientY, pointer: event.pointerId };
        this.grip.copy(hit.point);
        this.plane.setFromNormalAndCoplanarPoint(this.axes().towards, hit.point);
        this.view.canvas.classList.add("grabbing");
        this.chosen(hit.shape);
    }
    private move(event: PointerEvent): void {
        if (event.pointerId !== this.held?.pointer) return;
        const { held } = this, shape = this.shapes[held.shape];
        const turning = (this.way === "turn") !== (event.shiftKey || (event.buttons & 2) !== 0);
        if (turning) {
            this.turnBy(held.shape, (event.clientX - held.x) / 110, (event.clientY - held.y) / 110);
        } else {
            const ray = this.view.stage.ray(event.clientX, event.clientY);
            const to = ray.intersectPlane(this.plane, new THREE.Vector3());
            if (to) {
                shape.position.add(to).sub(this.grip);
                this.grip.copy(to);
            }
        }
        held.x = event.clientX;
        held.y = event.clientY;
        this.changed(false);
    }
    private lift(event: PointerEvent): void {
        if (event.pointerId !== this.held?.pointer) return;
        this.held = null;
        this.view.canvas.classList.remove("grabbing");
        this.changed(true);
    }

    // The camera's axes in the world.
    private axes(): { right: THREE.Vector3; up: THREE.Vector3; towards: THREE.Vector3 } {
        const [right, up, towards] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
        this.view.stage.camera.updateMatrixWorld();
        this.view.stage.camera.matrixWorld.extractBasis(right, up, towards);
        return { right, up, towards };
    }
    // As a ball that is rolled by its front, radians.
    private turnBy(shape: number, x: number, y: number): void {
        const { right, up } = this.axes(), { turn } = this.shapes[shape];
        turn.premultiply(new THREE.Quaternion().setFromAxisAngle(up, x));
        turn.premultiply(new THREE.Quaternion().setFromAxisAngle(right, y)).normalize();
    }
    // A step by keys: right, up and towards the eye, -1 to 1 each.
    nudge(shape: number, x: number, y: number, z: number): void {
        const { right, up, towards } = this.axes();
        if (this.way === "turn") {
            this.turnBy(shape, x / 12, -y / 12);
            const roll = new THREE.Quaternion().setFromAxisAngle(towards, z / 12);
            this.shapes[shape].turn.premultiply(roll).normalize();
        } else {
            const step = this.view.span / 40;
            const way = right.multiplyScalar(x).addScaledVector(up, y).addScaledVector(towards, z);
            this.shapes[shape].position.addScaledVector(way, step);
        }
        this.changed(true);
    }
}
