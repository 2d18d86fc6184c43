// @ts-check
/** Solids in a canvas, by WebGL: shaded by two lights, the creases of their surfaces sharp. */

import { CORNER, cornersOf, pulled, reachOf } from "../model/solids.js";

/** @typedef {import("../model/solids.js").Solid} Solid */
/** @typedef {import("../model/solids.js").Look} Look */

const VERTEX = `
attribute vec3 place;
attribute vec3 direction;
uniform vec3 right, up, toward, shift, size;
uniform vec2 pan;
varying vec3 normal;
void main() {
    vec3 at = place + shift;
    normal = vec3(dot(right, direction), dot(up, direction), dot(toward, direction));
    gl_Position = vec4(vec2(dot(right, at), dot(up, at)) * size.xy + pan, -dot(toward, at) * size.z, 1.0);
}
`;

/** The light is where one looks from: a strong one from the left and above, a weak one from the right. */
const FRAGMENT = `
precision mediump float;
uniform vec3 colour;
varying vec3 normal;
void main() {
    vec3 n = normalize(normal);
    float strong = max(dot(n, vec3(-0.499, 0.333, 0.8)), 0.0);
    float weak = max(dot(n, vec3(0.857, -0.171, 0.486)), 0.0);
    gl_FragColor = vec4(min(colour * (0.38 + 0.63 * strong + 0.2 * weak), 1.0), 1.0);
}
`;

/** @param {string} colour "#rrggbb" */
const partsOf = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16) / 255);

export class SolidPainter {
    #gl;
    /** @type {{program: WebGLProgram, at: Record<string, any>, place: number, direction: number} | null} null while the context is lost */
    #made = null;
    /** @type {Solid | null} */
    #solid = null;
    /** @type {{buffer: WebGLBuffer | null, count: number, colour: number[], middle: import("../model/solids.js").Vector}[]} */
    #pieces = [];
    #reached = { apart: -1, reach: reachOf([], 0) };

    /**
     * Null where the canvas has no context of WebGL.
     * @param {HTMLCanvasElement} canvas
     * @param {() => void} restored what is to be done when a lost context has come back
     */
    static of(canvas, restored) {
        const options = { antialias: true, alpha: true };
        const gl = /** @type {WebGLRenderingContext | null} */ (
            canvas.getContext("webgl2", options) ?? canvas.getContext("webgl", options)
        );
        return gl && new SolidPainter(gl, canvas, restored);
    }

    /** @param {WebGLRenderingContext} gl @param {HTMLCanvasElement} canvas @param {() => void} restored */
    constructor(gl, canvas, restored) {
        this.#gl = gl;
        this.#begin();
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault(); // or it would never be restored
            this.#made = null;
        });
        canvas.addEventListener("webglcontextrestored", () => {
            this.#begin();
            this.#pieces = []; // their buffers went with the context
            this.show(this.#solid);
            restored();
        });
    }

    /** Make what does not depend on solids. */
    #begin() {
        const gl = this.#gl;
        const program = gl.createProgram();
        for (const [kind, text] of /** @type {const} */ ([
            [gl.VERTEX_SHADER, VERTEX],
            [gl.FRAGMENT_SHADER, FRAGMENT],
        ])) {
            const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
            throw new Error(`WebGL: ${gl.getProgramInfoLog(program)}`);
        }
        const names = ["right", "up", "toward", "shift", "size", "pan", "colour"];
        this.#made = {
            program,
            at: Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)])),
            place: gl.getAttribLocation(program, "place"),
            direction: gl.getAttribLocation(program, "direction"),
        };
        gl.enable(gl.DEPTH_TEST);
        gl.enable(gl.CULL_FACE);
        gl.clearColor(0, 0, 0, 0);
    }

    /** Take another solid, or none. @param {Solid | null} solid */
    show(solid) {
        const gl = this.#gl;
        this.#pieces.forEach(({ buffer }) => gl.deleteBuffer(buffer));
        this.#solid = solid;
        this.#reached.apart = -1;
        this.#pieces = (solid?.pieces ?? []).map((piece) => {
            const buffer = gl.createBuffer();
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.bufferData(gl.ARRAY_BUFFER, cornersOf(piece), gl.STATIC_DRAW);
            const colour = partsOf(/** @type {Solid} */ (solid).colours[piece.colour]);
            return { buffer, count: piece.triangles.length, colour, middle: piece.middle };
        });
    }

    /** How far from the centre all pieces reach that are pulled apart, level and up. @param {number} apart */
    reach(apart) {
        if (this.#reached.apart !== apart) {
            this.#reached = { apart, reach: reachOf(this.#solid?.pieces ?? [], apart) };
        }
        return this.#reached.reach;
    }

    /**
     * Draw it. The canvas has the size of the drawing.
     * @param {Look} look
     * @param {number} apart the share of their distance from the centre that pieces are pulled away by
     * @param {number} ratio pixels of the canvas a pixel of CSS
     */
    paint(look, apart, ratio) {
        const [gl, made] = [this.#gl, this.#made];
        if (!made) {
            return;
        }
        const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
        gl.viewport(0, 0, width, height);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        const { at, program, place, direction } = made;
        gl.useProgram(program);
        const pixels = 2 * ratio;
        look.axes.forEach((axis, k) => gl.uniform3fv(at[["right", "up", "toward"][k]], axis));
        const scale = look.scale * pixels;
        gl.uniform3f(at.size, scale / width, scale / height, 1 / (1.001 * Math.hypot(...this.reach(apart)) || 1));
        gl.uniform2f(at.pan, (look.pan[0] * pixels) / width, (look.pan[1] * pixels) / height);
        gl.enableVertexAttribArray(place);
        gl.enableVertexAttribArray(direction);
        for (const piece of this.#pieces) {
            gl.bindBuffer(gl.ARRAY_BUFFER, piece.buffer);
            gl.vertexAttribPointer(place, 3, gl.FLOAT, false, CORNER, 0);
            gl.vertexAttribPointer(direction, 3, gl.BYTE, true, CORNER, 12);
            gl.uniform3fv(at.shift, pulled(piece, apart));
            gl.uniform3fv(at.colour, piece.colour);
            gl.drawArrays(gl.TRIANGLES, 0, piece.count);
        }
    }
}
