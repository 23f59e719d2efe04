// Joints as thin rods, for scenes whose bodies would seem to hang from nothing: from one body's centre to the other's,
// or to where it hangs from one that does not move.
import * as THREE from "three";
import type { JointInfo } from "../engine/types";

const up = new THREE.Vector3(0, 1, 0);

export class Links {
    readonly group = new THREE.Group();
    private mesh: THREE.InstancedMesh | null = null;
    private readonly a = new THREE.Vector3();
    private readonly b = new THREE.Vector3();
    private readonly along = new THREE.Vector3();
    private readonly turn = new THREE.Quaternion();
    private readonly matrix = new THREE.Matrix4();

    forget(): void {
        if (!this.mesh) return;
        this.group.remove(this.mesh);
        this.mesh.geometry.dispose();
        (this.mesh.material as THREE.Material).dispose();
        this.mesh.dispose();
        this.mesh = null;
    }
    // `radius`: m; `centre`: where a body is drawn, false where it is none that moves.
    place(joints: JointInfo[], centre: (body: number, out: THREE.Vector3) => boolean, radius: number): void {
        if (!this.mesh || this.mesh.count < joints.length) this.make(joints.length);
        const mesh = this.mesh!;
        let used = 0;
        for (const { bodyA, bodyB, position } of joints) {
            const first = centre(bodyA, this.a), second = centre(bodyB, this.b);
            if (!first) this.a.set(...position);
            if (!second) this.b.set(...position);
            this.b.sub(this.a);
            const size = this.b.length();
            if (size < radius) continue;
            this.turn.setFromUnitVectors(up, this.along.copy(this.b).divideScalar(size));
            this.a.addScaledVector(this.b, 0.5);
            mesh.setMatrixAt(used++, this.matrix.compose(this.a, this.turn, this.along.set(radius, size, radius)));
        }
        for (let i = used; i < mesh.count; ++i) mesh.setMatrixAt(i, this.matrix.makeScale(0, 0, 0));
        mesh.instanceMatrix.needsUpdate = true;
    }
    private make(count: number): void {
        this.forget();
        const material = new THREE.MeshStandardMaterial({ color: 0x8b929a, roughness: 0.45, metalness: 0.25 });
        this.mesh = new THREE.InstancedMesh(new THREE.CylinderGeometry(1, 1, 1, 10), material, Math.max(count, 1));
        this.mesh.castShadow = true;
        this.mesh.frustumCulled = false;
        this.group.add(this.mesh);
    }
}
