// What a glTF file shows of its nodes, with its materials and textures, drawn where their bodies are; the shapes that
// collide are then not drawn for those bodies.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { type Looks, poseStride } from "../engine/types";
import type { Bodies } from "./bodies";

export class Visuals {
    readonly group = new THREE.Group();
    readonly parts = new Map<number, THREE.Group>(); // by body

    static async read({ bytes, folder, bodies }: Looks): Promise<Visuals> {
        const { scene, parser } = await new GLTFLoader().parseAsync((await bytes()).slice().buffer, folder);
        const visuals = new Visuals(), nodeOf = (object: THREE.Object3D) => parser.associations.get(object)?.nodes;
        scene.updateMatrixWorld(true);
        // The first object of each body is the node that is the body.
        const frames = new Map<number, THREE.Matrix4>();
        scene.traverse((object) => {
            const node = nodeOf(object), body = node === undefined ? undefined : bodies.get(node);
            if (body === undefined || frames.has(body)) return;
            const position = new THREE.Vector3(), turn = new THREE.Quaternion();
            object.matrixWorld.decompose(position, turn, new THREE.Vector3());
            frames.set(body, new THREE.Matrix4().compose(position, turn, new THREE.Vector3(1, 1, 1)).invert());
        });
        const meshes: THREE.Mesh[] = [];
        scene.traverse((object) => object instanceof THREE.Mesh && meshes.push(object));
        for (const mesh of meshes) {
            let at: THREE.Object3D | null = mesh;
            while (at && (nodeOf(at) === undefined || !bodies.has(nodeOf(at)!))) at = at.parent;
            visuals.add(mesh, at ? bodies.get(nodeOf(at)!) : undefined, frames);
        }
        return visuals;
    }
    private add(mesh: THREE.Mesh, body: number | undefined, frames: Map<number, THREE.Matrix4>): void {
        const matrix = mesh.matrixWorld.clone();
        mesh.removeFromParent();
        mesh.castShadow = mesh.receiveShadow = true;
        mesh.matrixAutoUpdate = false;
        if (body === undefined) {
            mesh.matrix.copy(matrix);
            this.group.add(mesh);
            return;
        }
        mesh.matrix.copy(frames.get(body)!).multiply(matrix);
        let part = this.parts.get(body);
        if (!part) {
            part = new THREE.Group();
            part.matrixAutoUpdate = false;
            this.parts.set(body, part);
            this.group.add(part);
        }
        part.add(mesh);
    }

    place(bodies: Bodies, before: Float32Array, now: Float32Array, share: number): void {
        for (const [body, part] of this.parts) {
            part.visible = poseStride * body < now.length;
            if (!part.visible) continue;
            part.matrix.copy(bodies.pose(before, now, body, share));
            part.matrixWorldNeedsUpdate = true;
        }
    }
}
