// The marks of a step as meshes: solids to see through, faces, rods, balls and arrows, with labels over the picture.
import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { make } from "../ui/dom";
import type { Stage } from "../view/stage";
import { Ink, type Mark, MarkKind, type Solid, type Step } from "./sequence";

const inks: Record<"light" | "dark", Record<Ink, number>> = {
    light: {
        [Ink.origin]: 0x20272e, [Ink.difference]: 0x9aa3ab, [Ink.a]: 0x3f79b5, [Ink.b]: 0x4f9a6b,
        [Ink.step]: 0xd98324, [Ink.found]: 0xc8403a,
    },
    dark: {
        [Ink.origin]: 0xf2f4f6, [Ink.difference]: 0x8995a1, [Ink.a]: 0x6fa6dd, [Ink.b]: 0x74bd90,
        [Ink.step]: 0xf0a94f, [Ink.found]: 0xf0695f,
    },
};

const rod = new THREE.CylinderGeometry(1, 1, 1, 10, 1), ball = new THREE.SphereGeometry(1, 20, 14);
const tip = new THREE.ConeGeometry(1, 1, 16);
const up = new THREE.Vector3(0, 1, 0);
const at = (points: Float32Array, i: number) => new THREE.Vector3().fromArray(points, 3 * i);

interface Piece {
    ink: Ink;
    matrix: THREE.Matrix4;
}
interface Label {
    text: string;
    place: THREE.Vector3;
    element: HTMLElement;
}

export class Drawing {
    readonly group = new THREE.Group();
    readonly meshes = new Map<Solid, THREE.Mesh>(); // fronts of solids, to be met by rays
    private readonly materials = new Map<string, THREE.Material>();
    private labels: Label[] = [];
    private pieces: Record<"rods" | "balls" | "tips", Piece[]> = { rods: [], balls: [], tips: [] };
    private unit = 1; // m of a pixel, or so
    private dark = false;
    private through = false; // what lies within solids is seen as if they were not there

    // `over`: the element over the picture that holds the labels; `casts`: solids throw shadows.
    constructor(private readonly over: HTMLElement, private readonly casts: boolean) {}

    // `span`: radius of what is seen, m.
    show(step: Step, span: number, dark: boolean): void {
        this.clear();
        this.unit = span / 190;
        this.dark = dark;
        this.through = !step.marks.some((mark) => mark.ink === Ink.difference);
        for (const mark of step.marks) this.add(mark);
        const shapes = { rods: rod, balls: ball, tips: tip };
        for (const [name, geometry] of Object.entries(shapes)) this.addPieces(geometry, this.pieces[name as "rods"]);
    }
    private clear(): void {
        this.group.traverse((object) => {
            const { geometry } = object as THREE.Mesh;
            if (geometry && geometry !== rod && geometry !== ball && geometry !== tip) geometry.dispose();
            if (object instanceof THREE.InstancedMesh) object.dispose();
        });
        this.group.clear();
        this.meshes.clear();
        for (const { element } of this.labels) element.remove();
        this.labels = [];
        this.pieces = { rods: [], balls: [], tips: [] };
    }
    // Materials stay: what draws them would be compiled anew for every step otherwise.
    private material(key: string, make: () => THREE.Material): THREE.Material {
        const made = this.materials.get(key) ?? make();
        this.materials.set(key, made);
        return made;
    }
    private colour(ink: Ink): number {
        return inks[this.dark ? "dark" : "light"][ink];
    }

