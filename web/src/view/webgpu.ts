// The picture by WebGPU: three.js's renderer for it, the ground's grid as nodes, ambient occlusion as a pass before the
// one that is seen. A part of the page of its own, which is loaded only where there is WebGPU.
import * as THREE from "three/webgpu";
import {
    builtinAOContext, float, Fn, fract, fwidth, max, min, mix, mrt, normalView, normalWorld, output, pass,
    positionGeometry, positionWorld, screenUV, smoothstep, uniform, vec2, vec3, vec4,
} from "three/tsl";
import { ao } from "three/addons/tsl/display/GTAONode.js";
import type { Drawer, Drawn, MakeDrawer } from "./drawer";
import { gridColour, groundColour, groundReach } from "./materials";

const colour = (of: THREE.Color) => {
    const { r, g, b } = uniform(of);
    return vec3(r, g, b);
};
const grid = colour(gridColour.value), ground = colour(groundColour.value);
const reachOf = uniform(groundReach.value).onRenderUpdate(() => groundReach.value);
const skyNow = new THREE.Color(), sky = colour(skyNow);

// How much of a line of the grid with this distance between lines covers a pixel; they fade before they would flicker.
const lineOf = Fn(([at, width]: [any, any]) => {
    const pixel = max(fwidth(at), vec2(1e-6));
    const toLine = fract(at.sub(0.5)).sub(0.5).abs().div(pixel);
    const seen = float(1.2).sub(max(pixel.x, pixel.y).mul(6)).clamp(0, 1);
    return seen.mul(float(1).sub(min(min(toLine.x, toLine.y).div(width), 1)));
});

// As materials.ts makes it: lines every metre and every ten on what faces up; slabs that are much larger than what is
// looked at fade into the sky towards their edges.
function groundMaterial(): THREE.Material {
    const material = new THREE.MeshStandardNodeMaterial({ roughness: 0.95, metalness: 0, side: THREE.DoubleSide });
    const place = positionWorld.xz, onSlab = positionGeometry.xz;
    const lines = max(lineOf(place, float(1)).mul(0.55), lineOf(place.div(10), float(1.3)));
    const up = smoothstep(0.9, 0.99, normalWorld.y.abs());
    // The colour of an instance is a factor of this one.
    material.colorNode = mix(vec3(1), grid.div(ground), up.mul(lines));
    const scale = fwidth(place).length().div(max(fwidth(onSlab).length(), 1e-9));
    const isLarge = scale.greaterThan(reachOf.mul(1.6)).select(1, 0);
    const edge = max(onSlab.x.abs(), onSlab.y.abs()).mul(isLarge);
    material.outputNode = vec4(mix(output.rgb, sky, smoothstep(0.3, 0.97, edge)), output.a);
    return material;
}

class WebGpuDrawer implements Drawer {
    readonly name: Drawer["name"];
    readonly mapsSky = true;
    readonly groundMaterial = groundMaterial;
    private readonly pipeline: THREE.RenderPipeline | null = null;
    private readonly occlusion: ReturnType<typeof ao> | null = null;
    private occluded = false;

    constructor(private readonly drawn: Drawn, private readonly renderer: THREE.WebGPURenderer, device: boolean) {
        this.name = device ? "WebGPU" : "WebGL 2";
        renderer.shadowMap.enabled = drawn.shadows;
        renderer.shadowMap.type = THREE.PCFShadowMap;
        renderer.toneMapping = THREE.NeutralToneMapping;
        if (!drawn.occlusion) return;
        const { scene, camera } = drawn, before = pass(scene, camera), seen = pass(scene, camera);
        before.transparent = false; // one does not see the occlusion through glass
        before.setMRT(mrt({ output: normalView }));
        this.occlusion = ao(before.getTextureNode("depth"), before.getTextureNode(), camera);
        this.occlusion.samples.value = 16;
        seen.contextNode = builtinAOContext(this.occlusion.getTextureNode().sample(screenUV).r);
        this.pipeline = new THREE.RenderPipeline(renderer, seen);
        this.occluded = true;
    }
    get ratio(): number {
        return this.renderer.getPixelRatio();
    }
    resize(width: number, height: number, ratio: number): void {
        this.renderer.setPixelRatio(ratio);
        this.renderer.setSize(width, height, false);
    }
    render(reach: number): void {
        const { scene, camera } = this.drawn;
        if (scene.background instanceof THREE.Color) skyNow.copy(scene.background);
        if (!this.occluded) return void this.renderer.render(scene, camera);
        this.occlusion!.radius.value = this.occlusion!.thickness.value = 0.06 * reach;
        this.pipeline!.render();
    }
    dropOcclusion(): void {
        this.occluded = false;
    }
}

// Draws on this canvas. `by`: "webgpu", also where that runs in software; "nodes": the same nodes by WebGL 2, for tests
// on machines without WebGPU. Null where WebGPU is best left alone: without an adapter, or with one in software.
export async function webGpu(canvas: HTMLCanvasElement, antialias: boolean, by: string | null):
    Promise<MakeDrawer | null> {
    let device: GPUDevice | undefined;
    if (by !== "nodes") {
        const adapter = await navigator.gpu?.requestAdapter({ powerPreference: "high-performance" });
        if (!adapter || (adapter.info.isFallbackAdapter && by !== "webgpu")) return null;
        device = await adapter.requestDevice();
    }
    const renderer = new THREE.WebGPURenderer({ canvas, antialias, device, forceWebGL: !device });
    await renderer.init();
    renderer.onDeviceLost = () => drawn?.lost("The picture's device is lost: load the page again.");
    let drawn: Drawn | null = null;
    return (what) => new WebGpuDrawer((drawn = what), renderer, device !== undefined);
}
