// The past of a run: a kept state and the poses every few steps, within a budget of memory. Where the budget is used up
// every second one is forgotten and the distance between them doubles.
import type { Kept } from "./engine/types";

export interface Moment {
    step: number;
    time: number; // s
    kept: Kept;
    poses: Float32Array;
}

export class History {
    readonly moments: Moment[] = [];
    private every: number;
    private bytes = 0;

    constructor(
        private readonly budget: number, private readonly forget: (kept: Kept[]) => void,
        private readonly firstEvery = 5,
    ) {
        this.every = firstEvery;
    }

    wants(step: number): boolean {
        return step % this.every === 0 && (this.last?.step ?? -1) < step;
    }
    get last(): Moment | undefined {
        return this.moments[this.moments.length - 1];
    }

    add(moment: Moment): void {
        this.moments.push(moment);
        this.bytes += sizeOf(moment);
        while (this.bytes > this.budget && this.moments.length > 8) this.thin();
    }

    // Forgets what came after the moment of this index: the run goes on from there.
    cut(index: number): void {
        const gone = this.moments.splice(index + 1);
        for (const moment of gone) this.bytes -= sizeOf(moment);
        this.forget(gone.map((m) => m.kept));
    }
    // Everything, of a world that is no more.
    clear(): void {
        this.moments.length = 0;
        this.bytes = 0;
        this.every = this.firstEvery;
    }

    private thin(): void {
        this.every *= 2;
        const last = this.moments.length - 1;
        const stays = this.moments.map((m, i) => m.step % this.every === 0 || i === last);
        this.forget(this.moments.filter((_, i) => !stays[i]).map((m) => m.kept));
        this.moments.splice(0, this.moments.length, ...this.moments.filter((_, i) => stays[i]));
        this.bytes = this.moments.reduce((sum, m) => sum + sizeOf(m), 0);
    }
}

function sizeOf(moment: Moment): number {
    return moment.kept.bytes + moment.poses.byteLength;
}
