// What is known of the picked body, of one of its joints, or of the whole world, and how a quantity of it went over the
// last seconds.
import { BodyType, contactStride, type JointInfo, JointType, type World } from "../engine/types";
import { amount, element, make, Pairs, triple } from "./dom";
import { Plot } from "./plot";

const length = (v: readonly number[]) => Math.hypot(v[0], v[1], v[2]);
const degrees = (v: number) => `${((180 * v) / Math.PI).toFixed(0)}°`;

type Kind = "world" | "body" | "joint";

// Of the normal impulses of the last substep; `body`: of one body alone.
function impulse(contacts: Float32Array, body: number | null): number {
    const bodies = new Int32Array(contacts.buffer, contacts.byteOffset, contacts.length);
    let sum = 0;
    for (let at = 0; at < contacts.length; at += contactStride)
        if (body === null || bodies[at + 8] === body || bodies[at + 9] === body) sum += contacts[at + 7];
    return sum;
}

interface Subject {
    world: World;
    body: number | null;
    joint: number | null;
}
// What can be plotted, by the kind of what is looked at: a name, its unit, how it is read; NaN: it is not there.
type Quantity = [name: string, unit: string, read: (of: Subject) => number];
const ofBody = (read: (s: NonNullable<ReturnType<World["body"]>>) => number) =>
    ({ world, body }: Subject) => {
        const state = world.body(body!);
        return state ? read(state) : NaN;
    };
const ofWorld = (read: (s: NonNullable<ReturnType<World["statistics"]>>) => number) =>
    ({ world }: Subject) => {
        const figures = world.statistics();
        return figures ? read(figures) : NaN;
    };
const ofJoint = (read: (j: JointInfo) => number) =>
    ({ world, joint }: Subject) => {
        const found = world.joints()[joint!];
        return found ? read(found) : NaN;
    };
const contactImpulse: Quantity = ["contact impulse", "N s", ({ world, body }) => impulse(world.contacts(), body)];
const quantities: Record<Kind, Quantity[]> = {
    world: [
        ["kinetic energy", "J", ofWorld((s) => s.kineticEnergy)],
        ["potential energy", "J", ofWorld((s) => s.potentialEnergy)],
        ["total energy", "J", ofWorld((s) => s.kineticEnergy + s.potentialEnergy)],
        ["momentum", "kg m/s", ofWorld((s) => length(s.momentum))],
        ["angular momentum", "kg m²/s", ofWorld((s) => length(s.angularMomentum))],
        contactImpulse,
    ],
    body: [
        ["kinetic energy", "J", ofBody((s) => s.kineticEnergy)],
        ["potential energy", "J", ofBody((s) => s.potentialEnergy)],
        ["total energy", "J", ofBody((s) => s.kineticEnergy + s.potentialEnergy)],
        ["momentum", "kg m/s", ofBody((s) => length(s.momentum))],
        ["angular momentum", "kg m²/s", ofBody((s) => length(s.angularMomentum))],
        ["speed", "m/s", ofBody((s) => length(s.velocity))],
        contactImpulse,
    ],
    joint: [
        ["force", "N", ofJoint((j) => length(j.force))],
        ["torque", "N m", ofJoint((j) => length(j.torque))],
        ["position", "", ofJoint((j) => j.value)],
        ["speed", "", ofJoint((j) => j.velocity)],
    ],
};

// What it is, where it stands between its limits, and the load on it.
function sentenceOf(j: JointInfo): string {
    const limited = j.limit[0] < j.limit[1];
    let text = JointType[j.type] ?? "joint";
    if (j.type === JointType.hinge) {
        text += ` ${degrees(j.value)}`;
        if (limited) text += ` (${degrees(j.limit[0])} to ${degrees(j.limit[1])})`;
        text += `, ${amount(j.velocity, "rad/s")}`;
    } else if (j.type === JointType.slider) {
        text += ` ${amount(j.value, "m")}`;
        if (limited) text += ` (${j.limit[0].toFixed(2)} to ${j.limit[1].toFixed(2)})`;
    }
    return `${text}, ${amount(length(j.force), "N")}`;
}

