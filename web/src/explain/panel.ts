// The mode's controls: what is explained, the steps, and what the two shapes are.
import { element, make } from "../ui/dom";
import { type HeldShape, kinds } from "./shapes";

// The fields of one shape; `changed` after each change.
export class ShapeFields {
    private readonly select = make("select");
    private readonly inputs = make("span", "", { class: "numbers" });
    private shown = "";

    constructor(
        private readonly letter: string, private readonly shape: HeldShape, private readonly changed: () => void,
    ) {
        const box = element(`explain-${letter.toLowerCase()}`);
        for (const [kind, { title }] of Object.entries(kinds))
            this.select.append(make("option", title, { value: kind }));
        this.select.setAttribute("aria-label", `Kind of ${letter}`);
        this.select.addEventListener("change", () => {
            shape.become(this.select.value);
            this.follow();
            changed();
        });
        box.append(this.select, this.inputs);
        this.follow();
    }
    // Shows what the shape is now.
    follow(): void {
        const { kind, numbers } = this.shape;
        this.select.value = kind;
        if (this.shown !== kind) this.build(kind);
        [...this.inputs.querySelectorAll("input")].forEach((input, i) => {
            if (input !== document.activeElement) input.value = String(numbers[i]);
        });
    }
    private build(kind: string): void {
        this.shown = kind;
        this.inputs.replaceChildren(...kinds[kind].numbers.map((name, i) => {
            const step = name === "points" ? "1" : "0.05";
            const input = make("input", "", { type: "number", inputmode: "decimal", step });
            input.setAttribute("aria-label", `${this.letter}: ${name}`);
            input.title = name;
            input.addEventListener("change", () => {
                const value = Number(input.value);
                if (input.value !== "" && Number.isFinite(value)) this.shape.numbers[i] = value;
                input.value = String(this.shape.numbers[i]);
                this.changed();
            });
            return input;
        }));
    }
}

// One of several buttons is pressed: those in `box`, by their data-value.
export class Choice {
    private readonly buttons: HTMLButtonElement[];
    constructor(box: HTMLElement, chosen: (value: string) => void) {
        this.buttons = [...box.querySelectorAll("button")];
        for (const button of this.buttons)
            button.addEventListener("click", () => {
                this.show(button.dataset.value!);
                chosen(button.dataset.value!);
            });
    }
    show(value: string): void {
        for (const button of this.buttons)
            button.setAttribute("aria-pressed", String(button.dataset.value === value));
    }
}
