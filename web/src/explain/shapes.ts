// A shape in the hand: its kind and numbers, where it is and how it is turned, in the words of `lendulet explain`.
import * as THREE from "three";

// Names of the numbers of each kind; half extents, half heights and radii are in metres.
export const kinds: Record<string, { title: string; numbers: string[]; usual: number[] }> = {
    box: { title: "box", numbers: ["half x", "half y", "half z"], usual: [0.5, 0.4, 0.3] },
    sphere: { title: "sphere", numbers: ["radius"], usual: [0.45] },
    capsule: { title: "capsule", numbers: ["half height", "radius"], usual: [0.4, 0.25] },
    cylinder: { title: "cylinder", numbers: ["half height", "radius"], usual: [0.4, 0.4] },
    cone: { title: "cone", numbers: ["half height", "radius"], usual: [0.5, 0.45] },
    "tapered-capsule": {
        title: "tapered capsule", numbers: ["half height", "radius", "radius"], usual: [0.4, 0.3, 0.15],
    },
    hull: { title: "hull", numbers: ["points", "radius"], usual: [20, 0.55] },
};

const degrees = 180 / Math.PI;
const short = (values: number[]) => values.map((v) => String(Number(v.toFixed(3)) + 0)).join(",");

export class HeldShape {
    kind = "box";
    numbers: number[] = [...kinds.box.usual];
    readonly position = new THREE.Vector3();
    readonly turn = new THREE.Quaternion();

    // KIND:NUMBERS@X,Y,Z@RX,RY,RZ; false, and nothing has changed, where it is nothing of the sort.
    read(text: string): boolean {
        const [solid, place = "0,0,0", turn = "0,0,0", ...rest] = text.split("@"), [kind, list] = solid.split(":");
        const lists = [list ?? "", place, turn].map((part) => part.split(",").map(Number));
        const known = Object.hasOwn(kinds, kind) && lists[0].length === kinds[kind].numbers.length;
        const good = lists.flat().every(Number.isFinite) && lists[1].length === 3 && lists[2].length === 3;
        if (!known || !good || rest.length > 0) return false;
        this.kind = kind;
        this.numbers = lists[0];
        this.position.fromArray(lists[1]);
        const axis = new THREE.Vector3().fromArray(lists[2]), angle = axis.length();
        this.turn.setFromAxisAngle(angle > 0 ? axis.divideScalar(angle) : axis.set(1, 0, 0), angle / degrees);
        return true;
    }
    become(kind: string): void {
        this.kind = kind;
        this.numbers = [...kinds[kind].usual];
    }
    get text(): string {
        const { x, y, z, w } = this.turn, sign = w < 0 ? -1 : 1, sine = Math.hypot(x, y, z);
        const angle = 2 * Math.atan2(sine, Math.abs(w)) * degrees, scale = sine > 1e-9 ? (sign * angle) / sine : 0;
        const place = short(this.position.toArray()), turn = short([scale * x, scale * y, scale * z]), none = "0,0,0";
        const parts = [`${this.kind}:${short(this.numbers)}`, place, turn];
        return parts.slice(0, turn !== none ? 3 : place !== none ? 2 : 1).join("@");
    }
    get matrix(): THREE.Matrix4 {
        return new THREE.Matrix4().compose(this.position, this.turn, new THREE.Vector3(1, 1, 1));
    }
}
