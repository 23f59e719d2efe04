// Materials: bodies in plain colours, static bodies with a grid of metres on what faces up.
import * as THREE from "three";

export const gridColour = { value: new THREE.Color(0x888888) };

export function bodyMaterial(): THREE.MeshStandardMaterial {
    return new THREE.MeshStandardMaterial({ roughness: 0.62, metalness: 0.02 });
}

export function glassMaterial(): THREE.MeshStandardMaterial {
    return new THREE.MeshStandardMaterial({
        roughness: 0.3, metalness: 0, transparent: true, opacity: 0.13, depthWrite: false, side: THREE.DoubleSide,
    });
}

// Lines every metre and every ten metres, in world coordinates, as wide as a pixel wherever they are seen; they fade
// before they would flicker.
const gridCode = `
    vec2 gridAt = worldPlace.xz;
    vec2 gridPixel = max(fwidth(gridAt), vec2(1e-6));
    float gridTen = 0.0;
    float gridOne = 0.0;
    {
        vec2 toLine = abs(fract(gridAt - 0.5) - 0.5) / gridPixel;
        float seen = clamp(1.2 - 6.0 * max(gridPixel.x, gridPixel.y), 0.0, 1.0);
        gridOne = seen * (1.0 - min(min(toLine.x, toLine.y), 1.0));
        vec2 tenPixel = gridPixel / 10.0;
        vec2 toTen = abs(fract(gridAt / 10.0 - 0.5) - 0.5) / tenPixel;
        float tenSeen = clamp(1.2 - 6.0 * max(tenPixel.x, tenPixel.y), 0.0, 1.0);
        gridTen = tenSeen * (1.0 - min(min(toTen.x, toTen.y) / 1.3, 1.0));
    }
    float gridUp = smoothstep(0.9, 0.99, worldUp);
    diffuseColor.rgb = mix(diffuseColor.rgb, gridColour, gridUp * max(0.55 * gridOne, gridTen));
`;

export function groundMaterial(): THREE.MeshStandardMaterial {
    const material = new THREE.MeshStandardMaterial({ roughness: 0.95, metalness: 0, side: THREE.DoubleSide });
    material.onBeforeCompile = (shader) => {
        shader.uniforms.gridColour = gridColour;
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", "#include <common>\nvarying vec3 worldPlace;\nvarying float worldUp;")
            .replace(
                "#include <project_vertex>",
                `#include <project_vertex>
                worldPlace = (modelMatrix * instanceMatrix * vec4(transformed, 1.0)).xyz;
                worldUp = normalize(mat3(instanceMatrix) * objectNormal).y;`,
            );
        shader.fragmentShader = shader.fragmentShader
            .replace(
                "#include <common>",
                "#include <common>\nuniform vec3 gridColour;\nvarying vec3 worldPlace;\nvarying float worldUp;",
            )
            .replace("#include <color_fragment>", `#include <color_fragment>\n${gridCode}`);
    };
    return material;
}
