// Two futures side by side: the bodies of the other one, and the camera that sees both.
import * as THREE from "three";
import type { Player } from "./player";
import { Bodies } from "./view/bodies";
import type { Stage } from "./view/stage";

const farther = 1.7; // times as far away the camera is where two futures stand side by side

export class Futures {
    readonly bodies: Bodies;

    constructor(private readonly player: Player, private readonly stage: Stage) {
        this.bodies = new Bodies(stage.drawer.groundMaterial);
        this.bodies.group.visible = false;
        stage.scene.add(this.bodies.group);
    }
    // After bodies came or went in either; `box`: of what moves in the player's own world.
    rebuild(otherScene: boolean, box: () => THREE.Box3): void {
        const { twin, world } = this.player, { group } = this.bodies, was = group.visible;
        // Over a stream its shapes are still to come: until then they are the world's.
        if (twin) this.bodies.build(twin.shapes().bodies < 0 ? world.shapes() : twin.shapes(), !was);
        if (twin && !was) this.place(box());
        group.visible = twin !== null;
        // Both futures are in the picture, and the one that is left again.
        const half = group.position.clone().multiplyScalar(0.5);
        if (twin && !was) this.stage.shift(half, farther);
        if (!twin && was && !otherScene) this.stage.shift(half.negate(), 1 / farther);
    }
    // Beside the other one, as the camera sees it.
    private place(box: THREE.Box3): void {
        const side = new THREE.Vector3();
        this.stage.camera.getWorldDirection(side).cross(this.stage.camera.up).normalize();
        side.multiplyScalar(1.15 * Math.max(box.max.x - box.min.x, box.max.z - box.min.z));
        this.bodies.group.position.copy(side);
        this.bodies.group.updateMatrixWorld(true);
    }
    draw(all: boolean): void {
        const { twin, twinNow } = this.player;
        if (twin) this.bodies.place(twinNow, twinNow, 1, all);
    }
    paint(ground: number): void {
        if (this.player.twin) this.bodies.paint("body", this.player.twinNow, new Int32Array(), -1, ground);
    }
}
