// A world of the native engine behind a WebSocket (`lendulet view`). The page asks, the engine answers with what the
// page wants to show, and only then is it asked again: see apps/lendulet/view/session.h for what goes over the wire.
import { type Question, type Sequence, sequenceAt } from "../explain/sequence";
import { bodyAt, bytesOf, collidersAt, hashText, jointsAt, settingsAt, statisticsAt, vectorAt } from "./decode";
import { fileBytes } from "./module";
import {
    type BodyState, type Collider, type Command, type Hit, type JointInfo, type Kept, type Looks, poseStride, Refused,
    type SceneInfo, type Settings, type Shapes, type Statistics, type Surface, type Vec3, type World,
} from "./types";

const magic = 0x56444e4c;
const lookFor = 1000; // ms for which something that was asked for is sent with every answer

enum Section {
    error = 1, state, poses, bodies, colliders, mesh, contacts, statistics, body, grab, joints, boxes, groups, motions,
    settings, names, lists, explain, nodes,
}

interface Asked {
    id?: number;
    open?: string;
    world?: number;
    do?: (Command | { do: "fork" | "join"; to: number })[];
    steps?: number;
    keep?: number;
    go?: number;
    forget?: number[];
    body?: number;
    explain?: Question;
    want?: string[];
}
type Sections = Map<Section, [at: number, bytes: number][]>;
type Answer = { buffer: ArrayBuffer; sections: Sections };

// What there is to choose from.
export interface Catalogue {
    scenes: SceneInfo[];
    stages: string[];
    choices: string[][]; // broad phases, simplex solvers, integrators
}

export class Connection {
    lost: () => void = () => undefined;
    private readonly waiting: ((answer: Answer) => void)[] = [];
    private constructor(private readonly socket: WebSocket) {
        socket.binaryType = "arraybuffer";
        socket.addEventListener("message", (event) => this.take(event.data as ArrayBuffer));
        socket.addEventListener("close", () => this.lost());
    }
    static open(address: string): Promise<Connection> {
        const socket = new WebSocket(address);
        return new Promise((done, fail) => {
            socket.addEventListener("open", () => done(new Connection(socket)), { once: true });
            const refused = () => fail(new Error("the native engine does not answer"));
            socket.addEventListener("error", refused, { once: true });
        });
    }
    get isOpen(): boolean {
        return this.socket.readyState === WebSocket.OPEN;
    }
    close(): void {
        this.lost = () => undefined;
        this.socket.close();
    }
    // Answers come in the order of what was asked.
    ask(asked: Asked, answered: (answer: Answer) => void): void {
        if (!this.isOpen) return;
        this.waiting.push(answered);
        this.socket.send(JSON.stringify(asked));
    }
    catalogue(): Promise<Catalogue> {
        return new Promise((done) => this.ask({ want: ["lists"] }, ({ buffer, sections }) => {
            const [at, bytes] = sections.get(Section.lists)![0];
            done(JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, at, bytes))) as Catalogue);
        }));
    }
    explain(question: Question): Promise<Sequence> {
        return new Promise((done, fail) => this.ask({ explain: question }, ({ buffer, sections }) => {
            const [error] = sections.get(Section.error) ?? [], [made] = sections.get(Section.explain) ?? [];
            if (made) done(sequenceAt(buffer, made[0]));
            else fail(new Refused(new TextDecoder().decode(new Uint8Array(buffer, ...error))));
        }));
    }
    private take(buffer: ArrayBuffer): void {
        const view = new DataView(buffer), sections: Sections = new Map();
        if (view.getUint32(0, true) !== magic) return this.socket.close();
        for (let at = 8; at + 8 <= buffer.byteLength; ) {
            const kind = view.getUint32(at, true), bytes = view.getUint32(at + 4, true);
            sections.set(kind, [...(sections.get(kind) ?? []), [at + 8, bytes]]);
            at += 8 + Math.ceil(bytes / 8) * 8;
        }
        this.waiting.shift()?.({ buffer, sections });
    }
}

