// A line of what a quantity was over the last seconds, zero among its values.
import { amount, element } from "./dom";

const seconds = 4;

export class Plot {
    private samples: { time: number; value: number }[] = [];

    constructor(private readonly canvas: HTMLCanvasElement) {}

    clear(): void {
        this.samples = [];
    }
    // Times that run backwards begin it anew.
    add(time: number, value: number): void {
        const last = this.samples[this.samples.length - 1];
        if (last && time < last.time) this.samples = [];
        if ((!last || time !== last.time) && Number.isFinite(value)) this.samples.push({ time, value });
        while (this.samples.length > 0 && this.samples[0].time < time - seconds) this.samples.shift();
    }
    get length(): number {
        return this.samples.length;
    }

    draw(unit: string): void {
        const { canvas, samples } = this, ratio = window.devicePixelRatio, box = canvas.getBoundingClientRect();
        if (box.width === 0) return;
        canvas.width = box.width * ratio;
        canvas.height = box.height * ratio;
        const pen = canvas.getContext("2d")!;
        pen.scale(ratio, ratio);
        const values = samples.map((s) => s.value), most = Math.max(...values, 0), least = Math.min(...values, 0);
        element("plot-now").textContent = values.length > 0 ? amount(values[values.length - 1], unit) : "";
        element("plot-most").textContent = values.length > 1 ? `${amount(least, unit)} to ${amount(most, unit)}` : "";
        if (samples.length < 2) return;
        const end = samples[samples.length - 1].time, height = box.height - 6, range = most - least || 1;
        const down = (value: number) => 3 + height * ((most - value) / range);
        const style = getComputedStyle(document.documentElement);
        pen.strokeStyle = style.getPropertyValue("--line");
        pen.beginPath();
        pen.moveTo(0, down(0));
        pen.lineTo(box.width, down(0));
        pen.stroke();
        pen.beginPath();
        for (const { time, value } of samples) pen.lineTo(box.width * (1 - (end - time) / seconds), down(value));
        pen.strokeStyle = style.getPropertyValue("--accent");
        pen.lineWidth = 1.6;
        pen.lineJoin = "round";
        pen.stroke();
    }
}
