// What turns a scene into a picture. WebGPU draws where the browser has it (webgpu.ts, loaded when it is needed), else
// WebGL 2; both with shadows and ambient occlusion.
import * as THREE from "three";
import { groundMaterial } from "./materials";
import { Occlusion } from "./occlusion";

export interface Drawer {
    readonly name: "WebGPU" | "WebGL 2";
    readonly ratio: number;            // pixels of the picture in one of the page
    readonly mapsSky: boolean;         // the sky goes through the tone mapper too
    readonly groundMaterial: () => THREE.Material;
    resize(width: number, height: number, ratio: number): void;
    render(reach: number): void;       // `reach`: radius of the scene, m
    dropOcclusion(): void;             // for machines that are too slow for it
}

// A scene and a camera that are drawn, and how.
export interface Drawn {
    canvas: HTMLCanvasElement;
    scene: THREE.Scene;
    camera: THREE.PerspectiveCamera;
    shadows: boolean; // without them smooth edges are left out too: the machine draws in software, most likely
    occlusion: boolean;
    lost: (sentence: string) => void; // it can be drawn no more
}
export type MakeDrawer = (drawn: Drawn) => Drawer;

export class WebGlDrawer implements Drawer {
    readonly name = "WebGL 2";
    readonly groundMaterial = groundMaterial;
    private readonly renderer: THREE.WebGLRenderer;
    private occlusion: Occlusion | null = null;

    constructor(private readonly drawn: Drawn) {
        const { canvas, scene, camera, shadows: antialias } = drawn;
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" });
        this.renderer.shadowMap.enabled = drawn.shadows;
        this.renderer.shadowMap.type = THREE.PCFShadowMap;
        this.renderer.toneMapping = THREE.NeutralToneMapping;
        if (drawn.occlusion) this.occlusion = new Occlusion(this.renderer, scene, camera);
    }
    get ratio(): number {
        return this.renderer.getPixelRatio();
    }
    get mapsSky(): boolean {
        return this.occlusion !== null;
    }
    resize(width: number, height: number, ratio: number): void {
        this.renderer.setPixelRatio(ratio);
        this.renderer.setSize(width, height, false);
        this.occlusion?.resize(width, height, ratio);
    }
    render(reach: number): void {
        if (this.occlusion) this.occlusion.render(reach);
        else this.renderer.render(this.drawn.scene, this.drawn.camera);
    }
    dropOcclusion(): void {
        this.occlusion = null;
    }
}

export const webGl: MakeDrawer = (drawn) => new WebGlDrawer(drawn);

// `wanted`: "webgl", or what webgpu.ts names; null for what is best.
export async function chooseDrawer(
    canvas: HTMLCanvasElement, antialias: boolean, wanted: string | null,
): Promise<MakeDrawer> {
    if (wanted === "webgl" || (!wanted && !("gpu" in navigator))) return webGl;
    try {
        const { webGpu } = await import("./webgpu");
        return (await webGpu(canvas, antialias, wanted)) ?? webGl;
    } catch (error) {
        console.warn("WebGPU is there but does not start; WebGL 2 draws.", error);
        return webGl;
    }
}