export class StreamWorld implements World {
    readonly kind = "native";
    stepSize = 1 / 60;
    time = 0;
    stepCount = 0;
    arrived: (steps: number) => void = () => undefined;
    failed: (sentence: string) => void = () => undefined;
    ahead = 0;
    private pending = 0;
    private commands: Command[] = [];
    private latest: Asked = {};
    private readonly wanted = new Map<string, number>(); // until when, by name
    private hashNow = "";
    private bodyIndex = 0;
    private held = { poses: new Float32Array(), contacts: new Float32Array(), boxes: new Float32Array(),
        motions: new Float32Array(), groups: new Int32Array() };
    private colliders: Collider[] = [];
    private bodies = -1; // that the colliders are of
    private readonly surfaces = new Map<number, Surface>();
    private names = new Map<number, string>();
    private jointList: JointInfo[] = [];
    private figures: Statistics | null = null;
    private set: Settings | null = null;
    private bodyState: BodyState | null = null;
    private grip: Vec3 | null = null;
    private nextKey = 1;
    looks?: Looks;

    private constructor(private readonly connection: Connection, private readonly which: number) {}

    // The scene of this name; "" is that of the command line, `file`: the address of the glTF file that it is of.
    // Rejects with the engine's sentence.
    static open(connection: Connection, scene: string, file: string | null): Promise<StreamWorld> {
        const world = new StreamWorld(connection, 0);
        return new Promise((done, fail) => {
            world.failed = (sentence) => fail(new Error(sentence));
            world.arrived = () => done(world);
            if (file !== null) world.looks = { bytes: () => fileBytes(file), folder: `${file}/`, bodies: new Map() };
            world.ask({ open: scene, want: ["shapes", "statistics", "settings", ...(file ? ["nodes"] : [])] }, 0);
        });
    }
    destroy(): void {
        if (this.which > 0) this.connection.ask({ do: [{ do: "join", to: this.which }] }, () => undefined);
    }

    get busy(): boolean {
        return this.pending > 0;
    }
    run(steps: number): void {
        this.ask({ steps }, steps);
    }
    // Goes at once where nothing is on its way, else with what comes next.
    change(command: Command): void {
        const last = this.commands[this.commands.length - 1];
        if (command.do === "drag" && last?.do === "drag") this.commands.pop();
        this.commands.push(command);
        if (this.pending === 0) this.ask({}, 0);
    }
    keep(): Kept {
        const key = this.nextKey++;
        this.connection.ask({ world: this.which, keep: key }, (answer) => this.complain(answer));
        return { key, bytes: 45 * this.held.poses.length, settings: this.set };
    }
    go(kept: Kept): void {
        this.ask({ go: kept.key }, 0);
    }
    forget(kept: Kept[]): void {
        const forget = kept.flatMap(({ key }) => (key === undefined ? [] : [key]));
        if (forget.length > 0) this.connection.ask({ world: this.which, forget }, () => undefined);
    }
    fork(number: number): World {
        this.connection.ask({ do: [{ do: "fork", to: number }] }, (answer) => this.complain(answer));
        const twin = new StreamWorld(this.connection, number);
        twin.ask({ want: ["shapes"] }, 0);
        return twin;
    }

    // --- asking and being answered

