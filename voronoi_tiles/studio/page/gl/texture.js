// @ts-check
/** What the preview keeps on the graphics card: programs, tables as textures, images that are drawn into. */

import { TABLE_WIDTH, WHOLE_SCREEN } from "./shaders.js";

/** A program that fills an image, and its uniforms by name. */
export class Program {
    /**
     * Compile and link. Throws an Error with the compiler's words.
     * @param {WebGL2RenderingContext} gl
     * @param {string} fragment
     */
    constructor(gl, fragment) {
        this.gl = gl;
        const program = gl.createProgram();
        for (const [kind, text] of [
            [gl.VERTEX_SHADER, WHOLE_SCREEN],
            [gl.FRAGMENT_SHADER, fragment],
        ]) {
            const shader = /** @type {WebGLShader} */ (gl.createShader(Number(kind)));
            gl.shaderSource(shader, String(text));
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
                throw new Error(`a shader of the preview does not compile: ${gl.getShaderInfoLog(shader)}`);
            }
            gl.deleteShader(shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
            throw new Error(`a program of the preview does not link: ${gl.getProgramInfoLog(program)}`);
        }
        this.program = program;
        /** @type {Map<string, WebGLUniformLocation | null>} */
        this.places = new Map();
    }

    /**
     * Draw the whole of an image; null stands for the canvas.
     * @param {RenderTarget | null} image
     * @param {number} width Of the canvas.
     * @param {number} height
     */
    fill(image, width = 0, height = 0) {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, image && image.framebuffer);
        gl.viewport(0, 0, image ? image.width : width, image ? image.height : height);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    /** Make it the one whose uniforms are set and that draws. */
    use() {
        this.gl.useProgram(this.program);
    }

    /**
     * Set whole numbers: one, two or four.
     * @param {string} name
     * @param {number[]} values
     */
    integers(name, ...values) {
        const { gl } = this;
        if (values.length === 1) gl.uniform1i(this.#at(name), values[0]);
        else if (values.length === 2) gl.uniform2iv(this.#at(name), values);
        else gl.uniform4iv(this.#at(name), values);
    }

    /**
     * Set numbers: one to four.
     * @param {string} name
     * @param {number[]} values
     */
    numbers(name, ...values) {
        const { gl } = this;
        const at = this.#at(name);
        if (values.length === 1) gl.uniform1f(at, values[0]);
        else if (values.length === 2) gl.uniform2fv(at, values);
        else if (values.length === 3) gl.uniform3fv(at, values);
        else gl.uniform4fv(at, values);
    }

    /**
     * Bind textures to the samplers of these names.
     * @param {Record<string, {texture: WebGLTexture}>} textures
     * @param {number} [first] The unit of the first one.
     */
    textures(textures, first = 0) {
        const { gl } = this;
        Object.entries(textures).forEach(([name, { texture }], k) => {
            gl.activeTexture(gl.TEXTURE0 + first + k);
            gl.bindTexture(gl.TEXTURE_2D, texture);
            gl.uniform1i(this.#at(name), first + k);
        });
    }

    /** @param {string} name */
    #at(name) {
        let place = this.places.get(name);
        if (place === undefined) this.places.set(name, (place = this.gl.getUniformLocation(this.program, name)));
        return place;
    }
}

/** A table of records of four numbers, in rows of TABLE_WIDTH; it grows. */
export class Table {
    /**
     * @param {WebGL2RenderingContext} gl
     * @param {"integers" | "floats" | "bytes"} kind
     */
    constructor(gl, kind) {
        this.gl = gl;
        this.texture = nearestTexture(gl);
        this.rows = 0;
        this.format = {
            integers: [gl.RGBA32I, gl.RGBA_INTEGER, gl.INT],
            floats: [gl.RGBA32F, gl.RGBA, gl.FLOAT],
            bytes: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE],
        }[kind];
    }

    /**
     * Write the first `count` records.
     * @param {Int32Array | Float32Array | Uint8Array} records
     * @param {number} count Throws a RangeError where the card has no texture so large.
     */
    write(records, count) {
        const { gl } = this;
        const [internal, format, type] = this.format;
        held(gl, this.texture);
        const rows = Math.ceil(count / TABLE_WIDTH);
        if (rows > this.rows) {
            this.rows = 2 ** Math.ceil(Math.log2(rows));
            if (this.rows > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new RangeError(`${count} records are too many`);
            gl.texImage2D(gl.TEXTURE_2D, 0, internal, TABLE_WIDTH, this.rows, 0, format, type, null);
        }
        const whole = Math.floor(count / TABLE_WIDTH);
        const rest = count % TABLE_WIDTH;
        if (whole) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, TABLE_WIDTH, whole, format, type, records, 0);
        if (rest) {
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, rest, 1, format, type, records, 4 * whole * TABLE_WIDTH);
        }
    }
}

/** An image that is drawn into, of four integers or of colours. */
export class RenderTarget {
    /**
     * @param {WebGL2RenderingContext} gl
     * @param {"integers" | "colours"} kind
     */
    constructor(gl, kind) {
        this.gl = gl;
        this.kind = kind;
        this.width = 0;
        this.height = 0;
        this.texture = nearestTexture(gl);
        this.framebuffer = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
    }

    /**
     * @param {number} width
     * @param {number} height
     */
    resize(width, height) {
        const { gl } = this;
        if (width === this.width && height === this.height) return;
        [this.width, this.height] = [width, height];
        held(gl, this.texture);
        if (this.kind === "integers") {
            gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32I, width, height, 0, gl.RGBA_INTEGER, gl.INT, null);
        } else gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    }

    /**
     * Have colours read between texels, for ever repeated; with `reduced` also where texels are smaller than pixels.
     * @param {boolean} reduced
     */
    smooth(reduced) {
        const { gl } = this;
        held(gl, this.texture);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.REPEAT);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        const filter = reduced ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR;
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
        if (reduced) gl.generateMipmap(gl.TEXTURE_2D);
    }

    /** Its integers, four of each pixel, the lowest row first. */
    read() {
        const { gl, width, height } = this;
        const pixels = new Int32Array(4 * width * height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
        gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.INT, pixels);
        return pixels;
    }
}

/**
 * A texture of which single texels are read.
 * @param {WebGL2RenderingContext} gl
 */
function nearestTexture(gl) {
    const texture = gl.createTexture();
    held(gl, texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
        gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
        gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    }
    return texture;
}

/**
 * Bind a texture that is written, where no program reads one.
 * @param {WebGL2RenderingContext} gl
 * @param {WebGLTexture} texture
 */
function held(gl, texture) {
    gl.activeTexture(gl.TEXTURE15);
    gl.bindTexture(gl.TEXTURE_2D, texture);
}
