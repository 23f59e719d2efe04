// The camera goes where a body goes, up and down at most half as far.
import * as THREE from "three";
import { poseStride, type Shapes } from "./engine/types";
import type { Stage } from "./view/stage";

export class Follow {
    private body = -1;
    private at: THREE.Vector3 | null = null;

    constructor(private readonly stage: Stage) {}
    // The body of this name, or none.
    set(shapes: Shapes, name: string | undefined): void {
        this.body = -1;
        for (let i = 0; name && i < shapes.bodies; ++i) if (shapes.name(i) === name) this.body = i;
        this.at = null;
    }
    // Called once a frame, with what is drawn.
    go(before: Float32Array, now: Float32Array, share: number): void {
        const at = poseStride * this.body;
        if (this.body < 0 || at >= Math.min(before.length, now.length)) return;
        const place = new THREE.Vector3().fromArray(before, at).lerp(new THREE.Vector3().fromArray(now, at), share);
        if (this.at) {
            const way = place.clone().sub(this.at);
            way.y *= 0.5;
            this.stage.camera.position.add(way);
            this.stage.controls.target.add(way);
        }
        this.at = place;
    }
}