export class Inspector {
    body: number | null = null;
    joint: number | null = null; // its number among the world's
    private readonly pairs = new Pairs(element("body-numbers"));
    private readonly plot = new Plot(element<HTMLCanvasElement>("plot"));
    private readonly what = element<HTMLSelectElement>("plot-what");
    private readonly chosen: Record<Kind, number> = { world: 0, body: 0, joint: 0 };
    private lines: HTMLButtonElement[] = [];

    constructor() {
        this.what.addEventListener("change", () => {
            this.chosen[this.kind] = this.what.selectedIndex;
            this.plot.clear();
        });
        this.offer();
    }
    private get kind(): Kind {
        return this.joint !== null ? "joint" : this.body !== null ? "body" : "world";
    }
    private get quantity(): Quantity {
        return quantities[this.kind][this.chosen[this.kind]];
    }
    private offer(): void {
        this.what.replaceChildren(...quantities[this.kind].map(([name]) => make("option", name)));
        this.what.selectedIndex = this.chosen[this.kind];
        element("subject").textContent = { world: "World", body: "Body", joint: "Joint" }[this.kind];
        this.plot.clear();
    }

    pick(body: number | null): void {
        if (body === this.body && this.joint === null) return;
        this.body = body;
        this.joint = null;
        this.offer();
        element("nothing").hidden = body !== null;
        element("picked").hidden = body === null;
        if (body !== null) element("inspector").scrollIntoView({ block: "nearest" });
    }
    // A joint of the picked body; again: the body.
    private pickJoint(joint: number): void {
        this.joint = joint === this.joint ? null : joint;
        this.offer();
    }

    // After every step.
    sample(world: World): void {
        const [, , read] = this.quantity;
        this.plot.add(world.time, read({ world, body: this.body, joint: this.joint }));
    }

    // False where the body is gone.
    show(world: World): boolean {
        const [, unit] = this.quantity;
        this.plot.draw(unit);
        if (this.body === null) return true;
        const s = world.body(this.body);
        if (!s) return world.kind === "native"; // it may be on its way
        const kind = ["static", "kinematic", s.asleep ? "asleep" : "awake"][s.type];
        this.pairs.set("name", s.name || "–");
        this.pairs.set("state", kind);
        this.pairs.set("mass", s.type === BodyType.dynamic ? amount(s.mass, "kg") : "∞");
        this.pairs.set("position", triple(s.centreOfMass));
        this.pairs.set("velocity", triple(s.velocity));
        this.pairs.set("speed", amount(length(s.velocity), "m/s"));
        this.pairs.set("turning", amount(length(s.angularVelocity), "rad/s"));
        this.pairs.set("momentum", amount(length(s.momentum), "kg m/s"));
        this.pairs.set("angular mom.", amount(length(s.angularMomentum), "kg m²/s"));
        this.pairs.set("kinetic en.", amount(s.kineticEnergy, "J"));
        this.pairs.set("potential en.", amount(s.potentialEnergy, "J"));
        this.showJoints(world);
        return true;
    }

    // The joints of the body, each a button that plots it.
    private showJoints(world: World): void {
        const joints = world.statistics()?.joints ? world.joints() : [];
        const own = joints.flatMap((j, i) => (j.bodyA === this.body || j.bodyB === this.body ? [i] : [])).slice(0, 12);
        while (this.lines.length < own.length) {
            const line = make("button", "", { class: "line" });
            line.addEventListener("click", () => this.pickJoint(Number(line.dataset.joint)));
            element("body-joints").append(line);
            this.lines.push(line);
        }
        this.lines.forEach((line, i) => {
            line.hidden = i >= own.length;
            if (line.hidden) return;
            const text = sentenceOf(joints[own[i]]);
            if (line.textContent !== text) line.textContent = text;
            line.dataset.joint = String(own[i]);
            line.setAttribute("aria-pressed", String(own[i] === this.joint));
        });
        element("joints-title").hidden = own.length === 0;
    }
}
