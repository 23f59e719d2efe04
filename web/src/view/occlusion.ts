// Ambient occlusion: corners and what is close to the ground are a little darker (three.js's GTAO). Left out where it
// takes too long.
import * as THREE from "three";
import { EffectComposer } from "three/addons/postprocessing/EffectComposer.js";
import { GTAOPass } from "three/addons/postprocessing/GTAOPass.js";
import { OutputPass } from "three/addons/postprocessing/OutputPass.js";
import { RenderPass } from "three/addons/postprocessing/RenderPass.js";

// One does not see the occlusion through glass, nor that of glass itself.
class Pass extends GTAOPass {
    override render(...values: Parameters<GTAOPass["render"]>): void {
        const glass: THREE.Object3D[] = [];
        this.scene.traverse((object) => {
            if (object.userData.glass && object.visible) glass.push(object);
        });
        for (const object of glass) object.visible = false;
        super.render(...values);
        for (const object of glass) object.visible = true;
    }
}

export class Occlusion {
    private readonly composer: EffectComposer;
    private readonly pass: Pass;
    private reach = 0;

    constructor(renderer: THREE.WebGLRenderer, scene: THREE.Scene, camera: THREE.PerspectiveCamera) {
        const target = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, samples: 4 });
        this.composer = new EffectComposer(renderer, target);
        this.pass = new Pass(scene, camera, 1, 1);
        this.pass.blendIntensity = 0.85;
        this.pass.updatePdMaterial({ lumaPhi: 10, depthPhi: 2, normalPhi: 3, radius: 6, rings: 2, samples: 16 });
        for (const pass of [new RenderPass(scene, camera), this.pass, new OutputPass()]) this.composer.addPass(pass);
    }
    resize(width: number, height: number, ratio: number): void {
        this.composer.setPixelRatio(ratio);
        this.composer.setSize(width, height);
    }
    // `reach`: radius of the scene, m.
    render(reach: number): void {
        if (reach !== this.reach) {
            this.reach = reach;
            this.pass.updateGtaoMaterial({
                radius: 0.06 * reach, distanceExponent: 1.5, thickness: 0.06 * reach, scale: 1.1, samples: 16,
                distanceFallOff: 1, screenSpaceRadius: false,
            });
        }
        this.composer.render();
    }
}
