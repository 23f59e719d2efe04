// The stage: renderer, camera, light and what stands around the bodies.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { type Drawer, type MakeDrawer, webGl } from "./drawer";
import { gridColour, groundColour, groundReach } from "./materials";
import type { Theme } from "./theme";

// The colour that the Khronos neutral tone mapper turns into this one, nearly, for greyish colours: with occlusion the
// whole picture goes through it, the sky too.
function beforeToneMapping(colour: THREE.Color): void {
    const start = 0.76, d = 1 - start, peak = Math.max(colour.r, colour.g, colour.b);
    if (peak > start) colour.multiplyScalar(((d * d) / (1 - peak) - d + start) / peak);
    const least = Math.min(colour.r, colour.g, colour.b);
    const offset = least < 0.04 ? Math.sqrt(least / 6.25) - least : 0.04;
    colour.setRGB(colour.r + offset, colour.g + offset, colour.b + offset);
}

// From where a scene of this size is seen first: what is flat from farther above.
function firstSide(size: THREE.Vector3): THREE.Vector3 {
    const height = size.y / Math.max(size.x, size.z, 1e-6);
    return new THREE.Vector3(0.62, THREE.MathUtils.clamp(0.95 - 1.2 * height, 0.42, 0.95), 1).normalize();
}
// How much room there is around what is looked at, and by how much of the picture it stands below the middle, beneath
// the title.
const margin = 1.1, lift = 0.045;

export class Stage {
    readonly scene = new THREE.Scene();
    readonly camera = new THREE.PerspectiveCamera(42, 1, 0.05, 5000);
    readonly controls: OrbitControls;
    readonly drawer: Drawer;
    private readonly sun = new THREE.DirectionalLight();
    private readonly sky = new THREE.HemisphereLight();
    private readonly sunDirection = new THREE.Vector3(0.45, 1, 0.35).normalize();
    private size = [0, 0];
    lost: (sentence: string) => void = () => undefined; // nothing is drawn any more

    constructor(
        readonly canvas: HTMLCanvasElement, shadowSize: number, occlusion: boolean, make: MakeDrawer = webGl,
    ) {
        const { scene, camera } = this;
        const lost = (sentence: string) => this.lost(sentence);
        this.drawer = make({ canvas, scene, camera, shadows: shadowSize > 0, occlusion, lost });
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = true;
        this.controls.dampingFactor = 0.12;
        this.controls.maxPolarAngle = Math.PI * 0.97;
        this.controls.zoomToCursor = true;
        this.sun.castShadow = shadowSize > 0;
        this.sun.shadow.mapSize.set(shadowSize || 1, shadowSize || 1);
        this.sun.shadow.radius = 3.5;
        this.sun.shadow.normalBias = 0.03;
        this.sun.shadow.bias = -0.0002;
        this.scene.add(this.sky, this.sun, this.sun.target);
    }
    // For machines that are too slow for it.
    dropOcclusion(): void {
        this.drawer.dropOcclusion();
        this.apply(this.theme);
    }
    private theme!: Theme;

    apply(theme: Theme): void {
        this.theme = theme;
        const sky = new THREE.Color(theme.sky);
        if (this.drawer.mapsSky) beforeToneMapping(sky);
        this.scene.background = sky;
        this.scene.fog = new THREE.Fog(sky, 100, 500);
        this.sun.color.setHex(theme.sun);
        this.sun.intensity = theme.sunStrength;
        this.sky.color.setHex(theme.hemisphere[0]);
        this.sky.groundColor.setHex(theme.hemisphere[1]);
        this.sky.intensity = theme.hemisphere[2];
        gridColour.value.setHex(theme.line);
        groundColour.value.setHex(theme.ground);
        this.setReach(this.reach);
    }

    private reach = 10;
    private setReach(reach: number): void {
        this.reach = reach;
        const fog = this.scene.fog as THREE.Fog | null;
        if (fog) {
            fog.near = 8 * reach;
            fog.far = 40 * reach;
        }
        groundReach.value = reach;
        this.camera.near = reach / 300;
        this.camera.far = 120 * reach;
        this.camera.updateProjectionMatrix();
    }

