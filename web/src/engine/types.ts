// What the viewer knows of a world, wherever it is computed: in the page (engine.ts), by the native engine behind a
// stream (stream.ts), or long ago (recording.ts).

export type Vec3 = readonly [number, number, number];

export const poseStride = 8;    // floats: position, speed (-1: asleep), orientation x y z w
// Words: position, separation, normal, normal impulse, all floats; bodies A and B, manifold; friction impulse, a float.
export const contactStride = 12;
export const boxStride = 8;     // words: lower 3f, depth i, upper 3f, leaf i
export const groupStride = 2;   // ints: island, colour
export const motionStride = 12; // floats: centre, mass, momentum, kinetic energy, angular momentum, reach

export enum ShapeType {
    sphere, capsule, taperedCapsule, box, cylinder, taperedCylinder, cone, hull, plane, mesh, heightField,
}
export enum BodyType {
    fixed, kinematic, dynamic,
}
export enum JointType {
    rigid, ball, hinge, slider,
}

export interface SceneInfo {
    name: string;
    description: string;
    size: number; // default; 0: the scene has none
}

export interface Collider {
    body: number; // index into the poses
    type: ShapeType;
    mesh: number;
    trigger: boolean;
    size: number[];
    rounding: number;
    position: number[];
    orientation: number[];
    bodyType: BodyType;
}

export interface Surface {
    vertices: Float32Array;
    indices: Uint32Array;
}

// All that is to be drawn, and what bodies are called.
export interface Shapes {
    bodies: number;
    colliders: Collider[];
    surface: (mesh: number) => Surface;
    name: (body: number) => string;
}

export interface BodyState {
    position: Vec3;
    centreOfMass: Vec3;
    velocity: Vec3;
    angularVelocity: Vec3;
    momentum: Vec3;
    angularMomentum: Vec3;
    mass: number;
    kineticEnergy: number;
    potentialEnergy: number;
    type: BodyType;
    asleep: boolean;
    name: string;
}

export interface Statistics {
    stages: number[]; // ms
    total: number;    // ms
    kineticEnergy: number;
    potentialEnergy: number;
    momentum: number[];
    angularMomentum: number[];
    bodies: number;
    awake: number;
    joints: number;
    pairs: number;
    manifolds: number;
    contacts: number;
    colours: number;
    penetration: number; // m
}

export interface JointInfo {
    bodyA: number;
    bodyB: number;
    type: JointType;
    position: Vec3; // of the frame on A, in the world
    orientation: number[];
    positionB: Vec3;
    orientationB: number[];
    value: number; // rad or m
    velocity: number;
    limit: [number, number]; // lower > upper: free
    swing: number;
    twist: [number, number];
    force: Vec3;
    torque: Vec3;
}

export interface Settings {
    gravity: Vec3;
    stepSize: number;
    solverSteps: number;
    broadPhase: number;
    simplex: number;
    integrator: number;
    workers: number;
    width: number;
    sleep: number;
    continuous: number;
    friction: number;
    restitution: number;
    rigidSpeed: number;
    staticSpeed: number;
}

// A change of a world, as it goes over a stream and into repro files. Bodies are named by their index.
export type Command =
    | { do: "sphere"; radius: number; at: Vec3; velocity: Vec3; density: number }
    | { do: "box"; half: Vec3; at: Vec3; velocity: Vec3; density: number }
    | { do: "shape"; type: ShapeType; size: number[]; rounding: number; at: Vec3; velocity: Vec3; density: number }
    | { do: "grab"; body: number; point: Vec3 }
    | { do: "drag"; target: Vec3 }
    | { do: "release" }
    | ({ do: "set" } & Partial<Settings>);

// A state to go back to: its bytes, or a key under which somebody else has them.
export interface Kept {
    bytes: number;
    data?: Uint8Array;
    key?: number;
    settings: Settings | null;
}

export interface Hit {
    body: number;
    point: Vec3;
}

// A call that was refused, with its sentence.
export class Refused extends Error {}

// The glTF file that a world comes from, which may show more than what collides.
export interface Looks {
    bytes: () => Promise<Uint8Array<ArrayBuffer>>;
    folder: string; // address of the files beside it, "" where it has none
    bodies: Map<number, number>; // the body of each node that is one
}

// State is that after the last step that has arrived: at once in the page, later over a stream. Lists may be views of
// memory that hold until the next call; what has not arrived yet is empty.
export interface World {
    readonly kind: "page" | "native" | "recording";
    readonly stepSize: number; // s
    readonly time: number;
    readonly stepCount: number;
    readonly looks?: Looks;
    readonly threads?: number; // that make its steps, where they are the page's
    readonly hash: string; // sixteen hexadecimal digits, as `lendulet run` prints them; "" where it is not known
    readonly busy: boolean; // something that was asked for is still to come
    readonly ahead: number; // steps among it: what is done now is done after them
    arrived: (steps: number) => void; // the state is another one, by so many steps
    failed: (sentence: string) => void;

    run(steps: number): void;
    change(command: Command): void;
    keep(): Kept;
    go(kept: Kept): void;
    forget(kept: Kept[]): void;
    fork(number: number): World | null; // numbers of forks that are there at the same time differ, 1 to 9
    destroy(): void;

    poses(): Float32Array;
    shapes(): Shapes;
    body(index: number): BodyState | null;
    statistics(): Statistics | null;
    settings(): Settings | null;
    contacts(): Float32Array;
    joints(): JointInfo[];
    boxes(): Float32Array;
    groups(): Int32Array;
    motions(): Float32Array;
    grabbed(): Vec3 | null;
    // Undefined: this world cannot tell, the picture may.
    castRay(origin: Vec3, translation: Vec3): Hit | null | undefined;

    // Recordings: how many steps there are, and the way to one of them.
    readonly length?: number;
    seek?(step: number): void;
}
