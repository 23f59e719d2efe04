// The sentence over the scene's lower edge.
import { element } from "./dom";

const seconds = 6;
let quiet = 0;

// `stays`: until something else is said.
export function say(sentence: string, stays = false): void {
    const message = element("message");
    message.textContent = sentence;
    message.hidden = false;
    clearTimeout(quiet);
    if (!stays) quiet = window.setTimeout(() => (message.hidden = true), 1000 * seconds);
}