    private ask(asked: Asked, steps: number): void {
        if (!this.connection.isOpen) return this.failed("The native engine is gone.");
        const now = performance.now();
        const want = new Set(["poses", ...(asked.want ?? [])]);
        for (const [name, until] of this.wanted) if (until > now) want.add(name);
        const message: Asked = {
            ...asked, world: this.which, want: [...want], body: this.bodyIndex, do: this.commands,
        };
        this.commands = [];
        this.latest = message;
        ++this.pending;
        this.ahead += asked.steps ?? 0;
        this.connection.ask(message, (answer) => {
            --this.pending;
            this.ahead -= asked.steps ?? 0;
            this.read(answer);
            const failed = this.complain(answer);
            // Bodies came or went: what they look like is asked for before anybody draws them.
            if (this.held.poses.length / poseStride !== this.bodies && !failed) {
                this.ask({ want: ["shapes"] }, steps);
                return;
            }
            this.arrived(steps);
            if (this.commands.length > 0 && this.pending === 0) this.ask({}, 0);
        });
    }
    private complain({ buffer, sections }: Answer): boolean {
        const errors = sections.get(Section.error) ?? [];
        for (const [at, bytes] of errors) this.failed(new TextDecoder().decode(new Uint8Array(buffer, at, bytes)));
        return errors.length > 0;
    }
    private read({ buffer, sections }: Answer): void {
        const first = (kind: Section) => sections.get(kind)?.[0];
        const floats = (kind: Section, old: Float32Array<ArrayBuffer>) => {
            const found = first(kind);
            return found ? new Float32Array(buffer, found[0], found[1] / 4) : old;
        };
        const state = first(Section.state);
        if (state) {
            const view = new DataView(buffer, state[0], state[1]);
            this.time = view.getFloat64(0, true);
            this.stepCount = Number(view.getBigUint64(8, true));
            const hash = view.getBigUint64(16, true);
            if (hash !== 0n) this.hashNow = hashText(hash);
            else if (this.latest.want?.includes("hash") !== true) this.hashNow = "";
            this.stepSize = view.getFloat32(24, true);
        }
        this.held.poses = floats(Section.poses, this.held.poses);
        this.held.contacts = floats(Section.contacts, this.held.contacts);
        this.held.boxes = floats(Section.boxes, this.held.boxes);
        this.held.motions = floats(Section.motions, this.held.motions);
        const groups = first(Section.groups), joints = first(Section.joints), figures = first(Section.statistics);
        if (groups) this.held.groups = new Int32Array(buffer, groups[0], groups[1] / 4);
        if (joints) this.jointList = jointsAt(buffer, joints[0], joints[1] / bytesOf.joint);
        if (figures) this.figures = statisticsAt(buffer, figures[0]);
        const settings = first(Section.settings), body = first(Section.body), grip = first(Section.grab);
        if (settings) this.set = settingsAt(buffer, settings[0]);
        if (body) this.bodyState = bodyAt(buffer, body[0]);
        if (grip) this.grip = grip[1] > 0 ? vectorAt(buffer, grip[0]) : null;
        for (const [at, bytes] of sections.get(Section.nodes) ?? []) {
            const pairs = new Int32Array(buffer, at, bytes / 4);
            for (let i = 0; i < pairs.length; i += 2) this.looks?.bodies.set(pairs[i], pairs[i + 1]);
        }
        const colliders = first(Section.colliders);
        if (colliders) this.readShapes(buffer, sections, colliders);
    }
    private readShapes(buffer: ArrayBuffer, sections: Sections, colliders: [number, number]): void {
        this.colliders = collidersAt(buffer, colliders[0], colliders[1] / bytesOf.collider);
        this.bodies = sections.get(Section.bodies)![0][1] / 8;
        this.surfaces.clear();
        for (const [at] of sections.get(Section.mesh) ?? []) {
            const [number, vertices, triangles] = new Uint32Array(buffer, at, 4);
            this.surfaces.set(number, {
                vertices: new Float32Array(buffer, at + 16, 3 * vertices),
                indices: new Uint32Array(buffer, at + 16 + 12 * vertices, 3 * triangles),
            });
        }
        this.names = new Map();
        for (const [begin, bytes] of sections.get(Section.names) ?? [])
            for (let at = begin; at < begin + bytes; ) {
                const [index, size] = new Uint32Array(buffer, at, 2);
                this.names.set(index, new TextDecoder().decode(new Uint8Array(buffer, at + 8, size)));
                at += 8 + Math.ceil(size / 4) * 4;
            }
    }

    // --- what is shown: asked for now, it comes with the answers of the next second

    private look(name: string): void {
        const known = (this.wanted.get(name) ?? 0) > performance.now();
        this.wanted.set(name, performance.now() + lookFor);
        if (!known && this.pending === 0) queueMicrotask(() => this.pending === 0 && this.ask({}, 0));
    }
    get hash(): string {
        this.look("hash");
        return this.hashNow;
    }
    poses(): Float32Array {
        return this.held.poses;
    }
    contacts(): Float32Array {
        return this.look("contacts"), this.held.contacts;
    }
    boxes(): Float32Array {
        return this.look("boxes"), this.held.boxes;
    }
    motions(): Float32Array {
        return this.look("motions"), this.held.motions;
    }
    groups(): Int32Array {
        return this.look("groups"), this.held.groups;
    }
    joints(): JointInfo[] {
        return this.look("joints"), this.jointList;
    }
    statistics(): Statistics | null {
        return this.look("statistics"), this.figures;
    }
    settings(): Settings | null {
        return this.look("settings"), this.set;
    }
    grabbed(): Vec3 | null {
        return this.look("grab"), this.grip;
    }
    body(index: number): BodyState | null {
        if (index !== this.bodyIndex) {
            this.bodyState = null;
            this.wanted.delete("body");
        }
        this.bodyIndex = index;
        this.look("body");
        return this.bodyState;
    }
    shapes(): Shapes {
        return {
            bodies: this.bodies, colliders: this.colliders,
            surface: (mesh) => this.surfaces.get(mesh)!, name: (body) => this.names.get(body) ?? "",
        };
    }
    castRay(): Hit | null | undefined {
        return undefined;
    }
}
