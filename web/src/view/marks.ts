// What is drawn over the bodies: contact points with their normals and impulses, and the line of a grip.
import * as THREE from "three";
import { contactStride } from "../engine/types";

const most = 20000;

export class ContactMarks {
    readonly group = new THREE.Group();
    private readonly points: THREE.InstancedMesh;
    private readonly lines: THREE.LineSegments;

    constructor() {
        this.points = new THREE.InstancedMesh(
            new THREE.SphereGeometry(1, 10, 8), new THREE.MeshBasicMaterial({ color: 0xffffff }), most);
        this.points.frustumCulled = false;
        const geometry = new THREE.BufferGeometry();
        const ends = new THREE.BufferAttribute(new Float32Array(6 * most), 3);
        ends.setUsage(THREE.DynamicDrawUsage);
        geometry.setAttribute("position", ends);
        this.lines = new THREE.LineSegments(
            geometry, new THREE.LineBasicMaterial({ color: 0x2fa36b, depthTest: false, transparent: true }));
        this.lines.frustumCulled = false;
        this.lines.renderOrder = 2;
        const material = this.points.material as THREE.MeshBasicMaterial;
        material.depthTest = false;
        material.transparent = true;
        this.points.renderOrder = 3;
        this.points.setColorAt(0, new THREE.Color());
        this.group.add(this.points, this.lines);
        this.group.visible = false;
    }

    // Overlapping points are orange, those that are only near are blue; a line is as long as the impulse is strong.
    show(contacts: Float32Array, span: number): void {
        const count = Math.min(contacts.length / contactStride, most);
        let strongest = 0;
        for (let i = 0; i < count; ++i) strongest = Math.max(strongest, contacts[contactStride * i + 7]);
        const matrix = new THREE.Matrix4(), size = span / 260;
        const touching = new THREE.Color(0xe8743b), near = new THREE.Color(0x4f87b8);
        const ends = this.lines.geometry.getAttribute("position") as THREE.BufferAttribute;
        for (let i = 0; i < count; ++i) {
            const c = contacts.subarray(contactStride * i, contactStride * (i + 1));
            matrix.makeScale(size, size, size).setPosition(c[0], c[1], c[2]);
            this.points.setMatrixAt(i, matrix);
            this.points.setColorAt(i, c[3] <= 0 ? touching : near);
            const length = strongest > 0 ? (span / 9) * Math.sqrt(c[7] / strongest) : 0;
            ends.setXYZ(2 * i, c[0], c[1], c[2]);
            ends.setXYZ(2 * i + 1, c[0] + length * c[4], c[1] + length * c[5], c[2] + length * c[6]);
        }
        this.points.count = count;
        this.points.instanceMatrix.needsUpdate = true;
        if (this.points.instanceColor) this.points.instanceColor.needsUpdate = true;
        this.lines.geometry.setDrawRange(0, 2 * count);
        ends.needsUpdate = true;
    }
}

export class GripLine {
    readonly line: THREE.Line;
    constructor() {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
        this.line = new THREE.Line(
            geometry, new THREE.LineBasicMaterial({ color: 0xe0662f, depthTest: false, transparent: true }));
        this.line.frustumCulled = false;
        this.line.renderOrder = 4;
        this.line.visible = false;
    }
    show(from: readonly number[] | null, to: THREE.Vector3): void {
        this.line.visible = from !== null;
        if (!from) return;
        const ends = this.line.geometry.getAttribute("position") as THREE.BufferAttribute;
        ends.setXYZ(0, from[0], from[1], from[2]);
        ends.setXYZ(1, to.x, to.y, to.z);
        ends.needsUpdate = true;
    }
}