    private add(mark: Mark): void {
        const { points, ink, width } = mark, last = points.length / 3 - 1;
        if (mark.kind === MarkKind.solid) return this.addSolid(mark, mark.solid!);
        if (mark.kind === MarkKind.face) this.addFace(mark);
        if (mark.kind === MarkKind.path)
            for (let i = 0; i < last; ++i) this.addRod(at(points, i), at(points, i + 1), width, ink);
        if (mark.kind === MarkKind.dot) this.addBall(at(points, 0), 1.5 * width, ink);
        if (mark.kind === MarkKind.arrow) this.addArrow(at(points, 0), at(points, 1), width, ink);
        if (!mark.label) return;
        const element = make("span", mark.label, { class: "mark", "aria-hidden": "true" });
        element.style.color = `#${this.colour(ink).toString(16).padStart(6, "0")}`;
        this.over.append(element);
        this.labels.push({ text: mark.label, place: at(points, last), element });
    }
    private addSolid(mark: Mark, solid: Solid): void {
        let geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(solid.points, 3));
        if (solid.indices.length === 0) return this.addFlat(mark, solid);
        geometry.setIndex(new THREE.BufferAttribute(solid.indices, 1));
        const edges = new THREE.EdgesGeometry(geometry, solid.curved ? 37 : 2);
        geometry = toCreasedNormals(geometry, solid.curved ? 0.6 : 0.02);
        const opacity = mark.faint ? 0.16 : mark.ink === Ink.difference ? 0.3 : 1.24 * mark.opacity;
        for (const side of [THREE.BackSide, THREE.FrontSide]) {
            const color = this.colour(mark.ink), thin = side === THREE.BackSide ? 0.6 * opacity : opacity;
            const mesh = new THREE.Mesh(geometry, this.material(`solid ${side} ${color} ${thin}`, () =>
                new THREE.MeshStandardMaterial({
                    color, emissive: color, emissiveIntensity: 0.16, roughness: 0.5, transparent: true, side,
                    depthWrite: false, opacity: thin,
                })));
            mesh.renderOrder = side === THREE.BackSide ? 0 : 3;
            mesh.castShadow = this.casts && side === THREE.FrontSide;
            this.group.add(mesh);
            if (side === THREE.FrontSide) this.meshes.set(solid, mesh);
        }
        const color = this.colour(mark.ink), thin = mark.faint ? 0.35 : 0.8;
        const line = new THREE.LineSegments(edges, this.material(`line ${color} ${thin}`, () =>
            new THREE.LineBasicMaterial({ color, transparent: true, opacity: thin })));
        line.renderOrder = 4;
        this.group.add(line);
    }
    // A difference of cores may be a point or a line: its corners are joined.
    private addFlat(mark: Mark, { points }: Solid): void {
        const count = Math.min(points.length / 3, 8);
        for (let i = 0; i < count; ++i) {
            this.addBall(at(points, i), 3, mark.ink);
            for (let k = 0; k < i; ++k) this.addRod(at(points, k), at(points, i), 1, mark.ink);
        }
    }
    private addFace(mark: Mark): void {
        const count = mark.points.length / 3, geometry = new THREE.BufferGeometry(), fan: number[] = [];
        for (let i = 2; i < count; ++i) fan.push(0, i - 1, i);
        geometry.setAttribute("position", new THREE.BufferAttribute(mark.points, 3));
        geometry.setIndex(fan);
        geometry.computeVertexNormals();
        const color = this.colour(mark.ink), { opacity } = mark;
        const mesh = new THREE.Mesh(geometry, this.material(`face ${color} ${opacity}`, () =>
            new THREE.MeshStandardMaterial({
                color, roughness: 0.7, transparent: true, opacity, side: THREE.DoubleSide, depthWrite: false,
                polygonOffset: true, polygonOffsetFactor: -1,
            })));
        mesh.renderOrder = 2;
        this.group.add(mesh);
        for (let i = 0; i < count; ++i)
            this.addRod(at(mark.points, i), at(mark.points, (i + 1) % count), mark.width, mark.ink);
    }

    // --- pieces that are drawn many at once

    private addRod(from: THREE.Vector3, to: THREE.Vector3, width: number, ink: Ink): void {
        const way = to.clone().sub(from), length = way.length(), radius = 0.75 * width * this.unit;
        if (length < 1e-6) return;
        const turn = new THREE.Quaternion().setFromUnitVectors(up, way.divideScalar(length));
        const middle = from.clone().add(to).multiplyScalar(0.5), size = new THREE.Vector3(radius, length, radius);
        this.pieces.rods.push({ ink, matrix: new THREE.Matrix4().compose(middle, turn, size) });
    }
    private addBall(place: THREE.Vector3, radius: number, ink: Ink): void {
        const r = radius * 0.75 * this.unit;
        this.pieces.balls.push({ ink, matrix: new THREE.Matrix4().makeScale(r, r, r).setPosition(place) });
    }
    private addArrow(from: THREE.Vector3, to: THREE.Vector3, width: number, ink: Ink): void {
        const way = to.clone().sub(from), length = way.length(), head = Math.min(9 * this.unit, 0.5 * length);
        if (length < 1e-6) return;
        way.divideScalar(length);
        this.addRod(from, to.clone().addScaledVector(way, -head), width, ink);
        const turn = new THREE.Quaternion().setFromUnitVectors(up, way);
        const middle = to.clone().addScaledVector(way, -0.5 * head);
        const size = new THREE.Vector3(0.38 * head, head, 0.38 * head);
        this.pieces.tips.push({ ink, matrix: new THREE.Matrix4().compose(middle, turn, size) });
    }
    private addPieces(geometry: THREE.BufferGeometry, list: Piece[]): void {
        if (list.length === 0) return;
        const { through } = this, material = this.material(`pieces ${through}`, () =>
            new THREE.MeshStandardMaterial({ roughness: 0.45, transparent: through }));
        const mesh = new THREE.InstancedMesh(geometry, material, list.length);
        const colour = new THREE.Color();
        list.forEach(({ ink, matrix }, i) => {
            mesh.setMatrixAt(i, matrix);
            mesh.setColorAt(i, colour.setHex(this.colour(ink)));
        });
        mesh.frustumCulled = false;
        mesh.renderOrder = through ? 5 : 1;
        this.group.add(mesh);
    }

    // Puts the labels beside what they name, as the camera sees it now.
    placeLabels(stage: Stage): void {
        const box = this.over.getBoundingClientRect();
        this.group.updateMatrixWorld(true);
        for (const { place, element } of this.labels) {
            const [x, y] = stage.project(place.clone().applyMatrix4(this.group.matrixWorld).toArray());
            const [left, top] = [x - box.left + 7, y - box.top - 20].map((v) => v.toFixed(1));
            element.style.transform = `translate(${left}px, ${top}px)`;
        }
    }
}
