// The broad phases beside each other: a fork of the world for each, which all make the same steps and give the same
// bits; what differs is the time that finding pairs takes.
import { type Command, Refused, type World } from "./engine/types";
import type { Companions, Player } from "./player";

export interface Row {
    name: string;
    time: number; // ms of a step, a mean
    same: boolean; // the bits are the world's
}

const firstFork = 2; // of number 1 is the other future
const fewest = 90;    // steps whose mean is shown; clocks of browsers are coarse
const far = 4;        // times of the mean, beyond which a step was interrupted

export class Comparison implements Companions {
    private lanes: { name: string; world: World; time: number; steps: number }[] = [];

    // `names`: broad phases; `stage`: the number of theirs among the stages of a step.
    constructor(private readonly player: Player, private readonly names: string[], private readonly stage: number) {}

    get on(): boolean {
        return this.lanes.length > 0;
    }
    start(): void {
        this.stop();
        this.player.resume();
        this.fork();
        this.player.companions = this;
    }
    stop(): void {
        this.player.companions = null;
        this.leave();
    }
    private fork(): void {
        this.names.forEach((name, broadPhase) => {
            const world = this.player.world.fork(firstFork + broadPhase);
            if (!world) throw new Refused("A recording has nothing left to find.");
            world.failed = () => undefined; // the world's own sentence is enough
            world.change({ do: "set", broadPhase });
            this.lanes.push({ name, world, time: 0, steps: 0 });
        });
    }
    private leave(): void {
        for (const { world } of this.lanes) world.destroy();
        this.lanes = [];
    }

    run(steps: number): void {
        for (const lane of this.lanes) {
            lane.world.run(steps);
            const time = lane.world.statistics()?.stages[this.stage] ?? 0;
            const most = lane.steps > fewest ? far * lane.time + 0.1 : Infinity;
            lane.time += (Math.min(time, most) - lane.time) / Math.min(++lane.steps, fewest);
        }
    }
    change(command: Command): void {
        // Each keeps its broad phase.
        const { broadPhase: _, ...rest } = command as Command & { broadPhase?: number };
        for (const { world } of this.lanes) world.change(rest as Command);
    }
    jumped(): void {
        if (!this.on) return;
        const old = this.lanes.map(({ time, steps }) => ({ time, steps }));
        this.leave();
        this.fork();
        this.lanes.forEach((lane, i) => Object.assign(lane, old[i]));
    }

    rows(): Row[] {
        const { hash } = this.player.world;
        return this.lanes.map(({ name, world, time }) => ({ name, time, same: world.hash === hash }));
    }
}
