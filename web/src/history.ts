// The past of a run: a snapshot and the poses every few steps, within a budget of memory. Where the budget is used up
// every second one is forgotten and the distance between them doubles.

export interface Moment {
    step: number;
    time: number; // s
    snapshot: Uint8Array;
    poses: Float32Array;
}

export class History {
    readonly moments: Moment[] = [];
    private every: number;
    private bytes = 0;

    constructor(private readonly budget: number, private readonly firstEvery = 5) {
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
        for (const moment of this.moments.splice(index + 1)) this.bytes -= sizeOf(moment);
    }
    clear(): void {
        this.moments.length = 0;
        this.bytes = 0;
        this.every = this.firstEvery;
    }

    private thin(): void {
        this.every *= 2;
        const kept = this.moments.filter((m, i) => m.step % this.every === 0 || i === this.moments.length - 1);
        this.moments.splice(0, this.moments.length, ...kept);
        this.bytes = this.moments.reduce((sum, m) => sum + sizeOf(m), 0);
    }
}

function sizeOf(moment: Moment): number {
    return moment.snapshot.byteLength + moment.poses.byteLength;
}
