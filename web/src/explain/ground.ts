// A floor beneath the shapes, for their shadows.
import * as THREE from "three";
import { groundMaterial } from "../view/materials";

export function ground(): THREE.InstancedMesh {
    const floor = new THREE.InstancedMesh(new THREE.PlaneGeometry(400, 400).rotateX(-Math.PI / 2), groundMaterial(), 1);
    floor.setMatrixAt(0, new THREE.Matrix4());
    floor.receiveShadow = true;
    floor.frustumCulled = false;
    return floor;
}
