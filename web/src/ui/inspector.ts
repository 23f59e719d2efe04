// What is known of the picked body, and how its kinetic energy went over the last seconds.
import { BodyType, JointType, type World } from "../engine/types";
import { amount, element, Pairs, triple } from "./dom";

const seconds = 4;
const length = (v: readonly number[]) => Math.hypot(v[0], v[1], v[2]);

export class Inspector {
    body: number | null = null;
    private readonly pairs = new Pairs(element("body-numbers"));
    private readonly plot = element<HTMLCanvasElement>("plot");
    private samples: { time: number; energy: number }[] = [];

    pick(body: number | null): void {
        if (body !== this.body) this.samples = [];
        this.body = body;
        element("nothing").hidden = body !== null;
        element("picked").hidden = body === null;
    }

    // After every step; times that run backwards begin the plot anew.
    sample(world: World): void {
        const state = this.body !== null ? world.body(this.body) : null;
        if (!state) return;
        const time = world.time, last = this.samples[this.samples.length - 1];
        if (last && time < last.time) this.samples = [];
        if (!last || time !== last.time) this.samples.push({ time, energy: state.kineticEnergy });
        while (this.samples.length > 0 && this.samples[0].time < time - seconds) this.samples.shift();
    }

    // False where the body is gone.
    show(world: World): boolean {
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
        this.draw();
        return true;
    }

    // The joints of the body: what they are, where they stand between their limits, and the load on them.
    private showJoints(world: World): void {
        const list = element("body-joints"), lines: string[] = [];
        const joints = world.statistics()?.joints ? world.joints() : [];
        for (const j of joints) {
            if (j.bodyA !== this.body && j.bodyB !== this.body) continue;
            const degrees = (v: number) => `${((180 * v) / Math.PI).toFixed(0)}°`;
            const limited = j.limit[0] < j.limit[1];
            let text = JointType[j.type];
            if (j.type === JointType.hinge) {
                text += ` ${degrees(j.value)}`;
                if (limited) text += ` (${degrees(j.limit[0])} to ${degrees(j.limit[1])})`;
                text += `, ${amount(j.velocity, "rad/s")}`;
            } else if (j.type === JointType.slider) {
                text += ` ${amount(j.value, "m")}`;
                if (limited) text += ` (${j.limit[0].toFixed(2)} to ${j.limit[1].toFixed(2)})`;
            }
            lines.push(`${text}, ${amount(length(j.force), "N")}`);
            if (lines.length === 12) break;
        }
        const text = lines.join("\n");
        if (list.textContent !== text) list.textContent = text;
        element("joints-title").hidden = lines.length === 0;
    }

    private draw(): void {
        const ratio = window.devicePixelRatio, box = this.plot.getBoundingClientRect();
        if (box.width === 0) return;
        this.plot.width = box.width * ratio;
        this.plot.height = box.height * ratio;
        const pen = this.plot.getContext("2d")!;
        pen.scale(ratio, ratio);
        const style = getComputedStyle(document.documentElement);
        const most = Math.max(...this.samples.map((s) => s.energy), 1e-9);
        element("plot-most").textContent = this.samples.length > 1 ? `most ${amount(most, "J")}` : "";
        if (this.samples.length < 2) return;
        const end = this.samples[this.samples.length - 1].time;
        pen.beginPath();
        this.samples.forEach(({ time, energy }, i) => {
            const x = box.width * (1 - (end - time) / seconds), y = box.height - 2 - (box.height - 6) * (energy / most);
            if (i === 0) pen.moveTo(x, y);
            else pen.lineTo(x, y);
        });
        pen.strokeStyle = style.getPropertyValue("--accent");
        pen.lineWidth = 1.6;
        pen.lineJoin = "round";
        pen.stroke();
    }
}
