// The line of time, the clock, and whether time goes on.
import type { Player } from "../player";
import { element } from "./dom";

export function showTime(player: Player): void {
    const { moment, timeline: [last, at] } = player, timeline = element<HTMLInputElement>("timeline");
    timeline.max = String(last);
    timeline.value = String(at);
    const time = moment ? moment.time : player.world.time;
    element("clock").textContent = `${time.toFixed(2)} s`;
    timeline.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
    element("transport").toggleAttribute("data-playing", player.playing);
    element("play").setAttribute("aria-label", player.playing ? "Pause (space)" : "Play (space)");
}