    // Looks at what lies within the bounds, from a little above. `least`: radius of the smallest thing that fills the
    // picture, m. `tight`: as large as it can be.
    frame(bounds: THREE.Box3, least = 1.2, tight = false): void {
        const sphere = bounds.getBoundingSphere(new THREE.Sphere());
        const radius = Math.min(Math.max(sphere.radius, least), 400);
        this.setReach(radius);
        const side = firstSide(bounds.getSize(new THREE.Vector3()));
        this.controls.target.copy(sphere.center);
        this.camera.position.copy(sphere.center).add(side);
        this.camera.lookAt(sphere.center);
        const distance = (tight ? 0.98 : margin) * this.distanceOf(bounds, 0.6 * least);
        this.camera.position.copy(sphere.center).addScaledVector(side, distance);
        if (!tight) {
            const up = new THREE.Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion);
            up.multiplyScalar(2 * lift * distance * Math.tan((this.camera.fov * Math.PI) / 360));
            this.camera.position.add(up);
            this.controls.target.add(up);
        }
        this.controls.minDistance = radius / 40;
        this.controls.maxDistance = 12 * radius;
        this.controls.update();
    }

    // From a place at a target: six numbers.
    look(view: number[]): void {
        this.camera.position.fromArray(view);
        this.controls.target.fromArray(view, 3);
        this.controls.update();
    }

    // Moves what is looked at, and the camera with it, so many times as far away.
    shift(by: THREE.Vector3, farther: number): void {
        const { camera, controls } = this, away = camera.position.clone().sub(controls.target).multiplyScalar(farther);
        controls.target.add(by);
        camera.position.copy(controls.target).add(away);
        controls.update();
    }

    // From how far the camera, turned as it is, sees the whole of a box around its centre, and at least so much.
    private distanceOf(bounds: THREE.Box3, least: number): number {
        const toCamera = new THREE.Matrix4().makeRotationFromQuaternion(this.camera.quaternion).invert();
        const half = bounds.getSize(new THREE.Vector3()).multiplyScalar(0.5), corner = new THREE.Vector3();
        const high = Math.tan((this.camera.fov * Math.PI) / 360), wide = high * this.camera.aspect;
        let distance = 0;
        for (let i = 0; i < 8; ++i) {
            corner.set(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
            corner.applyMatrix4(toCamera);
            const [x, y] = [corner.x, corner.y].map((v) => Math.max(Math.abs(v), least));
            distance = Math.max(distance, corner.z + Math.max(x / wide, y / high));
        }
        return distance;
    }

    // Shadows fall around what moves.
    light(bounds: THREE.Box3): void {
        if (bounds.isEmpty()) return;
        const sphere = bounds.getBoundingSphere(new THREE.Sphere());
        const radius = Math.min(Math.max(sphere.radius * 1.15, 3), 6 * this.reach);
        const shadow = this.sun.shadow.camera;
        // In coarse steps, so that shadows' edges do not crawl with every step.
        const coarse = 2 ** (Math.ceil(Math.log2(radius) * 2) / 2);
        const centre = sphere.center.clone().divideScalar(coarse / 8).round().multiplyScalar(coarse / 8);
        this.sun.target.position.copy(centre);
        this.sun.position.copy(centre).addScaledVector(this.sunDirection, 3 * coarse);
        shadow.left = shadow.bottom = -coarse;
        shadow.right = shadow.top = coarse;
        shadow.near = 0.5 * coarse;
        shadow.far = 6 * coarse;
        shadow.updateProjectionMatrix();
        this.sun.target.updateMatrixWorld();
    }

    // Brings the camera up to date; true where the picture is another one than before.
    update(): boolean {
        const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
        const ratio = Math.min(window.devicePixelRatio, 2);
        const resized = width !== this.size[0] || height !== this.size[1] || ratio !== this.drawer.ratio;
        if (resized) {
            this.size = [width, height];
            this.drawer.resize(width, height, ratio);
            this.camera.aspect = width / Math.max(height, 1);
            this.camera.updateProjectionMatrix();
        }
        return this.controls.update() || resized;
    }
    render(): void {
        this.drawer.render(this.reach);
    }

    // The ray through a point of the page.
    ray(x: number, y: number): THREE.Ray {
        const box = this.canvas.getBoundingClientRect();
        const at = new THREE.Vector2(
            (2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
        const caster = new THREE.Raycaster();
        caster.setFromCamera(at, this.camera);
        return caster.ray;
    }
    // Where a point of the world is seen on the page.
    project(point: readonly number[]): [number, number] {
        const box = this.canvas.getBoundingClientRect();
        this.camera.updateMatrixWorld();
        const p = new THREE.Vector3(point[0], point[1], point[2]).project(this.camera);
        return [box.left + (0.5 + 0.5 * p.x) * box.width, box.top + (0.5 - 0.5 * p.y) * box.height];
    }
    get far(): number {
        return this.camera.far;
    }
    get span(): number {
        return this.reach;
    }
}
