// One of the two pictures of the mode: a stage whose camera looks at what there is to see, eases when that changes,
// and turns as one with the other's.
import * as THREE from "three";
import { Stage } from "../view/stage";
import type { Theme } from "../view/theme";
import { Drawing } from "./drawing";
import type { Step } from "./sequence";

const firstDirection = new THREE.Vector3(0.5, 0.36, 1).normalize();

// How both cameras look: from which side, and how far away, as a multiple of what shows everything.
export interface Orbit {
    direction: THREE.Vector3;
    zoom: number;
}
export const firstOrbit = (): Orbit => ({ direction: firstDirection.clone(), zoom: 1 });

export class View {
    readonly stage: Stage;
    readonly drawing: Drawing;
    private readonly centre = new THREE.Vector3();
    private readonly goal = new THREE.Vector3();
    private distance = 1;
    private goalDistance = 1;
    private orbit = firstOrbit();
    private readonly lift: number; // of the height
    span = 1;

    // `shapes`: this is the picture of the shapes, which throw shadows.
    constructor(readonly canvas: HTMLCanvasElement, shadows: number, shapes: boolean) {
        this.lift = shapes ? 0.09 : 0.02;
        this.stage = new Stage(canvas, shadows, false);
        this.drawing = new Drawing(canvas.parentElement!, shapes);
        this.stage.scene.add(this.drawing.group);
        const { controls } = this.stage;
        controls.enablePan = false;
        controls.zoomToCursor = false;
    }
    apply(theme: Theme): void {
        this.stage.apply(theme);
    }
    show(step: Step, dark: boolean, place: THREE.Matrix4): void {
        this.drawing.show(step, this.span, dark);
        this.drawing.group.matrixAutoUpdate = false;
        this.drawing.group.matrix.copy(place);
        this.drawing.group.updateMatrixWorld(true);
    }

    // Looks at what lies within the bounds; at once, or within some frames. The picture is a little higher than its
    // middle: below are the fields.
    aim(bounds: THREE.Box3, atOnce: boolean): void {
        const { stage } = this, { clientWidth: width, clientHeight: height } = this.canvas;
        stage.camera.setViewOffset(width, height, 0, this.lift * height, width, height);
        stage.frame(bounds, 0.3, true);
        this.span = stage.span;
        this.goal.copy(stage.controls.target);
        this.goalDistance = stage.camera.position.distanceTo(this.goal);
        if (atOnce) {
            this.centre.copy(this.goal);
            this.distance = this.goalDistance;
        }
        this.turn(this.orbit);
    }
    // What the hand has done with this view's camera.
    get looked(): Orbit {
        const { camera, controls } = this.stage, away = camera.position.clone().sub(controls.target);
        return { zoom: away.length() / this.distance, direction: away.normalize() };
    }
    turn(orbit: Orbit): void {
        this.orbit = orbit;
        const { camera, controls } = this.stage;
        controls.target.copy(this.centre);
        camera.position.copy(this.centre).addScaledVector(orbit.direction, orbit.zoom * this.distance);
        camera.lookAt(this.centre);
    }
    // A frame's part of the way; true while there is some left.
    ease(): boolean {
        const rest = this.centre.distanceTo(this.goal) + Math.abs(this.distance - this.goalDistance);
        if (rest === 0) return false;
        const share = rest < 1e-3 * this.span ? 1 : 0.22;
        this.centre.lerp(this.goal, share);
        this.distance += share * (this.goalDistance - this.distance);
        return true;
    }
    render(): void {
        this.stage.render();
        this.drawing.placeLabels(this.stage);
    }
}
