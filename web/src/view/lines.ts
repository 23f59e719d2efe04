// Many lines drawn as one, made anew whenever what they show has changed.
import * as THREE from "three";

export class Lines {
    readonly mesh: THREE.LineSegments;
    private positions = new Float32Array(6 * 1024);
    private colours = new Float32Array(6 * 1024);
    private used = 0; // floats

    constructor(order: number, opacity = 1) {
        this.mesh = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
            vertexColors: true, depthTest: false, transparent: true, opacity,
        }));
        this.mesh.frustumCulled = false;
        this.mesh.renderOrder = order;
        this.mesh.visible = false;
    }
    begin(): void {
        this.used = 0;
    }
    add(ax: number, ay: number, az: number, bx: number, by: number, bz: number, colour: THREE.Color): void {
        if (this.used + 6 > this.positions.length) this.grow();
        const { positions: p, colours: c, used: at } = this;
        p[at] = ax, p[at + 1] = ay, p[at + 2] = az, p[at + 3] = bx, p[at + 4] = by, p[at + 5] = bz;
        for (let k = 0; k < 6; k += 3) c[at + k] = colour.r, c[at + k + 1] = colour.g, c[at + k + 2] = colour.b;
        this.used += 6;
    }
    private grow(): void {
        for (const name of ["positions", "colours"] as const) {
            const wider = new Float32Array(2 * this[name].length);
            wider.set(this[name]);
            this[name] = wider;
        }
    }
    end(): void {
        const geometry = this.mesh.geometry;
        const place = geometry.getAttribute("position") as THREE.BufferAttribute | undefined;
        if (place?.array !== this.positions) {
            geometry.dispose();
            for (const [name, array] of [["position", this.positions], ["color", this.colours]] as const) {
                const attribute = new THREE.BufferAttribute(array, 3);
                attribute.setUsage(THREE.DynamicDrawUsage);
                geometry.setAttribute(name, attribute);
            }
        }
        geometry.getAttribute("position").needsUpdate = true;
        geometry.getAttribute("color").needsUpdate = true;
        geometry.setDrawRange(0, this.used / 3);
        this.mesh.visible = this.used > 0;
    }
}
